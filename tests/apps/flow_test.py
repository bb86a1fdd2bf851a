"""koppel explain --flow: the solution flow in words and as a block diagram."""

import os
import re
import shutil
import subprocess
import unittest
import xml.etree.ElementTree as tree

from program import FINE, FOURBAR, SCENE, SCENES, SYSTEM, ProgramTest

DOT = shutil.which("dot")


class Text(ProgramTest):
    def flow(self, scene):
        return self.expect(FINE, "koppel", "explain", scene, "--flow").stdout

    def test_names_loops_cuts_and_steps(self):
        text = self.flow(SCENES / "swash.toml")
        self.assertIn("1. slider, ring, plate, ball1, fork1, lever1\n", text)
        self.assertIn("cut at S-T (ball1, fork1): type 1 (distance of two points)", text)
        self.assertRegex(text, r"1\. lever1\.angle\n +from slider\.displacement, ring\.angle, plate\.angle\n"
                               r" +closed form, at most 2 solutions \(type 1\)")
        self.assertLess(text.index("lever2.angle\n"), text.index("On demand: coordinates of the cut joints"))
        self.assertLess(text.index("On demand: coordinates of the cut joints"), text.index("ball1.rotation\n"))
        self.assertTrue(text.endswith("Every step is in closed form\n"))

    def test_names_what_must_be_found_together(self):
        text = self.flow(SCENES / "stewart.toml")
        self.assertRegex(text, r"Unknowns that must be found together: [56] in step 1\n")
        self.assertTrue(text.endswith("Not every step is in closed form\n"))
        self.assertIn("by elimination, at most 8 solutions", self.flow(SCENES / "3rpr.toml"))

    def test_names_summing_points(self):
        self.assertIn("Summing point at ground: d and i turn about one axis there, and d.angle - i.angle",
                      self.flow(SCENES / "9body.toml"))

    def test_of_an_open_chain_is_nothing_to_solve(self):
        for name in ("arm2", "6r"):
            self.assertIn("There are no loops", self.flow(SCENES / f"{name}.toml"))

    def test_says_what_stands_in_its_way(self):
        self.assertIn("There is none: joint screw1 is a screw with a pitch", self.flow(SCENES / "7h.toml"))

    def test_of_a_faulty_scene_is_refused(self):
        self.expect(SCENE, "koppel", "explain", self.write("bad.toml", FOURBAR.replace("slope", "slop")), "--flow")


class Diagram(ProgramTest):
    def diagram(self, scene):
        self.expect(FINE, "koppel", "explain", scene, "--flow", "flow.dot")
        return (self.folder / "flow.dot").read_text()

    def test_is_the_same_every_time(self):
        for scene in sorted(SCENES.glob("*.toml")):
            self.assertEqual(self.diagram(scene), self.diagram(scene))

    def test_leads_from_inputs_over_boxes_to_what_is_recorded(self):
        text = self.diagram(SCENES / "chain.toml")
        self.assertEqual(len(re.findall(r"^  box\d+ \[", text, re.MULTILINE)), 4)
        self.assertEqual(len(re.findall(r"^  out\d+ \[", text, re.MULTILINE)), 4)
        self.assertEqual(len(re.findall(r"^  in\d+ -> box", text, re.MULTILINE)), 1)
        self.assertEqual(len(re.findall(r"^  box\d+ -> box\d+ \[label=", text, re.MULTILINE)), 3)
        self.assertIn('label="bell4.angle"', text)

    @unittest.skipUnless(DOT, "Graphviz is not installed")
    def test_is_drawn(self):
        for scene in sorted(SCENES.glob("*.toml")):
            with self.subTest(scene=scene.name):
                self.expect(FINE, "koppel", "explain", scene, "--flow", "flow.svg")
                self.assertEqual(tree.parse(self.folder / "flow.svg").getroot().tag, "{http://www.w3.org/2000/svg}svg")

    @unittest.skipUnless(DOT, "Graphviz is not installed")
    def test_takes_a_title_in_any_letters(self):
        title = 'Kurbel "ä" & <λ> &amp; \\n'
        scene = FOURBAR.replace('name = "fourbar"', f"name = \"fourbar\"\ntitle = '{title}'", 1)
        self.expect(FINE, "koppel", "explain", self.write("title.toml", scene), "--flow", "flow.svg")
        self.assertIn(title, "".join(tree.parse(self.folder / "flow.svg").getroot().itertext()))

    def test_tells_what_is_missing_to_draw_it(self):
        scene = self.write("scene.toml", FOURBAR)
        result = subprocess.run([shutil.which("koppel", path=os.environ["KOPPEL_BIN"]), "explain", scene, "--flow",
                                 "flow.svg"], capture_output=True, text=True, cwd=self.folder, env={"PATH": "/nowhere"})
        self.assertEqual(result.returncode, SYSTEM)
        self.assertIn("graphviz", result.stderr)
        self.assertIn(".dot", result.stderr)
        self.assertFalse((self.folder / "flow.svg").exists())

    def test_that_cannot_be_written_is_reported(self):
        scene = self.write("scene.toml", FOURBAR)
        self.assertIn("cannot write", self.expect(SYSTEM, "koppel", "explain", scene, "--flow", "absent/f.dot").stderr)


if __name__ == "__main__":
    unittest.main()
