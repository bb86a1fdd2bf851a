"""The koppel command: exit codes, what goes where, and the keys of --json."""

import math
import re
import unittest

from program import (FAR, FINE, FOURBAR, LOCKED, NOT_CLOSED, OVERDRIVEN, SCENE, SCENES, SYSTEM, UNDRIVEN, USAGE,
                     ProgramTest, log_channels, read_table)


class Usage(ProgramTest):
    def test_help_teaches_by_examples_and_names_the_exit_codes(self):
        text = self.expect(FINE, "koppel", "--help").stdout
        for word in ("check", "explain", "modes", "run", "simulate", "Examples:", "Exit codes:"):
            self.assertIn(word, text)
        for command in ("check", "explain", "modes", "run", "simulate"):
            self.assertIn("Examples:", self.expect(FINE, "koppel", command, "--help").stdout)

    def test_version_is_printed(self):
        self.assertRegex(self.expect(FINE, "koppel", "--version").stdout, r"^koppel \d+\.\d+\.\d+\n$")

    def test_wrong_usage_is_told_apart_from_wrong_scenes(self):
        scene = self.write("scene.toml", FOURBAR)
        for arguments in ([], ["fly"], ["check"], ["run", scene, "--steps", "0"], ["run", scene, "--duration", "-1"],
                          ["run", scene, "--lcm", "memq://", "--log", "x.lcm"],
                          ["run", scene, "--json", "--csv", "-"], ["modes"], ["modes", scene, "--time", "inf"],
                          ["modes", scene, "--most", "0"], ["explain", scene, "--flow", "flow.png"],
                          ["explain", scene, "--flow", ".svg"]):
            with self.subTest(arguments=arguments):
                result = self.expect(USAGE, "koppel", *arguments)
                self.assertEqual(result.stdout, "")
                self.assertNotEqual(result.stderr, "")

    def test_wrong_values_are_told_in_a_line(self):
        scene = self.write("scene.toml", FOURBAR)
        for option, values, message in (
                ("--duration", ("0", "-1", "soon", "inf", "nan"), "must be a positive number of seconds"),
                ("--steps", ("0", "-1", "2.5", "many"), "must be a whole number from 1 to 1000000000")):
            for value in values:
                with self.subTest(option=option, value=value):
                    result = self.expect(USAGE, "koppel", "run", scene, option, value)
                    self.assertEqual(result.stderr.splitlines()[0], f"{option}: {message}")

    def test_an_empty_name_is_wrong_usage(self):
        scene = self.write("scene.toml", FOURBAR)
        for arguments in (["check", ""], ["explain", ""], ["modes", ""], ["run", ""], ["run", scene, "--csv", ""],
                          ["run", scene, "--log", ""], ["run", scene, "--lcm", ""], ["run", scene, "--name", ""]):
            with self.subTest(arguments=arguments):
                self.assertIn("must not be empty", self.expect(USAGE, "koppel", *arguments).stderr)

    def test_a_stream_that_lcm_cannot_have_is_wrong_usage(self):
        scene = self.write("scene.toml", FOURBAR)
        for code, arguments in (("E0801", ["--lcm", "bogus://here"]), ("E0803", ["--lcm", "memq://", "--name", "a b"])):
            with self.subTest(code=code):
                self.assertIn(code, self.expect(USAGE, "koppel", "run", scene, *arguments).stderr)


