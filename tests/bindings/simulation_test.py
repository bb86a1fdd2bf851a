"""Simulation and reactions from Python."""

import math
import pathlib
import sys
import tempfile
import unittest

import numpy

from scenes import ROOT

import koppel

DYNAMICS = ROOT / "apps" / "scenes" / "dynamics"


class Simulation(unittest.TestCase):
    def test_of_a_pendulum_ends_where_it_must(self):
        table, summary = koppel.simulate(DYNAMICS / "pendulum.toml", tolerance=1e-10)
        # After 10 s (A01 of the benchmarks); local errors add up to less than the number of steps makes of one.
        self.assertLess(abs(math.sin(table["pivot.angle"][-1]) + 0.275087462576116860), summary.steps * 1e-10)
        self.assertEqual(summary.freedoms, 1)
        self.assertLess(summary.energy_error, summary.steps * 1e-10 * summary.energy_size)

    def test_stops_where_the_scene_wants_it(self):
        text = (DYNAMICS / "pendulum.toml").read_text() + """
[[watch]]
name = "aloft"
of = "pivot.angle"
value = "-0.5 rad"
stop = true
"""
        with tempfile.TemporaryDirectory() as folder:
            scene = pathlib.Path(folder) / "pendulum.toml"
            scene.write_text(text)
            mechanism = koppel.load(scene)
        self.assertEqual(mechanism.watches, ["aloft"])
        table, summary = koppel.simulate(mechanism, tolerance=1e-10)
        self.assertLess(table["time"][-1], mechanism.duration)
        self.assertAlmostEqual(table["pivot.angle"][-1], -0.5, delta=1e-12)
        state = mechanism.state()
        state.close()
        with koppel.Simulation(state, tolerance=1e-10) as simulation:
            crossing = simulation.watch(10.0, state)
            self.assertEqual(crossing, koppel.Crossing("aloft", crossing.time, crossing.rising, True))
            # Searched between other rows, each time to four units of rounding.
            self.assertAlmostEqual(crossing.time, table["time"][-1], delta=8 * sys.float_info.epsilon)
            self.assertIsNone(simulation.watch(crossing.time, state))

    def test_goes_on_from_the_rates_that_a_state_has(self):
        mechanism = koppel.load(DYNAMICS / "double_pendulum.toml")
        whole, half = mechanism.state(), mechanism.state()
        for state, stops in ((whole, [0.4]), (half, [0.2, 0.4])):
            state.close()
            for time in stops:
                with koppel.Simulation(state, tolerance=1e-11) as simulation:
                    simulation.advance(time, state)
        numpy.testing.assert_allclose(half.q, whole.q, rtol=0, atol=1e-8)
        numpy.testing.assert_allclose(half.v, whole.v, rtol=0, atol=1e-8)

    def test_refuses_a_state_that_is_not_closed(self):
        with self.assertRaises(koppel.Error) as raised:
            koppel.Simulation(koppel.load(ROOT / "apps" / "scenes" / "rstr.toml").state())
        self.assertIn("koppel_close", str(raised.exception))


class Reactions(unittest.TestCase):
    def test_of_a_free_motion_leave_nothing_missing(self):
        state = koppel.load(DYNAMICS / "fivelink_free.toml").state()
        state.close()
        with koppel.Simulation(state) as simulation:
            simulation.advance(0.2, state)
        loads = state.reactions()
        self.assertEqual(loads.joints.shape, (len(state.mechanism.joints), 6))
        greatest = abs(loads.joints).max()
        self.assertGreater(greatest, 0.0)
        self.assertLess(abs(loads.efforts).max(), 1e-10 * greatest)

    def test_need_a_closed_state(self):
        with self.assertRaises(koppel.Error):
            koppel.load(ROOT / "apps" / "scenes" / "rstr.toml").state().reactions()


if __name__ == "__main__":
    unittest.main()
