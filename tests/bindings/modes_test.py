"""Assembly modes and the solution flow from Python."""

import unittest

import numpy

from scenes import ROOT

import koppel

# How many positions there are, from the sources that the scenes name, or by their geometry.
COUNTS = {"rstr": 4, "rscr": 2, "rccc": 2, "swash": 4, "4bar": 2, "6r_pose": 8, "3rpr": 6, "7r": 16, "chain": 8, "6r": 1}


def load(name):
    return koppel.load(ROOT / "apps" / "scenes" / f"{name}.toml")


class Modes(unittest.TestCase):
    def test_are_counted_and_close(self):
        for name, count in COUNTS.items():
            with self.subTest(scene=name):
                state = load(name).state()
                before = state.q
                found = state.modes()
                self.assertEqual(len(found), count)
                self.assertTrue(found.complete, found.why)
                self.assertEqual(len({mode.id for mode in found}), count)
                numpy.testing.assert_array_equal(state.q, before)
                for mode in found:
                    state.q = mode.q
                    self.assertLess(state.close().residual, 1e-13)
                    numpy.testing.assert_allclose(state.q, mode.q, rtol=0, atol=1e-12)

    def test_of_links_that_turn_over_are_listed_on_demand(self):
        state = load("swash").state()
        self.assertEqual((len(state.modes()), state.modes().twins), (4, 4))
        self.assertEqual((len(state.modes(all_twins=True)), state.modes(all_twins=True).twins), (16, 1))

    def test_are_ended_by_a_number_or_by_progress(self):
        state = load("chain").state()
        for found in (state.modes(most=3), state.modes(progress=lambda found, part: found < 3)):
            self.assertEqual(len(found), 3)
            self.assertFalse(found.complete)

    def test_pass_on_what_progress_raises(self):
        def progress(found, part):
            raise KeyError(found)

        with self.assertRaises(KeyError):
            load("chain").state().modes(progress=progress)


class Flow(unittest.TestCase):
    def test_is_text_or_a_graph(self):
        mechanism = load("swash")
        self.assertIn("lever1.angle", mechanism.flow())
        self.assertTrue(mechanism.flow("dot").startswith("digraph"))
        with self.assertRaises(ValueError):
            mechanism.flow("png")


if __name__ == "__main__":
    unittest.main()
