"""Which function implements a formula, and which test checks it.

formulas.py          checks that every id of formulas.txt has both, and that FORMULAS.md says so
formulas.py --write  writes FORMULAS.md anew

A function implements the ids that stand in the documentation above it; a test checks those that stand in a line
"Checks ..." above it.
"""

import pathlib
import re
import sys

HERE = pathlib.Path(__file__).parent
HEADERS = HERE.parent.parent / "core" / "spatial"
ID = re.compile(r"\bK-I-\d+(?:\.\d+)*[a-z]?(?![\w.]*\d)")
NAMED = re.compile(r"\b(?:struct|concept|enum class|using|class)\s+(\w+)")
CALLED = re.compile(r"(operator\S+?|\w+)\s*\(")
TESTED = re.compile(r"^\s*(?:TYPED_)?TEST(?:_F|_P)?\(\s*(\w+),\s*(\w+)\s*\)|^class (\w+)\(")


def declared(lines):
    """The name that is declared in the first of these lines that declares one."""
    text = re.sub(r"template\s*<[^{;()]*?>\s*(?=\n)", "", "\n".join(lines))
    text = re.sub(r"\[\[\w+\]\]|\brequires\b[^\n]*", "", text)
    for line in text.splitlines():
        found = NAMED.search(line) or CALLED.search(line)
        if found:
            return found.group(1)
    return None


def implementations():
    """id -> names of functions and types, with their headers."""
    found = {}
    for header in sorted(HEADERS.glob("*.hpp")):
        lines = header.read_text().splitlines()
        scope = None
        comment = []
        for number, line in enumerate(lines):
            if (outer := re.match(r"(?:struct|class)\s+(\w+)", line)) and not line.endswith(";"):
                scope = outer.group(1)
            elif line.startswith("}"):
                scope = None
            if line.strip().startswith("///"):
                comment.append(line)
                continue
            if comment:
                name = declared(lines[number : number + 8])
                if comment[0].startswith(" ") and scope:
                    name = f"{scope}::{name}"
                for formula in ID.findall(" ".join(comment)):
                    if name is None:
                        sys.exit(f"{header.name}:{number + 1}: {formula} stands above nothing that has a name")
                    found.setdefault(formula, {})[name] = header.name
                comment = []
    return found


def checks():
    """id -> names of tests, with their files."""
    found = {}
    for source in sorted([*HERE.glob("*_test.cpp"), *HERE.glob("*_test.py")]):
        pending = set()
        is_python = source.suffix == ".py"
        test = None
        for line in source.read_text().splitlines():
            if match := TESTED.match(line):
                test = match.group(3) or f"{match.group(1)}.{match.group(2)}"
                for formula in pending:
                    found.setdefault(formula, {})[test] = source.name
                pending = set()
            if re.search(r"(//|\"\"\") ?Checks K-I-", line):
                if is_python:
                    for formula in ID.findall(line):
                        found.setdefault(formula, {})[test] = source.name
                else:
                    pending |= set(ID.findall(line))
    return found


def cell(names):
    """Names, each header or file once."""
    files = {}
    for name, file in names.items():
        files.setdefault(file, []).append(name)
    return "; ".join(f"{', '.join(f'`{name}`' for name in group)} in {file}" for file, group in files.items())


def main():
    formulas = dict(line.split(" ", 1) for line in (HERE / "formulas.txt").read_text().splitlines())
    functions, tests = implementations(), checks()
    faults = [f"{formula} has no function" for formula in formulas if formula not in functions]
    faults += [f"{formula} has no test" for formula in formulas if formula not in tests]
    faults += [f"{formula} is no formula of formulas.txt" for formula in {**functions, **tests} if formula not in formulas]
    table = [
        "# Formulas of rigid motion",
        "",
        "Which function implements a formula, and which tests check it. Made by formulas.py from the code.",
        "",
        "| id | formula | functions | tests |",
        "| --- | --- | --- | --- |",
        *(
            f"| {formula} | {title} | {cell(functions.get(formula, {}))} | {cell(tests.get(formula, {}))} |"
            for formula, title in formulas.items()
        ),
    ]
    text = "\n".join(table) + "\n"
    path = HERE / "FORMULAS.md"
    if "--write" in sys.argv:
        path.write_text(text)
    elif not path.exists() or path.read_text() != text:
        faults.append("FORMULAS.md is not what the code says; write it anew: python3 tests/spatial/formulas.py --write")
    if faults:
        sys.exit("\n".join(faults))
    print(f"{len(formulas)} formulas, each with a function and a test")


main()
