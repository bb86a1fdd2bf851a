"""Dynamics of spanning trees from Python: shapes, and that the parts fit together."""

import unittest

import numpy

from scenes import ROOT

import koppel

EPS = numpy.finfo(float).eps


def load(name):
    return koppel.load(ROOT / "apps" / "scenes" / "dynamics" / f"{name}.toml")


class OfThreePendulums(unittest.TestCase):
    def setUp(self):
        self.tree = load("triple_pendulum").tree()
        random = numpy.random.default_rng(5)
        self.q, self.v, self.a = random.uniform(-1, 1, (3, 4, 3))
        # Sizes of efforts are some tens, and a few dozen operations make them.
        self.rounding = 1000 * EPS

    def test_forward_dynamics_undoes_inverse_dynamics(self):
        efforts = self.tree.inverse_dynamics(self.q, self.v, self.a)
        self.assertEqual(efforts.shape, (4, 3))
        found = self.tree.forward_dynamics(self.q, self.v, efforts)
        condition = numpy.linalg.cond(self.tree.mass_matrix(self.q)).max()
        numpy.testing.assert_allclose(found, self.a, rtol=0, atol=condition * self.rounding)

    def test_efforts_are_mass_times_acceleration_and_bias(self):
        mass = self.tree.mass_matrix(self.q)
        bias = self.tree.inverse_dynamics(self.q, self.v)
        together = numpy.einsum("nij,nj->ni", mass, self.a) + bias
        numpy.testing.assert_allclose(self.tree.inverse_dynamics(self.q, self.v, self.a), together, rtol=0,
                                      atol=self.rounding)

    def test_one_state_is_as_many(self):
        many = self.tree.forward_dynamics_derivatives(self.q, self.v, self.a)
        one = self.tree.forward_dynamics_derivatives(self.q[2], self.v[2], self.a[2])
        for matrices, matrix in zip(many, one):
            self.assertEqual((matrices.shape, matrix.shape), ((4, 3, 3), (3, 3)))
            numpy.testing.assert_array_equal(matrices[2], matrix)

    def test_one_array_serves_a_batch(self):
        shared = self.tree.inverse_dynamics(self.q, self.v[0])
        numpy.testing.assert_array_equal(shared, self.tree.inverse_dynamics(self.q, [self.v[0]] * 4))

    def test_derivatives_of_both_dynamics_belong_together(self):
        efforts = self.tree.inverse_dynamics(self.q, self.v, self.a)
        by_q, by_v = self.tree.inverse_dynamics_derivatives(self.q, self.v, self.a)
        a_by_q, a_by_v, a_by_effort = self.tree.forward_dynamics_derivatives(self.q, self.v, efforts)
        mass = self.tree.mass_matrix(self.q)
        atol = numpy.linalg.cond(mass).max() * self.rounding
        numpy.testing.assert_allclose(mass @ a_by_q, -by_q, rtol=0, atol=atol)
        numpy.testing.assert_allclose(mass @ a_by_v, -by_v, rtol=0, atol=atol)
        numpy.testing.assert_allclose(mass @ a_by_effort, numpy.broadcast_to(numpy.eye(3), (4, 3, 3)), rtol=0, atol=atol)

    def test_energy_is_that_of_the_mass_matrix(self):
        kinetic, potential = self.tree.energy(self.q, self.v)
        half = numpy.einsum("ni,nij,nj->n", self.v, self.tree.mass_matrix(self.q), self.v) / 2
        numpy.testing.assert_allclose(kinetic, half, rtol=0, atol=self.rounding)
        of = self.tree.momentum(self.q, self.v)
        gravity = numpy.array(self.tree.mechanism.gravity)
        numpy.testing.assert_allclose(potential, -of.mass * (of.centre @ gravity), rtol=0, atol=self.rounding)
        self.assertEqual(numpy.shape(self.tree.energy(self.q[0])[0]), ())

    def test_momentum_is_mass_times_the_rate_of_the_centre(self):
        h = 1e-5  # truncation and rounding of the difference are both below 1e-9
        ahead, behind = (self.tree.momentum(self.q + t * self.v).centre for t in (h, -h))
        of = self.tree.momentum(self.q, self.v)
        numpy.testing.assert_allclose(of.momentum, of.mass[:, None] * (ahead - behind) / (2 * h), rtol=0, atol=1e-8)
        self.assertEqual(of.angular_momentum.shape, (4, 3))


class OfABody(unittest.TestCase):
    def test_takes_quaternions_of_any_length(self):
        mechanism = load("free_body")
        tree, q, v = mechanism.tree(), mechanism.state().q, numpy.arange(1.0, 7.0)
        longer = numpy.concatenate((4 * q[:4], q[4:]))
        numpy.testing.assert_array_equal(tree.inverse_dynamics(longer, v), tree.inverse_dynamics(q, v))


class Faults(unittest.TestCase):
    def test_are_named(self):
        tree = load("triple_pendulum").tree()
        with self.assertRaises(ValueError):
            tree.inverse_dynamics([0.0, 0.0])
        with self.assertRaises(ValueError):
            tree.inverse_dynamics(numpy.zeros((4, 3)), numpy.zeros((5, 3)))
        with self.assertRaises(koppel.Error) as caught:
            tree.forward_dynamics([[0, 0, 0], [0, float("nan"), 0]])
        self.assertIn("state 1", str(caught.exception))

    def test_a_tree_that_was_freed_says_so(self):
        tree = load("triple_pendulum").tree()
        tree.free()
        with self.assertRaises(ValueError):
            tree.mass_matrix([0, 0, 0])


if __name__ == "__main__":
    unittest.main()