class Check(ProgramTest):
    def test_start_values_that_give_way_are_told_and_fixed_ones_do_not(self):
        text = (SCENES / "dynamics" / "fourbar_free.toml").read_text()
        wished = text.replace("start = { angle = 0.7 }", "start = { angle = 0.9 }")
        self.assertNotEqual(wished, text)
        document = self.json(FINE, "check", self.write("wished.toml", wished))
        crank = next(each for each in document["moved"] if each["coordinate"] == "crank.angle")
        self.assertEqual(crank["from"], 0.9)
        self.assertGreater(abs(crank["to"] - 0.9), 0.01)
        changes = [abs(each["to"] - each["from"]) for each in document["moved"]]
        self.assertEqual(changes, sorted(changes, reverse=True))
        self.assertIn("crank.angle from 0.9 to", self.expect(FINE, "koppel", "check", "wished.toml").stdout)
        fixed = wished.replace("start = { angle = 0.9 }", "start = { angle = 0.9 }\nfixed = ['angle']")
        moved = self.json(FINE, "check", self.write("fixed.toml", fixed))["moved"]
        self.assertNotIn("crank.angle", [each["coordinate"] for each in moved])
        self.assertEqual(self.json(FINE, "check", SCENES / "dynamics" / "fourbar_free.toml")["moved"], [])

    def test_a_good_scene_shows_its_freedoms(self):
        result = self.expect(FINE, "koppel", "check", self.write("scene.toml", FOURBAR))
        self.assertIn("mobility", result.stdout)
        self.assertEqual(result.stderr, "")

    def test_json_counts_freedoms_loops_and_redundant_equations(self):
        document = self.json(FINE, "check", self.write("scene.toml", FOURBAR))
        self.assertEqual(document["mobility"], {"count": -2, "rank": 1})
        self.assertEqual(document["freedoms"], {"by_kind": 1, "nearby": 1, "planar_loops": 1, "spherical_loops": 0,
                                                "isolated": 0, "indeterminate": 4, "shaky": False})
        self.assertEqual(document["loops"], 1)
        self.assertEqual(document["diagnostics"], [])
        self.assertIs(document["closed"], True)
        self.assertLess(document["residual"], 1e-13)

    def test_all_faults_are_found_at_once_with_place_and_remedy(self):
        text = FOURBAR.replace('"revolute"', '"revolut"', 1)
        text = text.replace("slope", "slop").replace('"rocker.angle"', '"roker.angle"')
        scene = self.write("bad.toml", text)
        findings = [f for f in self.json(SCENE, "check", scene)["diagnostics"] if f["severity"] == "error"]
        self.assertGreaterEqual(len(findings), 3)
        self.assertEqual({"code", "severity", "file", "line", "column", "message", "advice", "element"},
                         set(findings[0]))
        lines = text.splitlines()
        marked = " ".join(lines[finding["line"] - 1] for finding in findings)
        for word in ('"revolut"', "slop =", '"roker.angle"'):
            self.assertIn(word, marked)
        printed = self.expect(SCENE, "koppel", "check", scene).stderr
        self.assertIn("bad.toml:", printed)
        self.assertIn("^", printed)

    def test_a_scene_that_is_not_toml_is_a_faulty_scene(self):
        self.expect(SCENE, "koppel", "check", self.write("bad.toml", "schema = = 1\n"))

    def test_a_missing_file_is_no_faulty_scene(self):
        self.expect(SYSTEM, "koppel", "check", self.folder / "absent.toml")
        document = self.json(SYSTEM, "check", self.folder / "absent.toml")
        self.assertEqual(document["diagnostics"][0]["code"], "E0101")
        self.assertIsNone(document["mobility"])

    def test_a_mechanism_out_of_reach_does_not_close(self):
        document = self.json(NOT_CLOSED, "check", self.write("far.toml", FAR))
        self.assertIs(document["closed"], False)
        self.assertEqual([finding["code"] for finding in document["diagnostics"]], ["E0706"])

    def test_rates_that_are_impossible_are_found(self):
        scene = self.write("over.toml", OVERDRIVEN)
        document = self.json(NOT_CLOSED, "check", scene)
        self.assertIs(document["closed"], True)
        self.assertEqual([finding["code"] for finding in document["diagnostics"]], ["W0703", "E0703"])
        self.assertIn("2 inputs, but only 1 freedom\n", self.expect(NOT_CLOSED, "koppel", "check", scene).stderr)

    def test_too_many_inputs_are_told_even_where_they_fit(self):
        rest = OVERDRIVEN.replace('slope = "360 deg"', "slope = 0").replace("slope = 1.0", "slope = 0")
        document = self.json(FINE, "check", self.write("rest.toml", rest))
        self.assertEqual([finding["code"] for finding in document["diagnostics"]], ["W0703"])


