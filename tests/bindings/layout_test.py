"""The binding's structs, functions and constants against the description of the ABI."""

import ctypes
import re
import unittest

from scenes import ROOT

from koppel import library, structs

ABI = (ROOT / "tests" / "abi" / "koppel.abi.txt").read_text(encoding="utf-8")


def c_name(name):
    """EngineOptions -> koppel_engine_options"""
    return "koppel" + re.sub(r"[A-Z]", lambda capital: "_" + capital.group(0).lower(), name)


def described():
    """{struct: (size, [(offset, size, field)])}"""
    result = {}
    for line in ABI.splitlines():
        if struct := re.match(r"struct (\w+) (\d+)$", line):
            fields = []
            result[struct.group(1)] = int(struct.group(2)), fields
        elif field := re.match(r" +(\d+) +(\d+) .*?(?:\(\*)?(\w+)(?:\[\d+\])?(?:\)\(.*)?$", line):
            fields.append((int(field.group(1)), int(field.group(2)), field.group(3)))
    return result


class Layout(unittest.TestCase):
    def test_structs_lie_as_the_library_has_them(self):
        known = described()
        mirrored = [value for value in vars(structs).values()
                    if isinstance(value, type) and issubclass(value, ctypes.Structure)
                    and value not in (ctypes.Structure, structs.Sized)]
        self.assertGreater(len(mirrored), 8)
        for struct in mirrored:
            fields = [(getattr(struct, name).offset, getattr(struct, name).size, name) for name, _ in struct._fields_]
            with self.subTest(struct=struct.__name__):
                self.assertEqual((ctypes.sizeof(struct), fields), known[c_name(struct.__name__)])

    def test_functions_take_as_many_arguments(self):
        signatures = dict(re.findall(r"^function .*?(koppel_\w+)\((.*)\)$", ABI, flags=re.M))
        for name, arguments in library._ARGUMENTS.items():
            expected = [] if signatures[name] == "void" else signatures[name].split(", ")
            with self.subTest(function=name):
                self.assertEqual(len(arguments), len(expected))
                for given, wanted in zip(arguments, expected):
                    self.assertEqual(ctypes.sizeof(given), 4 if re.match(r"u?int32_t \w", wanted) else 8, wanted)

    def test_constants_have_their_values(self):
        values = {name: int(value) for name, value in re.findall(r"^constant KOPPEL_(\w+) (-?\d+)$", ABI, flags=re.M)}
        for prefix, names in (("SEVERITY", structs.SEVERITIES), ("VERDICT", structs.VERDICTS),
                              ("SOLVER", structs.SOLVERS), ("METHOD", structs.METHODS), ("FLOW", structs.FLOWS)):
            self.assertEqual(sum(name.startswith(prefix + "_") for name in values), len(names), prefix)
            for number, name in enumerate(names):
                self.assertEqual(values[f"{prefix}_{name.upper().replace(' ', '_')}"], number)
        kinds = {name[5:].lower(): value for name, value in values.items() if name.startswith("KIND_")}
        self.assertEqual(structs.KINDS, kinds)
        for name in ("OK", "REDUNDANT", "BRANCH_CHANGED", "NEAR_SINGULAR", "LIMIT_EXCEEDED", "Q", "V", "A"):
            self.assertEqual(getattr(structs, name), values[name])
        versions = re.findall(r"^define KOPPEL_ABI_(?:MAJOR|MINOR) (\d+)u$", ABI, flags=re.M)
        self.assertEqual(structs.ABI, tuple(int(version) for version in versions))


if __name__ == "__main__":
    unittest.main()
