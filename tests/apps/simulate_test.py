"""koppel simulate: its summary, its table and log, what it says where it cannot go on."""

import math
import unittest

from program import (FINE, NOT_CLOSED, SCENES, USAGE, ProgramTest, log_channels, read_table)

DYNAMICS = SCENES / "dynamics"

GHOST = """schema = 1
[[body]]
name = "ghost"
[[joint]]
name = "pin"
type = "revolute"
inlet = "ground"
outlet = "ghost"
"""


class Simulate(ProgramTest):
    def test_every_scene_of_the_folder_reaches_its_end(self):
        for scene in sorted(DYNAMICS.glob("*.toml")):
            with self.subTest(scene=scene.stem):
                document = self.json(FINE, "simulate", scene, "--tolerance", "1e-7")
                self.assertIs(document["finished"], True)
                self.assertEqual(document["time"], document["duration"])
                self.assertLess(document["position_drift"], 1e-13)
                # Each step may lose its tolerance, twice over since energy goes with the square of a rate.
                allowed = 20 * 1e-7 * document["steps"]
                self.assertLess(document["energy_error"], allowed * max(1e-3, document["energy_size"]))
                self.assertEqual([finding for finding in document["diagnostics"] if finding["severity"] == "error"], [])

    def test_the_summary_has_its_keys(self):
        document = self.json(FINE, "simulate", DYNAMICS / "andrews.toml")
        for key in ("scene", "finished", "time", "duration", "freedoms", "switches", "steps", "rejected", "evaluations",
                    "seconds", "energy", "energy_error", "energy_size", "position_drift", "velocity_drift",
                    "start_change", "final", "diagnostics"):
            self.assertIn(key, document)
        self.assertEqual(document["freedoms"], 1)
        # Published to ten digits; the default tolerance is 1e-8.
        self.assertAlmostEqual(document["final"]["coordinates"]["beta.angle"], 15.8107711952, delta=1e-5)

    def test_a_finer_tolerance_takes_more_steps_to_a_better_end(self):
        exact = math.asin(-0.275087462576116860)  # the pendulum after 10 s

        def run(tolerance):
            document = self.json(FINE, "simulate", DYNAMICS / "pendulum.toml", "--tolerance", tolerance)
            return document["steps"], abs(document["final"]["coordinates"]["pivot.angle"] - exact)

        coarse, fine = run(1e-5), run(1e-9)
        self.assertLess(coarse[0], fine[0])
        self.assertLess(100 * fine[1], coarse[1])

    def test_the_table_has_a_row_for_each_step_asked_for(self):
        self.expect(FINE, "koppel", "simulate", DYNAMICS / "pendulum.toml", "--steps", "20", "--duration", "2", "--csv",
                    "table.csv")
        table = read_table(self.folder / "table.csv")
        self.assertEqual(len(table["time"]), 21)
        self.assertEqual(table["time"][-1], 2.0)
        self.assertAlmostEqual(table["pivot.angle"][0], -math.pi / 2, delta=1e-15)

    def test_a_log_holds_every_state(self):
        self.expect(FINE, "koppel", "simulate", DYNAMICS / "pendulum.toml", "--steps", "10", "--log", "run.lcm")
        self.assertEqual(log_channels(self.folder / "run.lcm")["KOPPEL_PENDULUM_STATE"], 11)

    def test_text_tells_accuracy(self):
        text = self.expect(FINE, "koppel", "simulate", DYNAMICS / "nfourbar.toml").stdout
        for word in ("freedoms", "steps", "energy", "loops"):
            self.assertIn(word, text)

    def test_what_has_no_mass_is_named(self):
        document = self.json(NOT_CLOSED, "simulate", self.write("ghost.toml", GHOST))
        self.assertIs(document["finished"], False)
        self.assertEqual(document["error"]["code"], "E1002")
        self.assertIn("pin.angle", document["error"]["element"])

    def test_wrong_usage(self):
        scene = DYNAMICS / "pendulum.toml"
        for arguments in ([], [scene, "--tolerance", "0"], [scene, "--tolerance", "1e-6", "--step", "0.1"],
                          [scene, "--steps", "0"], [scene, "--json", "--csv", "-"]):
            with self.subTest(arguments=arguments):
                self.expect(USAGE, "koppel", "simulate", *arguments)


if __name__ == "__main__":
    unittest.main()
