"""Where a mechanism stands: closing, moving, results as arrays."""

import ctypes as c
import dataclasses

import numpy

from . import equilibrium, linearisation, modes, structs
from .library import Handle, call, call_plain, library, numbers, pointer, text


@dataclasses.dataclass(frozen=True)
class Report:
    """How a closure went. residual: greatest equation, metres divided by the mechanism's length, radians as they are;
    coordinate_error: estimated greatest error of an unknown, likewise."""

    verdict: str  # "open" (nothing to close), "closed", "not found" or "retry"
    solver: str  # "none" (was closed already), "newton", "ceres" or "flow" (closed forms and small blocks)
    iterations: int
    rank: int
    equations: int
    unknowns: int
    residual: float
    condition: float
    coordinate_error: float
    redundant: bool  # some equations say the same as others
    branch_changed: bool
    near_singular: bool
    limit_exceeded: bool

    @classmethod
    def from_struct(cls, s, status):
        return cls(structs.VERDICTS[s.verdict], structs.SOLVERS[s.solver], s.iterations, s.rank, s.equations,
                   s.unknowns, s.residual, s.condition, s.coordinate_error, bool(status & structs.REDUNDANT),
                   bool(status & structs.BRANCH_CHANGED), bool(status & structs.NEAR_SINGULAR),
                   bool(status & structs.LIMIT_EXCEEDED))

    def to_struct(self):
        return structs.Report(verdict=structs.VERDICTS.index(self.verdict), solver=structs.SOLVERS.index(self.solver),
                              iterations=self.iterations, rank=self.rank, equations=self.equations,
                              unknowns=self.unknowns, residual=self.residual, condition=self.condition,
                              coordinate_error=self.coordinate_error)


@dataclasses.dataclass(frozen=True)
class Analysis:
    """Freedoms at a closed position, by count and by rank of the Jacobian of all tree coordinates."""

    mobility_count: int
    mobility_rank: int
    rank: int
    equations: int
    tree_rates: int
    largest_singular_value: float
    last_singular_value: float
    gap: float


@dataclasses.dataclass(frozen=True)
class Freedoms:
    """Freedoms at a closed position, inputs taken for free: by count with the kinds of the loops, by rank here and near
    by; equations that follow from others; freedoms of one body alone; joints whose reactions statics does not
    determine."""

    mobility_by_kind: int
    mobility_here: int
    mobility_nearby: int
    redundant_here: int
    redundant_nearby: int
    planar_loops: int
    spherical_loops: int
    isolated: int
    indeterminate: int
    shaky: bool


@dataclasses.dataclass(frozen=True, eq=False)
class Reactions:
    """What joints and drives bear. joints: (joints, 6), [moment N m; force N] of each joint, with its drive and the
    forces on its coordinates, on the body at its outlet, axes and origin of the outlet frame. efforts: (rates,)
    [N m, N], what drives deliver, and along rates that nothing drives what is missing to their accelerations. The
    masks of the same shapes tell what the motion determines; of all else the least is given."""

    joints: numpy.ndarray
    efforts: numpy.ndarray
    joints_determined: numpy.ndarray
    efforts_determined: numpy.ndarray


class Work(Handle):
    _destroy = ("koppel_work_destroy",)