class Explain(ProgramTest):
    def test_a_code_is_explained(self):
        self.assertIn("cannot be read", self.expect(FINE, "koppel", "explain", "E0101").stdout)

    def test_a_code_may_be_written_small_or_without_its_letter(self):
        text = self.expect(FINE, "koppel", "explain", "E0701").stdout
        for code in ("e0701", "0701", "701"):
            self.assertEqual(self.expect(FINE, "koppel", "explain", code).stdout, text)

    def test_the_code_that_help_shows_exists(self):
        for arguments in (["--help"], ["explain", "--help"]):
            codes = re.findall(r"\bE\d{4}\b", self.expect(FINE, "koppel", *arguments).stdout)
            self.assertTrue(codes)
            for code in codes:
                self.expect(FINE, "koppel", "explain", code)

    def test_an_unknown_code_is_wrong_usage(self):
        self.expect(USAGE, "koppel", "explain", "E9999")

    def test_a_scene_is_explained(self):
        self.assertIn("crank", self.expect(FINE, "koppel", "explain", self.write("scene.toml", FOURBAR)).stdout)

    def test_the_freedoms_of_a_scene_are_explained(self):
        text = self.expect(FINE, "koppel", "explain", self.write("scene.toml", FOURBAR)).stdout
        self.assertIn("planar across (0, 0, 1), closed by 3 conditions", text)
        self.assertIn("rocker: moment about x y, force along z", text)

    def test_what_does_not_close_is_explained_without_freedoms(self):
        text = self.expect(FINE, "koppel", "explain", self.write("far.toml", FAR)).stdout
        self.assertIn("Spanning tree", text)
        self.assertIn("does not close at t = 0", text)


# The spatial four-bar whose crank swings to and fro.
LONG_CRANK = ((SCENES / "rstr.toml").read_text().replace("crank = 0.10", "crank = 0.30")
              .replace('slope = "360 deg"', 'start = "100 deg"\nslope = "10 deg"')
              .replace("duration = 1.0", "duration = 20.0"))

# Opposite links of equal length; at half time, with the crank at 180 deg, all are in line.
PARALLELOGRAM = ((SCENES / "4bar.toml").read_text().replace("crank = 0.12", "crank = 0.25")
                 .replace("coupler = 0.35", "coupler = 0.40")
                 .replace('start = { angle = "45 deg" }', 'start = { angle = "-90 deg" }')
                 .replace('start = { angle = "97.5 deg" }', 'start = { angle = "90 deg" }')
                 .replace('slope = "360 deg"', 'start = "90 deg"\nslope = "180 deg"'))


