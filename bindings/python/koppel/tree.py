"""Dynamics of the spanning tree: one state, or many at once."""

import ctypes as c
import dataclasses

import numpy

from .library import Handle, call, numbers, pointer


@dataclasses.dataclass(frozen=True, eq=False)
class Momentum:
    """mass [kg]; in world axes, (3,) or (count, 3): centre of mass [m], momentum [N s], angular_momentum about the
    centre of mass [N m s]."""

    mass: numpy.ndarray
    centre: numpy.ndarray
    momentum: numpy.ndarray
    angular_momentum: numpy.ndarray


class Tree(Handle):
    """Dynamics of a mechanism's bodies on the joints of its spanning tree, under gravity: loops are open where they are
    cut; constraints, forces and drives do not act. What belongs to cut joints does not count, and comes out zero.
    Belongs to one thread at a time.

    q: (coordinates,) or (count, coordinates); v, a, efforts [N m, N]: (rates,) or (count, rates), None for zero. One
    state's array serves all states of a batch. Results have the shapes told, after count if anything was a batch.
    ValueError: a shape does not fit. Error: a number is not finite, a plugin failed, or something moves without mass.
    """

    _destroy = ("koppel_tree_destroy",)

    def __init__(self, mechanism):
        out = c.c_void_p()
        call("koppel_tree_create", mechanism.handle, out)
        super().__init__(out.value)
        self.mechanism = mechanism
        self._rates = mechanism.sizes.rates

    def inverse_dynamics(self, q, v=None, a=None):
        """(rates,): efforts that the motion takes; with a None the bias, with v None too the load of gravity."""
        (efforts,) = self._evaluate("koppel_tree_inverse_dynamics", q, (v, a), (self._rates,))
        return efforts

    def forward_dynamics(self, q, v=None, efforts=None):
        """(rates,): accelerations that efforts cause."""
        (a,) = self._evaluate("koppel_tree_forward_dynamics", q, (v, efforts), (self._rates,))
        return a

    def mass_matrix(self, q):
        """(rates, rates), symmetric; v @ mass @ v / 2 is the kinetic energy."""
        (mass,) = self._evaluate("koppel_tree_mass_matrix", q, (), self._square())
        return mass

    def energy(self, q, v=None):
        """Kinetic and potential energy [J]; the latter of gravity, zero with all mass at the world's origin."""
        return self._evaluate("koppel_tree_energy", q, (v,), (), ())

    def momentum(self, q, v=None):
        """Mass, centre of mass and momenta: Momentum."""
        return Momentum(*self._evaluate("koppel_tree_momentum", q, (v,), (), (3,), (3,), (3,)))

    def inverse_dynamics_derivatives(self, q, v=None, a=None):
        """by_q, by_v, (rates, rates) each: efforts (rows) by displacements of q along the rates, and by the rates
        (columns). By accelerations it is the mass matrix."""
        return self._evaluate("koppel_tree_inverse_dynamics_derivatives", q, (v, a), self._square(), self._square())

    def forward_dynamics_derivatives(self, q, v=None, efforts=None):
        """by_q, by_v, by_effort, (rates, rates) each: accelerations (rows) by displacements, rates and efforts."""
        return self._evaluate("koppel_tree_forward_dynamics_derivatives", q, (v, efforts), *[self._square()] * 3)

    def _square(self):
        return self._rates, self._rates

    def _evaluate(self, function, q, rates, *shapes):
        """Calls a function for all states; its results have these shapes, each for one state."""
        widths = [self.mechanism.sizes.coordinates] + [self._rates] * len(rates)
        given = [None if array is None else numpy.asarray(array, dtype=numpy.float64) for array in (q, *rates)]
        for array, width in zip(given, widths):
            if array is not None and (array.ndim not in (1, 2) or array.shape[-1] != width):
                raise ValueError(f"an array of shape {array.shape} is not (count, {width}) or ({width},)")
        batch = numpy.broadcast_shapes(*(array.shape[:-1] for array in given if array is not None))
        count = batch[0] if batch else 1
        inputs = [None if array is None else numpy.ascontiguousarray(numpy.broadcast_to(array, (count, width)))
                  for array, width in zip(given, widths)]
        results = [numbers(*batch, *shape) for shape in shapes]
        call(function, self.handle, count, *(array if array is None else pointer(array) for array in inputs),
             *map(pointer, results))
        return tuple(result[()] for result in results)
