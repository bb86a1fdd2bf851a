"""Static equilibrium: where a mechanism rests under its forces."""

import ctypes as c

from . import structs
from .library import Handle, call, call_plain, numbers, pointer, text


class Equilibrium(Handle):
    """A position of rest, or where the search for one ended.

    found; why: it was not found, else "". freedoms, iterations; stable, unstable, indifferent: directions of each kind.
    independent: names of the coordinates that all others follow from. residual: force left over the size of the forces;
    worst, force: along which rate the most is left, and how much [N m, N]; coordinate_error: what that displaces [rad,
    lengths of the scene]. energy [J]: potential. moved_most, moved: rate of the coordinate that moved most, by how much.
    unrest [1/s]: of moving drives, greatest rate of what they do not drive.
    stiffness, stiffness_errors (freedoms, freedoms): of the independent coordinates [N m, N by rad, m]; eigenvalues
    (freedoms,) [J], ascending, known to eigenvalue_error; directions (freedoms, rates). None if not found.
    circulatory: the stiffness is not symmetric. states_held: internal states of forces were held for it.
    """

    _destroy = ("koppel_equilibrium_destroy",)

    def __init__(self, pointer_value, mechanism):
        super().__init__(pointer_value)
        summary = structs.EquilibriumSummary()
        call_plain("koppel_equilibrium_summarise", self.handle, summary)
        self.found, self.why = bool(summary.found), text("koppel_equilibrium_why", self.handle)
        for name in ("freedoms", "iterations", "stable", "unstable", "indifferent", "residual", "force", "coordinate_error",
                     "energy", "moved", "unrest"):
            setattr(self, name, getattr(summary, name))
        self.circulatory, self.states_held = bool(summary.circulatory), bool(summary.states_held)
        self.worst, self.moved_most = mechanism.rates[summary.worst], mechanism.rates[summary.moved_most]
        rates = (c.c_uint32 * self.freedoms)()
        call_plain("koppel_equilibrium_independent", self.handle, rates, self.freedoms)
        self.independent = [mechanism.rates[rate] for rate in rates]
        self.stiffness = self.stiffness_errors = self.eigenvalues = self.directions = None
        self.eigenvalue_error = summary.stiffness_error
        if self.found:
            self._read_stiffness(self.freedoms, mechanism.sizes.rates)

    def _read_stiffness(self, count, rates):
        self.stiffness, self.stiffness_errors = numbers(count, count), numbers(count, count)
        call_plain("koppel_equilibrium_stiffness", self.handle, pointer(self.stiffness), pointer(self.stiffness_errors),
                   count * count)
        self.eigenvalues, self.directions = numbers(count), numbers(count, rates)
        value = c.c_double()
        for index in range(count):
            call_plain("koppel_equilibrium_direction", self.handle, index, value, pointer(self.directions[index]), rates)
            self.eigenvalues[index] = value.value

    def take(self, state):
        """Puts a state of the same mechanism there."""
        call_plain("koppel_equilibrium_take", self.handle, state.handle)


def find(state, drives, search, max_iterations):
    """See State.equilibrium."""
    options = structs.EquilibriumOptions(drives=structs.DRIVES.index(drives), search=structs.SEARCHES.index(search),
                                         max_iterations=max_iterations)
    out = c.c_void_p()
    call("koppel_equilibrium_find", state.handle, options, out)
    return Equilibrium(out.value, state.mechanism)
