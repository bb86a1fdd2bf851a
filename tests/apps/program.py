"""Runs the programs of a build and reads what they write."""

import csv
import json
import os
import pathlib
import struct
import subprocess
import tempfile
import unittest

BIN = pathlib.Path(os.environ["KOPPEL_BIN"])
SCENES = pathlib.Path(os.environ["KOPPEL_SCENES"])

FINE, SCENE, USAGE, NOT_CLOSED, SYSTEM = range(5)

# Crank 0.1, coupler 0.335, rocker 0.255, ground 0.35: the crank turns fully (shortest plus longest is below the sum of
# the others). Modelled in space, so that three of its six closure equations follow from the others.
FOURBAR = """schema = 1
[scene]
name = "fourbar"
duration = 1.0
steps = 40
[[body]]
name = "crank"
[[body]]
name = "coupler"
[[body]]
name = "rocker"
[[joint]]
name = "crank"
type = "revolute"
between = ["ground", "crank"]
at = [0, 0, 0]
[[joint]]
name = "a"
type = "revolute"
between = ["crank", "coupler"]
at = [0, 0.1, 0]
[[joint]]
name = "b"
type = "revolute"
between = ["coupler", "rocker"]
at = [0.3, 0.25, 0]
[[joint]]
name = "rocker"
type = "revolute"
between = ["rocker", "ground"]
at = [0.35, 0, 0]
[[drive]]
of = "crank.angle"
type = "ramp"
slope = "360 deg"
[[record]]
of = "crank.angle"
[[record]]
of = "rocker.angle"
"""

# The rocker is asked to turn fully, which it cannot: it stops at a dead centre.
LOCKED = FOURBAR.replace('of = "crank.angle"\ntype', 'of = "rocker.angle"\ntype')

# Both cranks are driven, each at a rate of its own: the start fits, the rates do not.
OVERDRIVEN = FOURBAR + """[[drive]]
of = "rocker.angle"
type = "ramp"
slope = 1.0
"""

# The ground's end of the last joint is too far away.
FAR = FOURBAR.replace(
    'between = ["rocker", "ground"]\nat = [0.35, 0, 0]',
    'inlet = "rocker"\noutlet = { on = "ground", at = [9, 0, 0] }',
)

UNDRIVEN = FOURBAR.replace('[[drive]]\nof = "crank.angle"\ntype = "ramp"\nslope = "360 deg"\n', "")


class ProgramTest(unittest.TestCase):
    """A test with a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.folder = pathlib.Path(folder.name)

    def write(self, name, text):
        path = self.folder / name
        path.write_text(text)
        return path

    def start(self, program, *arguments):
        return subprocess.run(
            [BIN / program, *map(str, arguments)], capture_output=True, text=True, timeout=240, cwd=self.folder
        )

    def expect(self, code, program, *arguments):
        """Runs a program that is expected to end with an exit code."""
        result = self.start(program, *arguments)
        self.assertEqual(result.returncode, code, result.stdout + result.stderr)
        return result

    def json(self, code, *arguments):
        return json.loads(self.expect(code, "koppel", *arguments, "--json").stdout)


def read_table(path):
    """The columns of a CSV file by their names."""
    with open(path, newline="") as file:
        rows = list(csv.reader(file))
    return {name: [float(row[i]) for row in rows[1:]] for i, name in enumerate(rows[0])}


def log_channels(path):
    """How many events each channel of an LCM log has. Layout: sync word, number, time, lengths, channel, data."""
    counts = {}
    data = pathlib.Path(path).read_bytes()
    at = 0
    while at < len(data):
        sync, _, _, channel_length, length = struct.unpack_from(">Iqqii", data, at)
        if sync != 0xEDA1DA01:
            raise ValueError(f"no event at byte {at}")
        at += 28
        channel = data[at : at + channel_length].decode()
        counts[channel] = counts.get(channel, 0) + 1
        at += channel_length + length
    return counts
