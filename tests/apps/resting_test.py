"""koppel equilibrium and koppel linearise: what they find, with what accuracy, and what they say where there is nothing."""

import json
import math
import unittest

from program import FINE, NOT_CLOSED, SCENE, SCENES, USAGE, ProgramTest

DYNAMICS = SCENES / "dynamics"

SLEDGE = """schema = 1
[scene]
length = 1
[[body]]
name = "sledge"
mass = 2
[[joint]]
name = "track"
type = "prismatic"
inlet = { on = "ground", axis = [1, 0, 0] }
outlet = "sledge"
[[force]]
name = "wind"
type = "motor"
of = "track.displacement"
effort = 3
"""

HELD = SLEDGE + """[[force]]
name = "rope"
type = "coordinate_spring"
of = "track.displacement"
stiffness = 50
damping = 4
"""

ARM = """schema = 1
[scene]
length = 1
[[body]]
name = "shaft"
[[body]]
name = "arm"
type = "point_mass"
mass = 2
[[joint]]
name = "shaft"
type = "revolute"
inlet = "ground"
outlet = "shaft"
[[joint]]
name = "hinge"
type = "revolute"
inlet = { on = "shaft", axis = [0, 1, 0], x_axis = [0, 0, -1] }
outlet = { on = "arm", at = [-0.5, 0, 0], axis = [0, 0, 1], x_axis = [1, 0, 0] }
start = { angle = 0.7 }
[[drive]]
of = "shaft.angle"
type = "ramp"
slope = 6
"""



class Equilibrium(ProgramTest):
    def test_of_a_spring_and_a_constant_force(self):
        document = self.json(FINE, "equilibrium", self.write("held.toml", HELD))
        self.assertIs(document["found"], True)
        self.assertIs(document["stable"], True)
        self.assertAlmostEqual(document["coordinates"]["track.displacement"], 0.06, delta=1e-16)
        self.assertAlmostEqual(document["stiffness"]["matrix"][0][0], 50, delta=document["stiffness"]["errors"][0][0])
        for key in ("scene", "time", "freedoms", "iterations", "residual", "force", "coordinate_error", "energy", "moved",
                    "diagnostics"):
            self.assertIn(key, document)
        self.assertEqual(document["moved"]["most"], "track.displacement")

    def test_that_is_not_there_has_a_reason(self):
        scene = self.write("sledge.toml", SLEDGE)
        document = self.json(NOT_CLOSED, "equilibrium", scene)
        self.assertIs(document["found"], False)
        self.assertEqual(document["error"]["code"], "E1101")
        self.assertIn("track.displacement", document["error"]["message"])
        self.assertEqual(document["force"], {"along": "track.displacement", "value": 3.0})
        text = self.expect(NOT_CLOSED, "koppel", "equilibrium", scene)
        self.assertIn("away without end", text.stderr)
        self.assertIn("no rest found", text.stdout)
        self.assertEqual(self.json(NOT_CLOSED, "linearise", scene)["error"]["code"], "E1101")

    def test_of_the_scenes_of_the_folder_balances(self):
        for scene in sorted(DYNAMICS.glob("*.toml")):
            with self.subTest(scene=scene.stem):
                result = self.start("koppel", "equilibrium", scene, "--json")
                self.assertIn(result.returncode, (FINE, NOT_CLOSED), result.stderr)
                if result.returncode == FINE:
                    document = json.loads(result.stdout)
                    self.assertLess(document["residual"], 1e-10)
                    self.assertLess(document["coordinate_error"], 1e-8)

    def test_in_steady_motion(self):
        scene = self.write("arm.toml", ARM)
        document = self.json(FINE, "equilibrium", scene, "--steady")
        self.assertIs(document["steady"], True)
        self.assertAlmostEqual(math.cos(document["coordinates"]["hinge.angle"]), 9.81 / 18, delta=1e-14)
        self.assertAlmostEqual(self.json(FINE, "equilibrium", scene)["coordinates"]["hinge.angle"], 0, delta=1e-14)

    def test_nearest_may_be_unstable(self):
        upright = self.write("upright.toml", (DYNAMICS / "pendulum.toml").read_text().replace('"-90 deg"', '"170 deg"'))
        document = self.json(FINE, "equilibrium", upright, "--nearest")
        self.assertIs(document["stable"], False)
        self.assertAlmostEqual(document["coordinates"]["pivot.angle"], math.pi, delta=1e-14)
        self.assertIs(self.json(FINE, "equilibrium", upright)["stable"], True)

    def test_text_tells_stability_and_accuracy(self):
        text = self.expect(FINE, "koppel", "equilibrium", DYNAMICS / "pendulum.toml").stdout
        for word in ("rests", "stable", "force", "error", "energy", "pivot.angle"):
            self.assertIn(word, text)

    def test_wrong_usage(self):
        self.expect(USAGE, "koppel", "equilibrium")
        self.expect(SCENE, "koppel", "equilibrium", self.write("bad.toml", "schema = 1\n[[body]]\n"))


