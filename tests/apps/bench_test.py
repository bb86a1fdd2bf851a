"""koppel bench: its document, its tables and page; errors as they are promised. Times are looked at, never judged."""

import json
import os
import unittest
from xml.etree import ElementTree

from program import FINE, SYSTEM, USAGE, ProgramTest, SCENES

# Under sanitizers all of it would take too long: there only these are run, of each section some.
FEW = ("simulation/pendulum", "simulation/bricard", "closure/4bar", "closure/5link", "scaling/fourbar_chain",
       "case/parallelogram", "case/dead_centre", "case/far_starts", "case/masses")
SANITIZED = bool(os.environ.get("KOPPEL_SANITIZED"))
NAMES = FEW if SANITIZED else ()

PLOTS = ["pendulum", "closures", "scaling"]
# The sanitizers' own malloc keeps no account of what is held: no memory is told then, none is drawn.
PLOTS += [] if SANITIZED else ["memory"]

WORSE = 5  # the exit code

SECTIONS = {"simulation": "simulations", "closure": "closures", "scaling": "scaling", "case": "cases",
            "profile": "profiles"}


def points_of(document):
    """All points of all curves of simulations that got to their end."""
    for problem in document["simulations"]:
        for series in problem.get("series", ()):
            for point in series["points"]:
                if point["finished"]:
                    yield problem, series, point


