"""The example host in C11."""

import math
import unittest

from program import FINE, ProgramTest


class Embed(ProgramTest):
    def test_the_rocker_follows_the_crank(self):
        lines = self.expect(FINE, "embed").stdout.splitlines()
        self.assertEqual(len(lines), 13)
        for step, line in enumerate(lines):
            _, _, _, rocker, _, _, residual = line.split()
            self.assertLess(float(residual), 1e-13)
            # Six decimals are printed.
            self.assertAlmostEqual(float(rocker), rocker_angle(2 * math.pi * step / 12), delta=0.51e-6)


def rocker_angle(crank):
    """By the cosine rule, from the design position with the crank pointing along y."""
    distance = math.dist((0.35, 0.0), (-0.1 * math.sin(crank), 0.1 * math.cos(crank)))
    coupler, rocker = math.hypot(0.3, 0.15), math.hypot(0.05, 0.25)

    def direction(pin):
        # The pin b lies to the right of the line from the pivot of the rocker to the pin a, on the side of +y.
        towards = math.atan2(pin[1], pin[0] - 0.35) % (2 * math.pi)
        length = math.dist((0.35, 0.0), pin)
        return towards - math.acos((rocker**2 + length**2 - coupler**2) / (2 * rocker * length))

    pin = (-0.1 * math.sin(crank), 0.1 * math.cos(crank))
    assert distance < coupler + rocker
    # The joint turns the ground relative to the rocker: its angle is minus that of the rocker.
    return -(direction(pin) - direction((0.0, 0.1)))


if __name__ == "__main__":
    unittest.main()
