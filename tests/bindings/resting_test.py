"""Equilibrium and linear equations from Python."""

import unittest

import numpy

from scenes import ROOT

import koppel

PENDULUM = ROOT / "apps" / "scenes" / "dynamics" / "double_pendulum.toml"


class Resting(unittest.TestCase):
    def setUp(self):
        self.state = koppel.load(PENDULUM).state()
        self.state.close()

    def test_is_found_and_taken(self):
        before = self.state.q
        rest = self.state.equilibrium()
        self.assertTrue(rest.found, rest.why)
        self.assertEqual((rest.why, rest.stable, rest.unstable, rest.indifferent), ("", 2, 0, 0))
        numpy.testing.assert_array_equal(self.state.q, before)
        rest.take(self.state)
        numpy.testing.assert_allclose(self.state.q, [0, 0], atol=rest.coordinate_error + 1e-14)
        numpy.testing.assert_array_equal(self.state.v, [0, 0])
        # Of both weights on the upper arm, of the lower one on both: in the joints' angles.
        self.assertEqual(rest.independent, ["first.angle", "second.angle"])
        known = 9.81 * numpy.array([[3, 1], [1, 1]])
        self.assertTrue((abs(rest.stiffness - known) <= rest.stiffness_errors + 1e-14).all())
        self.assertEqual(rest.directions.shape, (2, 2))

    def test_has_its_modes(self):
        linear = self.state.linearise(equilibrium=self.state.equilibrium(), efforts=["second.angle"])
        self.assertEqual(linear.course, "resting")
        self.assertEqual(linear.inputs, ["second.angle effort"])
        self.assertEqual(linear.outputs[:2], ["first.angle", "second.angle"])
        self.assertEqual(linear.A.values.shape, (4, 4))
        self.assertEqual(linear.D.values.shape, (len(linear.outputs), 1))
        known = (9.81 * (2 - 2**0.5)) ** 0.5
        self.assertLessEqual(abs(linear.modes[0].eigenvalue - 1j * known), linear.modes[0].error)
        self.assertLess(linear.modes[0].error, 1e-9)
        numpy.testing.assert_allclose(linear.mass.values, [[5, 2], [2, 1]], atol=1e-13)

    def test_is_refused_of_an_open_state(self):
        with self.assertRaises(koppel.Error):
            koppel.load(ROOT / "apps" / "scenes" / "4bar.toml").state().equilibrium()


if __name__ == "__main__":
    unittest.main()