class Document(ProgramTest):
    """One run, looked at from all sides."""

    @classmethod
    def setUpClass(cls):
        cls.document = None

    def setUp(self):
        super().setUp()
        if Document.document is None:
            Document.document = self.json(FINE, "bench", "--quick", *NAMES)
        self.document = Document.document

    def test_it_says_what_it_is_and_what_it_was_taken_on(self):
        self.assertEqual(self.document["schema"], "koppel-bench/1")
        self.assertIs(self.document["quick"], True)
        machine = self.document["machine"]
        for key in ("processor", "cores", "system", "compiler", "flags", "koppel", "load", "yardstick"):
            self.assertIn(key, machine)
        self.assertEqual(set(machine["load"]), {"before", "after"})

    def test_everything_asked_for_is_there(self):
        listed = NAMES or self.expect(FINE, "koppel", "bench", "--list").stdout.split()
        for name in listed:
            section, one = name.split("/")
            entries = [entry["name"] for entry in self.document[SECTIONS[section]]]
            self.assertEqual(entries.count(one), 1, name)

    def test_every_time_is_the_median_of_three_repeats_within_its_spread(self):
        def timed(value):
            if isinstance(value, dict):
                if isinstance(value.get("seconds"), dict):
                    yield value["seconds"]
                value = list(value.values())
            if isinstance(value, list):
                for one in value:
                    yield from timed(one)

        times = list(timed(self.document))
        self.assertGreater(len(times), 20)
        for seconds in times:
            self.assertGreaterEqual(seconds["repeats"], 3)
            self.assertTrue(0 < seconds["least"] <= seconds["median"] <= seconds["greatest"], seconds)

    def test_an_error_below_that_of_the_reference_is_shown_as_a_bound(self):
        for problem, _, point in points_of(self.document):
            uncertainty = problem["reference"]["uncertainty"]
            self.assertGreaterEqual(point["error"], uncertainty)
            self.assertEqual(point["bound"], point["error"] == uncertainty)

    def test_a_finer_tolerance_comes_nearer_to_the_reference(self):
        # From the coarsest tolerance to the finest there are six decades. An error goes at least with the power 4/5 of
        # a tolerance per step at order 5, that is by almost five decades; three are asked for.
        for problem in self.document["simulations"]:
            points = problem["series"][0]["points"]
            with self.subTest(problem=problem["name"]):
                self.assertTrue(all(point["finished"] for point in points))
                self.assertLessEqual(points[-1]["setting"], 1e-6 * points[0]["setting"] * (1 + 1e-12))
                if not points[-1]["bound"]:
                    self.assertLess(points[-1]["error"], 1e-3 * points[0]["error"])

    def test_loops_stay_closed_whatever_the_setting(self):
        # With steps by tolerance down to rounding; a step that is given may be so long that it ends beside a singular
        # position, and there what koppel.h calls closed must do. With ggl loops are equations like others: as exact as
        # a step.
        allowed = {"tolerance": 1e-13, "step": 1e-10}
        for problem, series, point in points_of(self.document):
            most = 10 * point["setting"] if series["method"] == "ggl" else allowed[series["setting"]]
            self.assertLess(point["position_drift"], most, problem["name"])

    def test_loops_kept_as_constraints_come_to_the_same_reference(self):
        for problem in self.document["simulations"]:
            errors = {series["method"]: min(point["error"] for point in series["points"] if point["finished"])
                      for series in problem["series"]}
            with self.subTest(problem=problem["name"]):
                for method in {"ggl", "index3"} & set(errors):
                    self.assertLess(errors[method], 1e-2)

    def test_what_is_called_closed_is_closed_to_rounding(self):
        for scene in self.document["closures"]:
            for way in scene["ways"]:
                with self.subTest(scene=scene["name"], way=way["way"]):
                    if way["way"] == "step":
                        self.assertEqual(way["failed"], 0)
                    if way["closed"]:
                        self.assertLess(way["residual"], 1e-13)

    def test_chains_of_any_length_are_as_exact(self):
        for chain in self.document["scaling"]:
            for point in chain["points"]:
                with self.subTest(chain=chain["name"], size=point["size"]):
                    self.assertIs(point["finished"], True)
                    # Of motions each step may be off by the tolerance, a hundredfold at the end; of positions by
                    # rounding in each link of the row.
                    allowed = (100 * chain["tolerance"] * point["evaluations"] / 6 if "tolerance" in chain
                               else 1e-14 * point["size"])
                    self.assertLess(point["error"], allowed)

    def test_shares_of_a_profile_sum_to_one(self):
        for scene in self.document["profiles"]:
            with self.subTest(scene=scene["name"]):
                if "why" in scene:
                    self.assertEqual(scene["parts"], [])
                    continue
                self.assertGreater(scene["samples"], 0)
                self.assertGreater(scene["runs"], 0)
                self.assertEqual(scene["parts"][-1]["part"], "other")
                self.assertAlmostEqual(sum(part["share"] for part in scene["parts"]), 1.0, delta=1e-12)
                self.assertLess(scene["parts"][-1]["share"], 1.0)

    def test_each_part_of_a_profile_has_a_share_somewhere(self):
        shares = {}
        for scene in self.document["profiles"]:
            for part in scene["parts"]:
                shares[part["part"]] = shares.get(part["part"], 0.0) + part["share"]
        # Ceres is asked only where nearer ways fail; without any shares the names of functions are not known.
        self.assertEqual([part for part in shares if part != "Ceres" and shares[part] == 0.0], [])

    def test_every_hard_case_comes_out_as_it_should(self):
        for case in self.document["cases"]:
            with self.subTest(case=case["name"]):
                self.assertIs(case["pass"], True, case["found"])
                self.assertLessEqual(case["error"], case["allowed"])
                for key in ("what", "expected", "found"):
                    self.assertTrue(case[key])


class Files(ProgramTest):
    def test_results_stand_in_a_folder_as_document_tables_plots_and_page(self):
        names = ("pendulum", "closure/4bar", "case/parallelogram", "fourbar_chain")
        result = self.expect(FINE, "koppel", "bench", "--quick", "--out", "made/results", *names)
        folder = self.folder / "made" / "results"
        self.assertEqual(json.loads((folder / "bench.json").read_text())["schema"], "koppel-bench/1")
        for section in SECTIONS.values():
            lines = (folder / f"{section}.csv").read_text().splitlines()
            self.assertGreater(len(lines), 1)
            self.assertTrue(lines[0].startswith("name,"))
        for plot in PLOTS:
            root = ElementTree.parse(folder / f"{plot}.svg").getroot()
            self.assertEqual(root.tag, "{http://www.w3.org/2000/svg}svg")
        self.assertIn("pass  parallelogram", result.stdout)
        self.assertIn("bench.html", result.stderr)
        self.look_at((folder / "bench.html").read_text())

    def look_at(self, page):
        """The page is XML but for its first line, has a plot of each kind, and needs nothing from elsewhere."""
        root = ElementTree.fromstring(page.split("\n", 1)[1])
        self.assertGreaterEqual(len(root.findall(".//svg")), len(PLOTS))
        self.assertIn("parallelogram", page)
        for outside in ("http:", "https:", "src=", "href=", "url(", "@import"):
            self.assertNotIn(outside, page)


