"""The equations of motion, linear about a state."""

import ctypes as c
import dataclasses

import numpy

from . import structs
from .library import Handle, call, call_plain, numbers, pointer, text


@dataclasses.dataclass(frozen=True, eq=False)
class Matrix:
    """values, and what each may be wrong by."""

    values: numpy.ndarray
    errors: numpy.ndarray


@dataclasses.dataclass(frozen=True, eq=False)
class Eigenmode:
    """eigenvalue [1/s], known to error; shape (rates,), complex: displacements along all rates, the greatest 1."""

    eigenvalue: complex
    error: float
    shape: numpy.ndarray


@dataclasses.dataclass(frozen=True, eq=False)
class Linearisation:
    """x' = A x + B u, y = C x + D u for small deviations. states, inputs, outputs: names of the numbers in x, u and y.
    mass, damping, stiffness: in the independent coordinates, the first `freedoms` of x. course: "unsteady", "steady" or
    "resting"; drift: greatest change of a rate [rad/s^2, lengths of the scene/s^2]. modes: slow ones first."""

    states: list
    inputs: list
    outputs: list
    freedoms: int
    course: str
    drift: float
    A: Matrix
    B: Matrix
    C: Matrix
    D: Matrix
    mass: Matrix
    stiffness: Matrix
    damping: Matrix
    modes: tuple


class _Made(Handle):
    _destroy = ("koppel_linearisation_destroy",)

    def names(self, kind, count):
        return [text("koppel_linearisation_name", self.handle, kind, index) for index in range(count)]

    def matrix(self, what, rows, columns):
        values, errors = numbers(rows, columns), numbers(rows, columns)
        call_plain("koppel_linearisation_matrix", self.handle, what, pointer(values), pointer(errors), rows * columns)
        return Matrix(values, errors)

    def mode(self, index, rates):
        struct, real, imaginary = structs.Eigenmode(), numbers(rates), numbers(rates)
        call_plain("koppel_linearisation_mode", self.handle, index, struct, pointer(real), pointer(imaginary), rates)
        return Eigenmode(complex(struct.real, struct.imaginary), struct.error, real + 1j * imaginary)


def make(state, drives, equilibrium, efforts):
    """See State.linearise."""
    rates = [state.mechanism.index("rate", name) for name in efforts]
    options = structs.LinearisationOptions(
        drives=structs.DRIVES.index(drives), equilibrium=equilibrium.handle if equilibrium is not None else None,
        efforts=(c.c_uint32 * len(rates))(*rates), effort_count=len(rates))
    out = c.c_void_p()
    call("koppel_linearise", state.handle, options, out)
    with _Made(out.value) as made:
        summary = structs.LinearisationSummary()
        call_plain("koppel_linearisation_summarise", made.handle, summary)
        n, m, p, f = summary.states, summary.inputs, summary.outputs, summary.freedoms
        sizes = ((n, n), (n, m), (p, n), (p, m), (f, f), (f, f), (f, f))
        matrices = [made.matrix(what, *size) for what, size in enumerate(sizes, start=1)]
        modes = tuple(made.mode(index, state.mechanism.sizes.rates) for index in range(n))
        return Linearisation(made.names(1, n), made.names(2, m), made.names(3, p), f, structs.COURSES[summary.course],
                             summary.drift, *matrices, modes)
