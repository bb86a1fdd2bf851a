"""koppel reactions, and records of what joints and drives bear."""

import math
import unittest

from program import FINE, NOT_CLOSED, SCENE, SCENES, USAGE, ProgramTest, read_table

# A motor turns an arm of 3 kg, its centre 0.5 m out, at 4 rad/s in a vertical plane.
ARM = """schema = 1
[scene]
length = 1
gravity = [0, -10, 0]
duration = 0.5
steps = 10
[[body]]
name = "arm"
mass = 3
centre_of_mass = [0.5, 0, 0]
inertia = [0.1, 0.2, 0.3, 0, 0, 0]
[[joint]]
name = "pin"
type = "revolute"
between = ["ground", "arm"]
[[drive]]
of = "pin.angle"
type = "ramp"
slope = 4
[[record]]
of = "pin"
quantity = "force"
[[record]]
of = "pin"
quantity = "moment"
[[record]]
of = "pin.angle"
quantity = "effort"
"""


class Reactions(ProgramTest):
    def test_of_an_arm_are_its_weight_and_the_centripetal_force(self):
        scene = self.write("arm.toml", ARM)
        document = self.json(FINE, "reactions", scene, "--time", "0.2")
        angle = 0.8
        (pin,) = document["joints"]
        expected = [30 * math.sin(angle) - 3 * 0.5 * 16, 30 * math.cos(angle), 0]
        for value, exact in zip(pin["force"], expected):
            self.assertAlmostEqual(value, exact, delta=1e-12)
        self.assertAlmostEqual(document["efforts"]["pin.angle"], 15 * math.cos(angle), delta=1e-12)
        self.assertEqual(pin["determined"], {"force": [True] * 3, "moment": [True] * 3})

    def test_are_recorded_along_a_motion(self):
        scene = self.write("arm.toml", ARM)
        for command in ("run", "simulate"):
            with self.subTest(command=command):
                self.expect(FINE, "koppel", command, scene, "--csv", "table.csv")
                table = read_table(self.folder / "table.csv")
                for time, effort, moment, force in zip(table["time"], table["pin.angle.effort"],
                                                       table["pin.moment.z"], table["pin.force.y"]):
                    self.assertAlmostEqual(effort, 15 * math.cos(4 * time), delta=1e-12)
                    self.assertAlmostEqual(moment, effort, delta=1e-12)
                    self.assertAlmostEqual(force, 30 * math.cos(4 * time), delta=1e-12)

    def test_table_marks_what_the_motion_does_not_determine(self):
        out = self.expect(FINE, "koppel", "reactions", SCENES / "dynamics/fourbar_free.toml").stdout
        self.assertIn("~0", out)
        self.assertIn("not determined", out)
        self.assertNotIn("~", self.expect(FINE, "koppel", "reactions", self.write("arm.toml", ARM)).stdout)

    def test_of_what_cannot_be_had_is_an_error(self):
        self.json(SCENE, "reactions", self.write("broken.toml", ARM.replace("revolute", "revolt")))
        open_loop = (SCENES / "rstr.toml").read_text().replace("crank = 0.10", "crank = 9.0")
        document = self.json(NOT_CLOSED, "reactions", self.write("open.toml", open_loop))
        self.assertIs(document["found"], False)
        self.assertIn("code", document["error"])
        self.expect(USAGE, "koppel", "reactions", self.write("arm.toml", ARM), "--time", "-1")


if __name__ == "__main__":
    unittest.main()