class Compare(ProgramTest):
    NAMES = ("simulation/pendulum", "closure/4bar", "scaling/fourbar_row", "case/parallelogram")

    def old(self, change):
        """The document of a run, changed, as a file."""
        document = self.json(FINE, "bench", "--quick", *self.NAMES)
        change(document)
        return self.write("old.json", json.dumps(document))

    def compare(self, code, change):
        return self.json(code, "bench", "--quick", "--compare", self.old(change), *self.NAMES)["comparison"]

    def test_errors_and_outcomes_of_one_program_do_not_change(self):
        comparison = self.compare(FINE, lambda document: None)
        self.assertGreater(comparison["compared"], 10)
        self.assertEqual((comparison["worse"], comparison["better"]), (0, 0), comparison["changes"])

    def test_what_is_less_exact_or_fails_is_worse(self):
        def change(document):
            document["simulations"][0]["series"][0]["points"][0]["error"] /= 10
            document["simulations"][0]["series"][0]["points"][1]["error"] *= 10
            document["cases"][0]["pass"] = False

        comparison = self.compare(WORSE, change)
        self.assertEqual((comparison["worse"], comparison["better"]), (1, 2), comparison["changes"])
        judged = [change for change in comparison["changes"] if change["what"] != "time"]
        self.assertEqual([change["what"] for change in judged if not change["better"]], ["error"])

    def test_times_are_told_but_not_judged(self):
        def change(document):
            for series in document["simulations"][0]["series"]:
                for point in series["points"]:
                    for key in ("least", "median", "greatest"):
                        point["seconds"][key] /= 1e6

        comparison = self.compare(FINE, change)
        slower = [change["item"] for change in comparison["changes"]
                  if change["what"] == "time" and not change["better"]]
        self.assertGreaterEqual(sum(item.startswith("simulation/pendulum") for item in slower), 8)

    def test_items_that_only_one_has_are_left_out(self):
        def change(document):
            document["simulations"] = []

        comparison = self.compare(FINE, change)
        self.assertFalse(any("pendulum" in change["item"] for change in comparison["changes"]))

    def test_a_file_that_is_no_result_is_told(self):
        for text in ("", "[]", '{"schema": "koppel-bench/2"}', '{"schema": "koppel-bench/1"}'):
            old = self.write("old.json", text)
            result = self.expect(SYSTEM, "koppel", "bench", "case/parallelogram", "--compare", old)
            self.assertIn("old.json", result.stderr)
            self.assertIn("--out", result.stderr)


class Usage(ProgramTest):
    def test_the_list_names_every_closure_scene(self):
        listed = self.expect(FINE, "koppel", "bench", "--list").stdout.split()
        self.assertEqual(len(listed), len(set(listed)))
        for scene in SCENES.glob("*.toml"):
            self.assertIn("closure/" + scene.stem, listed)

    def test_a_name_that_is_none_gets_suggestions(self):
        for wrong, right in (("pendulm", "pendulum"), ("simulation/andrew", "simulation/andrews"), ("fourbar", "_row")):
            result = self.expect(USAGE, "koppel", "bench", wrong)
            self.assertIn(wrong, result.stderr)
            self.assertIn("did you mean", result.stderr)
            self.assertIn(right, result.stderr)
        self.assertIn("--list", self.expect(USAGE, "koppel", "bench", "nothing-of-the-kind").stderr)

    def test_a_folder_that_cannot_be_made_is_told(self):
        (self.folder / "file").write_text("")
        result = self.expect(SYSTEM, "koppel", "bench", "case/parallelogram", "--quick", "--out", "file/below")
        self.assertIn("file/below", result.stderr)

    def test_scenes_elsewhere_are_asked_for(self):
        self.assertIn("--scenes", self.expect(SYSTEM, "koppel", "bench", "--scenes", "nowhere").stderr)


if __name__ == "__main__":
    unittest.main()