class Run(ProgramTest):
    def test_json_tells_accuracy_and_time_of_steps(self):
        document = self.json(FINE, "run", self.write("scene.toml", FOURBAR), "--steps", "25")
        self.assertEqual(document["steps"], 25)
        self.assertLess(document["max_residual"], 1e-13)
        self.assertEqual(document["mobility"], {"count": -2, "rank": 1})
        self.assertEqual(document["jacobian_rank"], 3)
        self.assertGreater(document["seconds_per_step"], 0.0)
        self.assertGreaterEqual(document["seconds_per_step_error"], 0.0)
        self.assertIs(document["remarks"]["redundant"], True)

    def test_the_summary_goes_to_standard_output_unless_quiet(self):
        scene = self.write("scene.toml", FOURBAR)
        self.assertIn("40 of 40 steps", self.expect(FINE, "koppel", "run", scene).stdout)
        self.assertEqual(self.expect(FINE, "koppel", "run", scene, "--quiet").stdout, "")

    def test_a_run_that_stops_says_where(self):
        scene = self.write("locked.toml", LOCKED)
        result = self.expect(NOT_CLOSED, "koppel", "run", scene)
        self.assertRegex(result.stderr, r"step \d+, t = ")
        document = self.json(NOT_CLOSED, "run", scene)
        self.assertIs(document["closed"], False)
        self.assertLess(document["steps"], 40)
        error = document["error"]
        self.assertRegex(error["code"], r"^E07\d\d$")
        self.assertEqual(error["step"], document["steps"] + 1)  # the first closure is no step
        self.assertEqual(error["time"], error["step"] / 40)
        self.assertEqual(document["diagnostics"][-1]["code"], error["code"])

    def test_a_run_that_does_not_start_has_the_counts_of_check(self):
        for text in (FAR, OVERDRIVEN):
            scene = self.write("scene.toml", text)
            counts = self.json(NOT_CLOSED, "check", scene)
            document = self.json(NOT_CLOSED, "run", scene)
            for key in ("mobility", "jacobian_rank", "equations", "rank"):
                self.assertEqual(document[key], counts[key])
            self.assertEqual((document["error"]["step"], document["error"]["time"]), (0, 0.0))
            self.assertEqual(document["steps"], 0)
            for key in ("max_residual", "condition", "assembly", "seconds_per_step"):
                self.assertIsNone(document[key])

    def test_a_run_without_a_step_tells_no_time_of_steps(self):
        result = self.expect(NOT_CLOSED, "koppel", "run", self.write("locked.toml", LOCKED), "--steps", "2")
        self.assertIn("0 of 2 steps", result.stdout)
        self.assertIn("\nassembly ", result.stdout)
        for line in ("\nstep ", "\niterations "):
            self.assertNotIn(line, result.stdout)

    def test_findings_of_a_scene_stand_in_json(self):
        document = self.json(SCENE, "run", self.write("bad.toml", FOURBAR.replace("slope", "slop")))
        self.assertEqual(document["diagnostics"][0]["code"], document["error"]["code"])
        self.assertIsNone(document["error"]["step"])
        self.assertEqual(self.json(FINE, "run", self.write("scene.toml", FOURBAR))["diagnostics"], [])

    def test_a_step_over_a_limit_does_not_jump_to_another_branch(self):
        # The ring goes no further than 90 deg; steps of several turns do not hide that.
        for steps in ("2", "1000"):
            arguments = ["run", SCENES / "drive.toml", "--duration", "10", "--steps", steps]
            document = self.json(NOT_CLOSED, *arguments)
            self.assertIs(document["remarks"]["branch_changed"], False)
            self.assertEqual(document["error"]["code"], "E0705")
            self.assertEqual(document["error"]["limit"]["drive"], "ring.angle")
            self.assertAlmostEqual(document["error"]["limit"]["value"], math.radians(90), places=9)
        self.assertIsNone(self.json(FINE, "run", self.write("scene.toml", FOURBAR))["branch_changed_time"])

    def test_a_limit_is_told_and_passed_if_asked(self):
        scene = self.write("rstr.toml", LONG_CRANK)
        error = self.expect(NOT_CLOSED, "koppel", "run", scene).stderr
        for text in ("`crank.angle` goes no further than 169.486774773 deg", "6.948677477 s", "reverse the drive",
                     "drive `cardan.angle1` instead", "--through"):
            self.assertIn(text, error)
        limit = self.json(NOT_CLOSED, "run", scene)["error"]["limit"]
        self.assertAlmostEqual(limit["time"], 6.9486774773, places=9)
        document = self.json(FINE, "run", scene, "--through", "--duration", "60")
        self.assertEqual(document["steps"], 360)
        upper, lower = document["limits"][:2]
        self.assertAlmostEqual(math.degrees(upper["value"]), 169.486774773, places=8)
        self.assertAlmostEqual(math.degrees(lower["value"]), 40.333054067, places=8)

    def test_the_table_of_a_run_through_limits_has_the_time_of_the_drives(self):
        scene = self.write("rstr.toml", LONG_CRANK)
        table = self.folder / "through.csv"
        self.expect(FINE, "koppel", "run", scene, "--through", "--csv", table)
        columns = read_table(table)
        times = columns["drive_time"]
        self.assertGreater(max(times), times[-1])
        for crank, time in zip(columns["crank.angle"], times):
            self.assertAlmostEqual(math.degrees(crank), 100 + 10 * time, places=9)
        self.assertLess(max(columns["residual"]), 1e-13)

    def test_a_parallelogram_stays_one_or_folds_over_as_asked(self):
        scene = self.write("parallelogram.toml", PARALLELOGRAM)
        for steps in ("7", "40", "1000"):
            for branch, same in (("stay", True), ("take", False)):
                table = self.folder / "branch.csv"
                result = self.expect(FINE, "koppel", "run", scene, "--steps", steps, "--branch", branch, "--csv", table)
                self.assertIn("passes 1 change points", result.stdout)
                columns = read_table(table)
                self.assertEqual(abs(columns["crank.angle"][-1] - columns["rocker.angle"][-1]) < 1e-11, same)
        document = self.json(FINE, "run", scene, "--steps", "40")
        self.assertEqual(document["change_points"], 1)
        self.assertAlmostEqual(document["change_point_time"], 0.5, places=10)
        self.assertIs(document["remarks"]["change_point"], True)

    def test_the_coordinate_that_leaves_its_limits_is_named(self):
        text = FOURBAR.replace("at = [0, 0, 0]", 'at = [0, 0, 0]\nlimits = { angle = [0, "90 deg"] }', 1)
        scene = self.write("limited.toml", text)
        self.assertIn("leaves the limits of crank.angle first at t = 0.26 s",
                      self.expect(FINE, "koppel", "run", scene, "--steps", "50").stdout)
        self.assertIs(self.json(FINE, "run", scene, "--steps", "50")["remarks"]["limit_exceeded"], True)

    def test_a_mechanism_that_nothing_drives_is_noted(self):
        scene = self.write("undriven.toml", UNDRIVEN)
        self.assertEqual(self.expect(FINE, "koppel", "run", scene).stderr, "note: nothing is driven: nothing moves\n")
        self.assertEqual(self.expect(FINE, "koppel", "run", scene, "--quiet").stderr, "")

    def test_the_library_logs_only_when_asked(self):
        scene = self.write("scene.toml", FOURBAR)
        self.assertEqual(self.expect(FINE, "koppel", "run", scene).stderr, "")
        self.expect(FINE, "koppel", "run", scene, "--verbose")


