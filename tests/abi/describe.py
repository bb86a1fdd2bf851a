#!/usr/bin/env python3
"""The ABI as a text: describe.py INCLUDE DESCRIPTION COMPILER [--write]

Compares what the headers under INCLUDE mean to the C compiler with the description that is kept beside this script:
signatures of functions, sizes of structs with offset and size of each field, values of constants. With --write the
description is made anew; what changed is then seen in review. Exit code 1: they differ.
"""

import difflib
import pathlib
import subprocess
import sys
import tempfile

from header import Header

HEAD = """# The ABI of libkoppel on x86-64 and other machines with 8-byte pointers. Made by tests/abi/describe.py --write; a
# test fails where the headers say otherwise. Fields and functions are only ever added at the end.
"""


def measuring_program(header):
    """A C program that prints what only a compiler knows."""
    lines = ["#include <koppel/koppel.h>", "#include <stdio.h>", "int main(void) {"]
    for struct, fields in header.structs.items():
        lines.append(f'printf("struct {struct} %zu\\n", sizeof({struct}));')
        for field, declaration in fields.items():
            lines.append(f'printf("  %4zu %4zu {declaration}\\n", offsetof({struct}, {field}), '
                         f'sizeof((({struct}*)0)->{field}));')
    lines += [f'printf("constant {name} %d\\n", (int){name});' for name in header.enumerators]
    return "\n".join(lines + ["return 0;", "}"])


def measure(header, include, compiler):
    with tempfile.TemporaryDirectory() as folder:
        source, program = pathlib.Path(folder, "measure.c"), pathlib.Path(folder, "measure")
        source.write_text(measuring_program(header), encoding="utf-8")
        subprocess.run([compiler, "-std=c11", "-I", include, source, "-o", program], check=True)
        return subprocess.run([program], check=True, stdout=subprocess.PIPE, text=True).stdout


def describe(include, compiler):
    header = Header(include)
    lines = [f"define {name} {value}" for name, value in header.macros.items()]
    lines += [f"alias {name} = {of}" for of, name in header.aliases]
    lines += [f"handle {name}" for name in header.opaque]
    lines += measure(header, include, compiler).splitlines()
    lines += [f"function {signature}" for signature in header.functions.values()]
    return HEAD + "\n".join(lines) + "\n"


def main():
    include, description, compiler = sys.argv[1:4]
    found = describe(include, compiler)
    path = pathlib.Path(description)
    if "--write" in sys.argv[4:]:
        path.write_text(found, encoding="utf-8")
        return 0
    kept = path.read_text(encoding="utf-8")
    lines = difflib.unified_diff(kept.splitlines(), found.splitlines(), path.name, "headers", lineterm="")
    difference = "\n".join(lines)
    if difference:
        print(difference)
        print(f"The ABI changed. If that is meant: {sys.argv[0]} {include} {description} {compiler} --write")
    return 1 if difference else 0


if __name__ == "__main__":
    sys.exit(main())