class State(Handle):
    """One thread at a time. Arrays that it returns are copies."""

    _destroy = ("koppel_state_destroy",)

    def __init__(self, mechanism):
        out = c.c_void_p()
        call_plain("koppel_state_create", mechanism.handle, out)
        super().__init__(out.value)
        call_plain("koppel_work_create", mechanism.handle, out)
        self.work = Work(out.value)
        self.mechanism = mechanism

    def free(self):
        self.work.free()
        super().free()

    def copy(self):
        """Another State that stands at the same place."""
        other = State(self.mechanism)
        call_plain("koppel_state_copy", self.handle, other.handle)
        return other

    @property
    def time(self):
        """[s]"""
        return library().koppel_state_time(self.handle)

    @property
    def q(self):
        """(coordinates,) of all joints in file order; setting them sets a start for the next close."""
        return self._get(structs.Q, self.mechanism.sizes.coordinates)

    @q.setter
    def q(self, values):
        self._set(structs.Q, values)

    @property
    def v(self):
        """(rates,)"""
        return self._get(structs.V, self.mechanism.sizes.rates)

    @v.setter
    def v(self, values):
        self._set(structs.V, values)

    @property
    def a(self):
        """(rates,)"""
        return self._get(structs.A, self.mechanism.sizes.rates)

    @a.setter
    def a(self, values):
        self._set(structs.A, values)

    def set_time(self, time):
        """Every input takes value, rate and acceleration from its drive."""
        call("koppel_state_set_time", self.handle, time)

    def set_input(self, name, value, rate=0.0, acceleration=0.0):
        """Sets an input by hand, until the next set_time or move. Error: no such input, or not finite."""
        index = self.mechanism.index("input", name)
        call_plain("koppel_state_set_input", self.handle, index, value, rate, acceleration)

    def close(self, method="auto", max_iterations=0, tolerance=0.0):
        """Closes the loops with the inputs held; returns the Report. method: "auto", "newton", "ceres" or "flow". Error:
        no closed position was found; the state is as before."""
        options = structs.CloseOptions(method=structs.METHODS.index(method), max_iterations=max_iterations,
                                       tolerance=tolerance)
        return self._reported("koppel_close", options)

    def velocities(self):
        """Rates of a closed state from those of its inputs: (rates,), as v."""
        call("koppel_velocities", self.handle, self.work.handle)
        return self.v

    def accelerations(self):
        """(rates,), as a; after velocities()."""
        call("koppel_accelerations", self.handle, self.work.handle)
        return self.a

    def move(self, time):
        """To another time: inputs from their drives, closure, velocities, accelerations. Returns the Report."""
        return self._reported("koppel_move", time)

    def analyse(self):
        struct = structs.Analysis()
        call("koppel_analyse", self.handle, self.work.handle, struct)
        return Analysis(*(getattr(struct, field.name) for field in dataclasses.fields(Analysis)))

    def freedoms(self):
        """The freedoms where the closed state stands, and what makes counts and rank differ."""
        struct = structs.Freedoms()
        call("koppel_find_freedoms", self.handle, self.work.handle, struct)
        return Freedoms(*(field.type(getattr(struct, field.name)) for field in dataclasses.fields(Freedoms)))

    def explain_freedoms(self):
        """The same as a page of text, with the names of bodies and joints."""
        return text("koppel_explain_freedoms", self.handle, self.work.handle)

    def modes(self, most=0, all_twins=False, restarts=0, progress=None):
        """All closed positions for the inputs as they are: Modes. The state stays as it is; what no input determines is
        taken from it. most: where the search ends (0: 4096). all_twins: list every position of links that turn over
        unnoticed. restarts: random starts where there is no other way (0: 2000). progress(found, part): called now and
        then with the number found and the part done; False stops the search."""
        return modes.find(self, most, all_twins, restarts, progress)

    def equilibrium(self, drives="held", search="settle", max_iterations=0):
        """Where the closed mechanism rests: Equilibrium. The state stays as it is. drives: "held", or "moving": they go
        on with their rates, and only what they do not move rests. search: "settle": where the forces push it to, else
        any; "nearest": a balance of forces near by, stable or not. max_iterations: 0: 200."""
        return equilibrium.find(self, drives, search, max_iterations)

    def linearise(self, drives="held", equilibrium=None, efforts=()):
        """The equations of motion, linear about the closed state: Linearisation. drives: "held": at rest; "moving": with
        the state's rates. equilibrium: an Equilibrium, to linearise there instead. efforts: names of rates along which
        efforts are inputs, after value, rate and acceleration of every drive."""
        return linearisation.make(self, drives, equilibrium, efforts)

    def poses(self, kind="body"):
        """(bodies or frames, 3, 4): rotation matrix and, as last column, position in the world [m]."""
        flat = self._each("koppel_poses", kind, 12)
        return numpy.concatenate((flat[:, :9].reshape(-1, 3, 3), flat[:, 9:, None]), axis=2)

    def twists(self, kind="body"):
        """(bodies or frames, 6): [angular; linear] velocity in world axes, at each one's own origin."""
        return self._each("koppel_twists", kind, 6)

    def frame_accelerations(self, kind="body"):
        """(bodies or frames, 6): [angular acceleration; acceleration of the origin] in world axes."""
        return self._each("koppel_frame_accelerations", kind, 6)

    def jacobian(self, name, kind="body"):
        """(6, rates): geometric Jacobian, world axes, at its origin; columns of cut joints are zero."""
        return self._jacobian(name, kind)[0]

    def jacobian_rate(self, name, kind="body"):
        """(6, rates): its time derivative at v."""
        return self._jacobian(name, kind)[1]

    def reactions(self):
        """What joints and drives bear, for v and a as they stand and the forces that act: Reactions. Error: the state
        is not closed."""
        sizes = self.mechanism.sizes
        joints, efforts = numbers(sizes.joints, 6), numbers(sizes.rates)
        determined = numpy.empty(joints.size + efforts.size, dtype=numpy.uint8)
        call("koppel_reactions", self.handle, self.work.handle, pointer(joints), joints.size, pointer(efforts),
             efforts.size, determined.ctypes.data_as(c.POINTER(c.c_uint8)))
        known = determined != 0
        return Reactions(joints, efforts, known[:joints.size].reshape(joints.shape), known[joints.size:])

    def records(self):
        """(records,): the recorded columns, named mechanism.records."""
        out = numbers(self.mechanism.sizes.records)
        call_plain("koppel_records", self.handle, self.work.handle, pointer(out), out.size)
        return out

    def _get(self, what, count):
        out = numbers(count)
        call_plain("koppel_state_get", self.handle, what, pointer(out), count)
        return out

    def _set(self, what, values):
        array = numpy.ascontiguousarray(values, dtype=numpy.float64)
        call_plain("koppel_state_set", self.handle, what, pointer(array), array.size)

    def _reported(self, function, argument):
        struct = structs.Report()
        status = call(function, self.handle, self.work.handle, argument, struct)
        return Report.from_struct(struct, status)

    def _each(self, function, kind, size):
        count = {"body": self.mechanism.sizes.bodies, "frame": self.mechanism.sizes.frames}[kind]
        out = numbers(count, size)
        if count > 0:
            call_plain(function, self.handle, self.work.handle, structs.KINDS[kind], pointer(out), out.size)
        return out

    def _jacobian(self, name, kind):
        out, rate = numbers(6, self.mechanism.sizes.rates), numbers(6, self.mechanism.sizes.rates)
        index = self.mechanism.index(kind, name)
        call_plain("koppel_jacobian", self.handle, self.work.handle, structs.KINDS[kind], index, pointer(out),
                   pointer(rate), out.size)
        return out, rate