class Table(ProgramTest):
    def test_a_table_has_time_records_and_residual(self):
        scene = self.write("scene.toml", FOURBAR)
        self.expect(FINE, "koppel", "run", scene, "--csv", "run.csv")
        table = read_table(self.folder / "run.csv")
        self.assertEqual(list(table), ["time", "crank.angle", "rocker.angle", "residual"])
        self.assertEqual(len(table["time"]), 41)
        self.assertEqual(table["time"][-1], 1.0)
        # The drive is a line: its value is exact but for the rounding of 360 deg and of the product.
        for time, angle in zip(table["time"], table["crank.angle"]):
            self.assertLessEqual(abs(angle - 2 * math.pi * time), 4 * math.ulp(2 * math.pi))

    def test_a_turn_ends_where_it_began(self):
        scene = self.write("scene.toml", FOURBAR)
        self.expect(FINE, "koppel", "run", scene, "--csv", "run.csv")
        rocker = read_table(self.folder / "run.csv")["rocker.angle"]
        self.assertLess(abs(rocker[-1] - rocker[0]), 1e-13)
        self.assertGreater(max(rocker) - min(rocker), 0.5)

    def test_a_table_on_standard_output_stands_alone(self):
        result = self.expect(FINE, "koppel", "run", self.write("scene.toml", FOURBAR), "--csv", "-")
        lines = result.stdout.splitlines()
        self.assertEqual(lines[0], "time,crank.angle,rocker.angle,residual")
        self.assertEqual(len(lines), 42)
        self.assertIn("40 of 40 steps", result.stderr)

    def test_zero_has_no_sign(self):
        table = self.expect(FINE, "koppel", "run", SCENES / "4bar.toml", "--steps", "8", "--csv", "-").stdout
        cells = [cell for line in table.splitlines() for cell in line.split(",")]
        self.assertIn("0", cells)
        self.assertNotIn("-0", cells)

    def test_a_table_that_cannot_be_written_is_reported(self):
        scene = self.write("scene.toml", FOURBAR)
        self.expect(SYSTEM, "koppel", "run", scene, "--csv", "absent/run.csv")
        error = self.json(SYSTEM, "run", scene, "--csv", "absent/run.csv")["error"]
        self.assertEqual((error["message"], error["step"]), ("cannot write absent/run.csv", None))


class Log(ProgramTest):
    def test_a_log_holds_every_state(self):
        scene = self.write("scene.toml", FOURBAR)
        document = self.json(FINE, "run", scene, "--log", "run.lcm")
        self.assertEqual(document["stream"], {"published": 41, "sent": 41, "dropped": 0})
        channels = log_channels(self.folder / "run.lcm")
        self.assertEqual(channels["KOPPEL_FOURBAR_STATE"], 41)
        self.assertGreaterEqual(channels["KOPPEL_FOURBAR_MODEL"], 1)

    def test_a_name_changes_the_channels(self):
        scene = self.write("scene.toml", FOURBAR)
        self.expect(FINE, "koppel", "run", scene, "--log", "run.lcm", "--name", "LEFT")
        self.assertEqual(log_channels(self.folder / "run.lcm")["KOPPEL_LEFT_STATE"], 41)

    def test_a_log_that_cannot_be_written_is_reported(self):
        self.expect(SYSTEM, "koppel", "run", self.write("scene.toml", FOURBAR), "--log", "absent/run.lcm")


if __name__ == "__main__":
    unittest.main()
