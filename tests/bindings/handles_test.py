"""Lifetimes of handles, and how the library is found."""

import gc
import os
import subprocess
import sys
import unittest

from scenes import ROOT, SUSPENSION

import koppel


class Handles(unittest.TestCase):
    def test_outlive_what_they_were_made_from(self):
        engine = koppel.Engine()
        scene = engine.read(SUSPENSION)
        engine.free()
        mechanism = scene.compile()
        scene.free()
        state = mechanism.state()
        mechanism.free()
        gc.collect()
        self.assertEqual(state.move(0.5).verdict, "closed")

    def test_that_were_freed_refuse_to_work(self):
        mechanism = koppel.load(SUSPENSION)
        with mechanism.state() as state:
            state.move(0.0)
        for attempt in (lambda: state.move(0.1), lambda: state.q, state.poses, state.copy):
            with self.assertRaises(ValueError):
                attempt()
        state.free()  # again is fine
        mechanism.free()
        with self.assertRaises(ValueError):
            mechanism.state()

    def test_of_streams_close_once(self):
        mechanism = koppel.load(SUSPENSION)
        stream = koppel.Stream(mechanism, url="memq://")
        stream.close()
        stream.free()
        with self.assertRaises(ValueError):
            stream.close()
        koppel.Stream(mechanism, url="memq://")  # closed with the object
        gc.collect()


class Library(unittest.TestCase):
    def imported(self, **environment):
        """What using the package prints in a fresh interpreter."""
        program = "import koppel\ntry:\n  koppel.Engine()\n  print('fine')\nexcept ImportError as e: print(e)"
        kept = {name: value for name, value in os.environ.items() if name != "KOPPEL_LIBRARY"}
        return subprocess.run([sys.executable, "-B", "-c", program], env=kept | environment, cwd=ROOT, check=True,
                              stdout=subprocess.PIPE, text=True).stdout

    def test_is_where_the_environment_says(self):
        self.assertEqual(self.imported(KOPPEL_LIBRARY=os.environ["KOPPEL_LIBRARY"]), "fine\n")

    def test_that_is_missing_is_told(self):
        text = self.imported(KOPPEL_LIBRARY="/nowhere/libkoppel.so")
        self.assertIn("/nowhere/libkoppel.so", text)
        self.assertIn("KOPPEL_LIBRARY", text)

    def test_that_is_another_is_told(self):
        self.assertIn("libm.so.6", self.imported(KOPPEL_LIBRARY="libm.so.6"))


if __name__ == "__main__":
    unittest.main()
