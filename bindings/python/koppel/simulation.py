"""Motion under masses, forces and drives."""

import ctypes as c
import dataclasses

import numpy

from . import structs
from .engine import load
from .library import Handle, call, call_plain, encoded
from .mechanism import Mechanism
from .state import State


@dataclasses.dataclass(frozen=True)
class Summary:
    """How a simulation went so far, and what may be believed of it."""

    freedoms: int  # independent coordinates
    switches: int  # how often others were chosen
    steps: int
    rejected: int
    evaluations: int
    energy: float  # [J] kinetic and potential, at the end of the last step
    energy_error: float  # [J] greatest change of the energy that no work explains
    energy_size: float  # [J] what to compare it with
    position_drift: float  # greatest closure equation at the end of a step, scaled as Report.residual
    velocity_drift: float  # greatest rate of one [1/s]
    start_change: float  # greatest change of a start rate that the loops did not allow
    tolerance: float  # of a step, as it is used; 0: steps are fixed
    step: float  # [s] of fixed steps; 0: by the tolerance
    stiff: bool  # many steps were as short as stability wants them, not accuracy: "cvode" suits better
    events: int  # kinks and jumps of forces at which steps were made to end


@dataclasses.dataclass(frozen=True)
class Crossing:
    """Where a value that the scene watches was crossed."""

    watch: str
    time: float  # [s] the first at which it lies on the other side, to rounding
    rising: bool
    stop: bool  # the scene wants the simulation to end there


class Simulation(Handle):
    """A motion from a closed state on: with its rates if it has them, else with those that the scene asks for, as
    nearly as the loops allow. The state itself stays as it is.

    tolerance: of a step; 0: the scene's, or 1e-8. step [s]: of fixed steps; 0: the scene's, or steps by the tolerance.
    end [s]: where the last step shall end; 0: the scene's duration. integrator: a name as `koppel simulate --help`
    lists them; None: the formulation's, the scene's or the default. formulation: likewise; None: the integrator's, or
    "minimal". Error: the state is not closed, there is no such integrator, or nothing can be computed there.
    """

    _destroy = ("koppel_simulation_destroy",)

    def __init__(self, state, tolerance=0.0, step=0.0, end=0.0, integrator=None, formulation=None):
        options = structs.SimulationOptions(tolerance=tolerance, step=step, end=end, integrator=encoded(integrator),
                                            formulation=encoded(formulation))
        out = c.c_void_p()
        call("koppel_simulation_create", state.handle, options, out)
        super().__init__(out.value)

    def advance(self, time, state):
        """On to a time not before the last one; `state` comes out there, with rates and accelerations. Error: the
        integration goes no further; the state is as before."""
        call("koppel_simulation_advance", self.handle, time, state.handle)

    def watch(self, time, state):
        """As advance(), but no further than to the first crossing of a value that the scene watches, which is
        returned; None: there was none before the time. The next call goes on."""
        crossing = structs.Crossing()
        call("koppel_simulation_watch", self.handle, time, state.handle, crossing)
        if crossing.watch == structs.NO_WATCH:
            return None
        name = state.mechanism.watches[crossing.watch]
        return Crossing(name, crossing.time, bool(crossing.rising), bool(crossing.stop))

    @property
    def summary(self):
        struct = structs.SimulationSummary()
        call_plain("koppel_simulation_summarise", self.handle, struct)
        return Summary(*(field.type(getattr(struct, field.name)) for field in dataclasses.fields(Summary)))


def simulate(scene, times=None, tolerance=0.0, step=0.0, integrator=None, formulation=None):
    """Lets a mechanism move from its closed position at time 0 through times [s] (None: as the scene proposes).

    scene: a Mechanism, or the path of a scene file. Returns a dict of arrays, all of one length: "time" and every
    recorded column under its name; and the Summary. They end at the first crossing at which the scene wants to stop.
    Error: from the first step that fails.
    """
    mechanism = scene if isinstance(scene, Mechanism) else load(scene)
    if times is None:
        times = numpy.linspace(0.0, mechanism.duration, mechanism.steps + 1)
    times = numpy.asarray(times, dtype=numpy.float64)
    rows, shown = [], []
    with State(mechanism) as state:
        state.close()
        end = times[-1] if times.size else 0.0
        with Simulation(state, tolerance, step, end, integrator, formulation) as simulation:
            for time in times:
                crossing = simulation.watch(time, state)
                while crossing and not crossing.stop:
                    crossing = simulation.watch(time, state)
                rows.append(state.records())
                shown.append(crossing.time if crossing else time)
                if crossing:
                    break
            summary = simulation.summary
    table = numpy.array(rows).reshape(-1, mechanism.sizes.records)
    return dict(zip(mechanism.records, table.T)) | {"time": numpy.array(shown)}, summary