class Linearise(ProgramTest):
    def test_a_pendulum(self):
        document = self.json(FINE, "linearise", DYNAMICS / "pendulum.toml", "--inputs", "pivot.angle")
        self.assertEqual(document["course"], "resting")
        mode = document["modes"][0]
        self.assertAlmostEqual(mode["frequency"], math.sqrt(9.81) / (2 * math.pi), delta=mode["error"])
        self.assertLess(mode["error"], 1e-10)
        self.assertEqual(mode["shape"], {"pivot.angle": [1.0, 0.0]})
        self.assertEqual([number["name"] for number in document["states"]], ["pivot.angle", "pivot.angle rate"])
        self.assertEqual(document["inputs"], [{"name": "pivot.angle effort", "unit": "N m"}])
        self.assertAlmostEqual(document["B"]["values"][1][0], 1, delta=1e-12)

    def test_a_damped_spring(self):
        document = self.json(FINE, "linearise", self.write("held.toml", HELD))
        mode = document["modes"][0]
        self.assertAlmostEqual(mode["damping_ratio"], 4 / (2 * math.sqrt(50 * 2)), delta=1e-12)
        self.assertAlmostEqual(document["damping"]["values"][0][0], 4, delta=document["damping"]["errors"][0][0])
        text = self.expect(FINE, "koppel", "linearise", self.folder / "held.toml").stdout
        self.assertIn("0.200000", text)

    def test_warns_where_it_is_not_at_rest(self):
        document = self.json(FINE, "linearise", DYNAMICS / "pendulum.toml", "--at", "start")
        self.assertEqual(document["course"], "unsteady")
        self.assertAlmostEqual(document["drift"], 9.81, delta=1e-12)
        text = self.expect(FINE, "koppel", "linearise", DYNAMICS / "pendulum.toml", "--at", "start").stdout
        self.assertIn("warning", text)

    def test_takes_the_rates_of_the_start(self):
        document = self.json(FINE, "linearise", DYNAMICS / "gyroscope.toml", "--at", "start")
        self.assertEqual(document["course"], "steady")

    def test_picks_inputs_and_outputs(self):
        document = self.json(FINE, "linearise", self.write("arm.toml", ARM), "--steady", "--inputs",
                             "shaft.angle,hinge.angle", "--outputs", "hinge.angle")
        self.assertEqual([number["name"] for number in document["inputs"]],
                         ["shaft.angle", "shaft.angle rate", "shaft.angle acceleration", "hinge.angle effort"])
        self.assertEqual(document["C"]["values"], [[1.0, 0.0]])
        self.assertEqual(document["course"], "resting")
        speed, cosine = 6.0, 9.81 / 18
        known = speed * math.sqrt(1 - cosine**2)
        self.assertAlmostEqual(document["modes"][0]["imaginary"], known, delta=document["modes"][0]["error"])

    def test_wrong_names_are_usage(self):
        scene = DYNAMICS / "pendulum.toml"
        for arguments in (["--inputs", "pivot.angel"], ["--outputs", "nothing"], ["--at", "noon"]):
            with self.subTest(arguments=arguments):
                self.expect(USAGE, "koppel", "linearise", scene, *arguments)


if __name__ == "__main__":
    unittest.main()
