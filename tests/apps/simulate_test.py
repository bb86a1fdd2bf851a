"""koppel simulate: its summary, its table and log, what it says where it cannot go on."""

import math
import subprocess
import time
import unittest

from program import (BIN, FINE, NOT_CLOSED, SCENES, SYSTEM, USAGE, ProgramTest, log_channels, read_table)

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
                    "events", "integrator", "tolerance", "step", "stiff", "seconds", "energy", "energy_error", "energy_size", "position_drift", "velocity_drift",
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

    def test_integrators_by_name(self):
        ends = {}
        for name, how in (("dormand_prince", ("--tolerance", "1e-9")), ("dop853", ("--tolerance", "1e-9")),
                          ("cvode", ("--tolerance", "1e-9")), ("arkode", ("--tolerance", "1e-9")),
                          ("classical", ("--step", "0.001")), ("semi_implicit", ("--step", "0.001"))):
            document = self.json(FINE, "simulate", DYNAMICS / "fourbar_free.toml", "--duration", "1", "--integrator",
                                 name, *how)
            self.assertEqual(document["integrator"], name)
            self.assertIs(document["stiff"], False)
            ends[name] = document["final"]["coordinates"]["crank.angle"]
        for name, end in ends.items():
            self.assertAlmostEqual(end, ends["dop853"], delta=0.05 if name == "semi_implicit" else 1e-5)

    def test_crossings_are_told_and_stop_the_motion(self):
        watches = """
[[watch]]
name = "lowest"
of = "pivot.angle"
value = 0
[[watch]]
name = "turns"
of = "pivot.angle"
quantity = "rate"
stop = true
"""
        scene = self.write("watched.toml", (DYNAMICS / "pendulum.toml").read_text() + watches)
        document = self.json(FINE, "simulate", scene, "--tolerance", "1e-10", "--csv", "rows.csv")
        self.assertEqual([crossing["watch"] for crossing in document["crossings"]], ["lowest", "turns"])
        lowest, turns = document["crossings"]
        self.assertFalse(lowest["stop"])
        self.assertTrue(turns["stop"])
        self.assertAlmostEqual(turns["time"], 2 * lowest["time"], delta=1e-7)
        self.assertEqual(document["time"], turns["time"])
        rows = (self.folder / "rows.csv").read_text().splitlines()
        self.assertAlmostEqual(float(rows[-1].split(",")[0]), turns["time"], delta=1e-12)
        text = self.expect(FINE, "koppel", "simulate", scene)
        self.assertIn("turns", text.stdout)
        self.assertIn("stopped there", text.stdout)

    def test_an_unknown_integrator_is_told_the_choices(self):
        document = self.json(USAGE, "simulate", DYNAMICS / "pendulum.toml", "--integrator", "rk45")
        self.assertEqual(document["error"]["code"], "E0309")
        for name in ("dormand_prince", "classical", "dop853", "cvode", "arkode", "semi_implicit"):
            self.assertIn(name, document["error"]["advice"])

    def test_formulations_are_chosen_by_name(self):
        ends = {}
        for name in ("minimal", "projected", "baumgarte"):
            document = self.json(FINE, "simulate", DYNAMICS / "fourbar_free.toml", "--duration", "1", "--formulation", name)
            self.assertEqual(document["formulation"], name)
            ends[name] = document["final"]["coordinates"]["crank.angle"]
            self.assertAlmostEqual(ends[name], ends["minimal"], delta=1e-5)
        for how in (("--formulation", "ggl"), ("--integrator", "generalised_alpha", "--step", "0.001")):
            document = self.json(FINE, "simulate", DYNAMICS / "fourbar_free.toml", "--duration", "1", *how)
            self.assertEqual((document["formulation"], document["integrator"]),
                             ("ggl", "ida") if "ggl" in how else ("index3", "generalised_alpha"))
            self.assertAlmostEqual(document["final"]["coordinates"]["crank.angle"], ends["minimal"], delta=1e-4)
        document = self.json(USAGE, "simulate", DYNAMICS / "fourbar_free.toml", "--formulation", "maximal")
        self.assertEqual(document["error"]["code"], "E0310")

    def test_a_scene_names_its_integrator(self):
        text = (DYNAMICS / "pendulum.toml").read_text() + "\n[simulation]\nintegrator = 'dop853'\n"
        document = self.json(FINE, "simulate", self.write("dop853.toml", text))
        self.assertEqual(document["integrator"], "dop853")
        self.assertEqual(self.json(FINE, "simulate", "dop853.toml", "--step", "0.01")["integrator"], "classical")

    def test_a_run_that_is_killed_goes_on_bit_for_bit(self):
        for integrator in ("dop853", "cvode"):
            how = ("simulate", DYNAMICS / "pendulum.toml", "--duration", "1", "--steps", "50", "--checkpoint-every", "0.2")
            by = ("--integrator", integrator)
            whole = self.json(FINE, *how, *by, "--checkpoint", "whole.ck")
            kept = self.folder / f"{integrator}.ck"
            with subprocess.Popen([BIN / "koppel", *map(str, how), *by, "--quiet", "--realtime", "--checkpoint", kept],
                                  cwd=self.folder) as run:
                while not kept.exists() and run.poll() is None:
                    time.sleep(0.01)
                run.kill()
            rest = self.json(FINE, *how, "--resume", kept, "--checkpoint", kept)
            for key in ("integrator", "final", "steps", "energy_error"):
                self.assertEqual(rest[key], whole[key])

    def test_a_checkpoint_of_another_scene_is_refused(self):
        self.expect(FINE, "koppel", "simulate", DYNAMICS / "pendulum.toml", "--checkpoint", "pendulum.ck")
        document = self.json(USAGE, "simulate", DYNAMICS / "andrews.toml", "--resume", "pendulum.ck")
        self.assertIn("another scene", document["error"]["message"])
        self.json(USAGE, "simulate", DYNAMICS / "andrews.toml", "--resume", self.write("no.ck", "nothing"))
        self.json(SYSTEM, "simulate", DYNAMICS / "andrews.toml", "--resume", "missing.ck")

    def test_the_error_is_estimated_on_request(self):
        exact = math.asin(-0.275087462576116860)
        document = self.json(FINE, "simulate", DYNAMICS / "pendulum.toml", "--tolerance", "1e-6", "--estimate")
        error = abs(document["final"]["coordinates"]["pivot.angle"] - exact)
        # The finer one has about a tenth of the error, so that the difference is nearly all of it.
        self.assertGreater(document["global_error"]["end"], 0.5 * error)
        self.assertLess(document["global_error"]["end"], 2 * error)
        self.assertGreaterEqual(document["global_error"]["greatest"], document["global_error"]["end"])
        fixed = self.json(FINE, "simulate", DYNAMICS / "pendulum.toml", "--step", "0.02", "--estimate")
        error = abs(fixed["final"]["coordinates"]["pivot.angle"] - exact)
        self.assertAlmostEqual(fixed["global_error"]["end"] / error, 15 / 16, delta=0.1)  # order 4
        self.assertNotIn("global_error", self.json(FINE, "simulate", DYNAMICS / "pendulum.toml"))

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
