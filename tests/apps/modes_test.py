"""koppel modes: how many closed positions the scenes have, and what the command prints of them."""

import math
import unittest

from program import FAR, FINE, FOURBAR, NOT_CLOSED, SCENE, SCENES, SYSTEM, UNDRIVEN, ProgramTest

# How many positions there are, from the sources that the scenes name, or by their geometry.
COUNTS = {"rstr": 4, "rscr": 2, "rccc": 2, "swash": 4, "4bar": 2, "6r_pose": 8, "3rpr": 6, "7r": 16, "chain": 8}


class Modes(ProgramTest):
    def test_all_are_found(self):
        for name, count in COUNTS.items():
            with self.subTest(scene=name):
                scene = SCENES / f"{name}.toml"
                document = self.json(FINE, "modes", scene)
                self.assertEqual(len(document["modes"]), count)
                self.assertIs(document["complete"], True, document["why"])
                self.assertEqual(document["diagnostics"], [])
                self.assertEqual(len({mode["id"] for mode in document["modes"]}), count)
                for mode in document["modes"]:
                    self.assertLess(mode["residual"], 1e-13)
                    self.assertEqual(list(mode["coordinates"]), list(document["modes"][0]["coordinates"]))

    def test_links_that_turn_over_unnoticed_are_listed_on_demand(self):
        scene = SCENES / "swash.toml"
        self.assertEqual(self.json(FINE, "modes", scene)["twins"], 4)
        document = self.json(FINE, "modes", scene, "--all-twins")
        self.assertEqual((len(document["modes"]), document["twins"]), (16, 1))

    def test_the_inputs_are_those_of_the_time(self):
        scene = self.write("scene.toml", FOURBAR)
        for time in (0.0, 0.125, 0.5):
            modes = self.json(FINE, "modes", scene, "--time", time)["modes"]
            self.assertEqual([mode["coordinates"]["crank.angle"] for mode in modes], [2 * math.pi * time] * 2)

    def test_a_search_ends_where_it_is_told_to(self):
        document = self.json(FINE, "modes", SCENES / "chain.toml", "--most", "3")
        self.assertEqual((len(document["modes"]), document["complete"]), (3, False))

    def test_an_open_chain_has_one(self):
        for name in ("arm2", "6r"):
            document = self.json(FINE, "modes", SCENES / f"{name}.toml")
            self.assertEqual((len(document["modes"]), document["complete"]), (1, True))

    def test_what_nothing_drives_stays_as_it_is(self):
        document = self.json(FINE, "modes", self.write("free.toml", UNDRIVEN))
        self.assertEqual(len(document["modes"]), 2)


class Table(ProgramTest):
    def test_has_what_tells_the_modes_apart(self):
        text = self.expect(FINE, "koppel", "modes", self.write("scene.toml", FOURBAR)).stdout
        lines = text.splitlines()
        self.assertEqual(lines[0], "fourbar: 2 assembly modes at t = 0 s")
        self.assertIn("rocker.angle [deg]", lines[1])
        self.assertNotIn("crank.angle", lines[1])
        self.assertTrue(lines[-1].startswith("complete: "))

    def test_fits_into_lines(self):
        text = self.expect(FINE, "koppel", "modes", SCENES / "7r.toml").stdout
        self.assertLessEqual(max(len(line) for line in text.splitlines()), 100)
        self.assertIn("more coordinates: --json has all", text)

    def test_keeps_silent_about_progress_where_nobody_watches(self):
        self.assertEqual(self.expect(FINE, "koppel", "modes", SCENES / "7r.toml").stderr, "")


class Unreachable(ProgramTest):
    def test_is_told_with_how_far_it_is(self):
        scene = self.write("far.toml", FAR)
        result = self.expect(NOT_CLOSED, "koppel", "modes", scene)
        self.assertIn("0 assembly modes", result.stdout)
        self.assertIn("there is no closed position", result.stderr)
        self.assertIn("stays open by", result.stderr)
        document = self.json(NOT_CLOSED, "modes", scene)
        self.assertEqual((document["modes"], document["complete"]), ([], True))
        self.assertEqual([finding["code"] for finding in document["diagnostics"]], ["E0701"])

    def test_is_not_what_a_search_says_that_cannot_know(self):
        result = self.start("koppel", "modes", SCENES / "7h.toml")
        self.assertIn(result.returncode, (FINE, NOT_CLOSED))
        self.assertIn("is a screw with a pitch", result.stdout + result.stderr)
        self.assertNotIn("there is no closed position", result.stderr)

    def test_scenes_with_faults_are_told_as_by_check(self):
        scene = self.write("bad.toml", FOURBAR.replace("slope", "slop"))
        self.assertEqual(self.json(SCENE, "modes", scene)["diagnostics"], self.json(SCENE, "check", scene)["diagnostics"])
        self.assertIsNone(self.json(SYSTEM, "modes", self.folder / "absent.toml")["modes"])


if __name__ == "__main__":
    unittest.main()
