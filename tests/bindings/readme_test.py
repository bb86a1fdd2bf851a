"""The examples of the binding's README, as they stand there."""

import doctest
import os
import unittest

from scenes import ROOT


class Readme(unittest.TestCase):
    def test_examples(self):
        self.addCleanup(os.chdir, os.getcwd())
        os.chdir(ROOT)
        result = doctest.testfile(str(ROOT / "bindings" / "python" / "README.md"), module_relative=False)
        self.assertGreater(result.attempted, 10)
        self.assertEqual(result.failed, 0)


if __name__ == "__main__":
    unittest.main()
