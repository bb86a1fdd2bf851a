"""What the binding raises, and what it tells."""

import pathlib
import pickle
import tempfile
import unittest

from scenes import SUSPENSION

import koppel

BAD = """schema = 1

[[body]]
name = "arm"

[[joint]]
name = "pivot"
type = "revolut"
between = ["ground", "arm"]
"""

UNUSED = """schema = 1
[parameters]
spare = 1
[[body]]
name = "arm"
[[joint]]
name = "pivot"
type = "revolute"
between = ["ground", "arm"]
"""


class Scenes(unittest.TestCase):
    def test_a_bad_one_says_where_and_what_to_do(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "bad.toml")
            file.write_text(BAD, encoding="utf-8")
            with self.assertRaises(koppel.Error) as caught:
                koppel.load(file)
        error = caught.exception
        self.assertEqual((error.code, error.severity, error.file), ("E0306", "error", str(file)))
        self.assertEqual((error.line, error.column, error.length), (8, 8, 9))
        self.assertEqual((error.source_line, error.element), ('type = "revolut"', "joint pivot"))
        self.assertIn("`revolute`", error.advice)
        self.assertLess(error.status, 0)
        self.assertEqual(error.findings, [error.finding])
        self.assertIn("bad.toml:8:8: error[E0306]", str(error))
        self.assertIn("plugin", error.explain())
        self.assertEqual(pickle.loads(pickle.dumps(error)).finding, error.finding)

    def test_all_findings_are_told(self):
        with koppel.Engine() as engine, self.assertRaises(koppel.Error) as caught:
            engine.read_text(BAD + "[[boddy]]\n")
        self.assertEqual(sorted(finding.code for finding in caught.exception.findings), ["E0202", "E0306"])

    def test_a_missing_file_is_told(self):
        with self.assertRaises(koppel.Error) as caught:
            koppel.load("/nowhere/at/all.toml")
        self.assertEqual(caught.exception.code, "E0101")

    def test_warnings_are_kept(self):
        with koppel.Engine() as engine, engine.read_text(UNUSED) as scene:
            mechanism = scene.compile()
        codes = [(warning.severity, warning.code) for warning in mechanism.warnings]
        self.assertIn(("warning", "W0408"), codes)


class Names(unittest.TestCase):
    def setUp(self):
        self.mechanism = koppel.load(SUSPENSION)
        self.state = self.mechanism.state()

    def test_that_are_unknown_are_corrected(self):
        for attempt in (lambda: self.state.set_input("wheel.zz", 0.0),
                        lambda: self.mechanism.unit("input", "wheel.zz")):
            with self.assertRaises(koppel.Error) as caught:
                attempt()
            self.assertEqual(caught.exception.code, "E0901")
            self.assertIn("`wheel.z`", caught.exception.advice)

    def test_of_bodies_and_frames_are_not_mixed(self):
        with self.assertRaises(koppel.Error):
            self.state.jacobian("wheel_centre")
        with self.assertRaises(KeyError):
            self.state.poses("joint")

    def test_of_methods_are_checked(self):
        with self.assertRaises(ValueError):
            self.state.close(method="guess")


class Values(unittest.TestCase):
    def setUp(self):
        self.state = koppel.load(SUSPENSION).state()

    def test_out_of_reach_leave_the_state(self):
        self.state.move(0.5)
        before = self.state.q
        self.state.set_input("wheel.z", 5.0)
        with self.assertRaises(koppel.Error) as caught:
            self.state.close()
        self.assertEqual(caught.exception.code, "E0705")
        self.assertEqual(self.state.q.tolist(), before.tolist())

    def test_that_are_wrong_are_refused(self):
        for attempt in (lambda: self.state.set_input("wheel.z", float("nan")), lambda: self.state.move(float("inf")),
                        lambda: setattr(self.state, "q", [0.0]), self.state.velocities):
            with self.assertRaises(koppel.Error) as caught:
                attempt()
            self.assertEqual(caught.exception.status, -2)
            self.assertTrue(str(caught.exception))

    def test_of_streams_are_checked(self):
        with self.assertRaises(koppel.Error) as caught:
            koppel.Stream(self.state.mechanism, url="carrier-pigeon://")
        self.assertEqual(caught.exception.code, "E0801")


if __name__ == "__main__":
    unittest.main()
