#!/usr/bin/env python3
"""decode_log.py SOURCE PACKAGES: decodes a log of the program SOURCE without any code of the publisher.

The log format is read here, the messages by the classes that lcm-gen made for Python in the folder PACKAGES. Every
number must be, bit for bit, the one that SOURCE says it has streamed.
"""

import math
import os
import struct
import subprocess
import sys
import tempfile

SYNC = 0xEDA1DA01
PREFIX = "KOPPEL_FOUR_BAR_"
HASH = struct.unpack(">q", struct.pack(">Q", 0xFEDCBA9876543210))[0]


def read_events(path):
    """Yields number, time [us], channel and bytes of each event of an LCM log; anything else in it is an error."""
    with open(path, "rb") as log:
        while header := log.read(28):
            sync, number, utime, channel_size, size = struct.unpack(">IqqII", header)
            assert sync == SYNC, f"sync word {sync:x} at {log.tell() - 28}"
            channel, data = log.read(channel_size), log.read(size)
            assert len(data) == size, "the log ends inside an event"
            yield number, utime, channel.decode("ascii"), data


def bits(numbers):
    return [struct.pack(">d", x) for x in numbers]


def floats(words):
    return [float.fromhex(word) for word in words]


def rotation(w, x, y, z):
    """The matrix of a unit quaternion, row by row."""
    return [
        1 - 2 * (y * y + z * z), 2 * (x * y - w * z), 2 * (x * z + w * y),
        2 * (x * y + w * z), 1 - 2 * (x * x + z * z), 2 * (y * z - w * x),
        2 * (x * z - w * y), 2 * (y * z + w * x), 1 - 2 * (x * x + y * y),
    ]  # fmt: skip


def check_model(model):
    assert model.scene == "four-bar" and model.title == "A four-bar linkage" and model.version == "0.1.0"
    assert model.length == 0.3
    assert model.coordinate_names == ["crank.angle", "slide.shift", "ball.w"]
    assert model.coordinate_units == ["rad", "m", "1"]
    assert model.rate_names == ["crank.angle", "slide.shift"]
    assert model.rate_units == ["rad/s", "m/s"]
    assert model.joint_names == ["crank", "slide", "ball"]
    assert model.body_names == ["ground", "rod"]


def check_state(state, words):
    assert state.sequence == int(words[0])
    assert bits([state.time, *state.q, *state.v, *state.a]) == bits(floats(words[1:]))


def check_positions(poses, words):
    assert poses.sequence == int(words[0])
    assert bits([x for pose in poses.poses for x in pose.position]) == bits(floats(words[1:]))


def check_rotations(poses, words):
    # A quaternion is computed from the matrix: some roundings of numbers not above one, and back again.
    for got, expected in zip([x for pose in poses.poses for x in rotation(*pose.quaternion)], floats(words[1:])):
        assert abs(got - expected) < 16 * sys.float_info.epsilon
    assert all(abs(math.hypot(*pose.quaternion) - 1) < 4 * sys.float_info.epsilon for pose in poses.poses)


def check_closure(closure, words):
    assert closure.sequence == int(words[0])
    counts = [closure.verdict, closure.solver, closure.status, closure.iterations]
    counts += [closure.rank, closure.equations, closure.unknowns]
    assert counts == [int(word) for word in words[1:8]]
    assert bits([closure.residual, closure.condition, closure.coordinate_error]) == bits(floats(words[8:]))


def check_event(event, words):
    assert event.sequence == int(words[0])
    assert bits([event.time]) == bits(floats(words[1:2]))
    assert event.severity == int(words[2])
    assert event.text == " ".join(words[3:])


def main(source, packages):
    sys.path.insert(0, packages)
    import koppel

    types = {"MODEL": koppel.model_t, "STATE": koppel.state_t, "POSES": koppel.poses_t}
    types |= {"CLOSURE": koppel.closure_t, "EVENT": koppel.event_t}
    checks = {"state": ("STATE", check_state), "positions": ("POSES", check_positions)}
    checks |= {"rotations": ("POSES", check_rotations), "closure": ("CLOSURE", check_closure)}
    checks |= {"event": ("EVENT", check_event)}

    with tempfile.TemporaryDirectory() as folder:
        path = os.path.join(folder, "run.lcm")
        printed = subprocess.run([source, f"file://{path}?mode=w", "2000", "0"], stdout=subprocess.PIPE, check=True)
        messages = {kind: [] for kind in types}
        last = 0
        for expected_number, (number, utime, channel, data) in enumerate(read_events(path)):
            assert number == expected_number and utime >= last and channel.startswith(PREFIX)
            last = utime
            kind = channel[len(PREFIX) :]
            messages[kind].append(types[kind].decode(data))
            assert messages[kind][-1].hash == HASH
            assert 0 <= utime - messages[kind][-1].utime < 60e6

    assert len(messages["MODEL"]) >= 1
    for model in messages["MODEL"]:
        check_model(model)
    lines = printed.stdout.decode().splitlines()
    for name, (kind, check) in checks.items():
        expected = [line.split()[1:] for line in lines if line.split()[0] == name]
        assert len(messages[kind]) == len(expected) > 0, f"{len(messages[kind])} of {kind}, expected {len(expected)}"
        for message, words in zip(messages[kind], expected):
            check(message, words)
    print({kind: len(found) for kind, found in messages.items()}, "all bits as published")


if __name__ == "__main__":
    if not __debug__:
        sys.exit("the checks are assertions: run it without -O")
    main(*sys.argv[1:])
