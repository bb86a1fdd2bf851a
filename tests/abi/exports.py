#!/usr/bin/env python3
"""What the shared objects export: exports.py INCLUDE LIBRARY PLUGIN_FOLDER CALLER

The library exports the functions that koppel.h declares and nothing else, a plugin its entry and nothing else, and the
C program CALLER calls every function.
"""

import pathlib
import re
import subprocess
import sys
import unittest

from header import Header

INCLUDE, LIBRARY, PLUGIN_FOLDER, CALLER = (pathlib.Path(argument) for argument in sys.argv[1:5])


def exported(path):
    """Names of the symbols that others can link to; version nodes (type A) are no symbols."""
    listing = subprocess.run(["nm", "-D", "--defined-only", path], check=True, stdout=subprocess.PIPE, text=True).stdout
    symbols = (line.split()[1:] for line in listing.splitlines())
    return {name.partition("@")[0] for kind, name in symbols if kind != "A"}


class Exports(unittest.TestCase):
    def setUp(self):
        self.functions = set(Header(INCLUDE).functions)

    def test_the_header_was_understood(self):
        text = "".join((INCLUDE / "koppel" / name).read_text(encoding="utf-8") for name in ("koppel.h", "dynamics.h"))
        self.assertEqual(len(self.functions), len(re.findall(r"^KOPPEL_EXPORT ", text, flags=re.M)))

    def test_the_library_exports_what_the_header_declares(self):
        self.assertEqual(exported(LIBRARY), self.functions)

    def test_a_plugin_exports_its_entry(self):
        plugins = sorted(PLUGIN_FOLDER.glob("*.so"))
        self.assertTrue(plugins)
        for plugin in plugins:
            with self.subTest(plugin=plugin.name):
                self.assertEqual(exported(plugin), {"koppel_plugin"})

    def test_the_c_program_calls_every_function(self):
        called = set(re.findall(r"\b(koppel_\w+)\(", CALLER.read_text(encoding="utf-8")))
        self.assertEqual(self.functions - called, set())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
