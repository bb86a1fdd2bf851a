"""Rotation functions against fifty digits. The reference uses no formula of theirs: rotations are products of matrix
exponentials, H is their difference quotient, K the inverse of H with the constraint's gradient."""

import functools
import os
import subprocess
import unittest

import mpmath
from mpmath import mp, mpf

mp.dps = 70  # the difference quotients take twenty of them
UNIT = mpf(2) ** -53
STEP = mpf(10) ** -20


def skew(a):
    return mpmath.matrix([[0, -a[2], a[1]], [a[2], 0, -a[0]], [-a[1], a[0], 0]])


def exponential(m):
    """exp(m) by its series on a matrix halved until it is small, then squared as often."""
    halvings = 0
    while mpmath.mnorm(m, "f") > mpf(1) / 4:
        m, halvings = m / 2, halvings + 1
    total = term = mpmath.eye(m.rows)
    for n in range(1, 45):
        term = term * m / n
        total = total + term
    for _ in range(halvings):
        total = total * total
    return total


def turn(axis, angle):
    return exponential(skew([angle * component for component in axis]))


def rodrigues(a):
    s = skew(a)
    return mpmath.eye(3) + 2 / (1 + sum(c * c for c in a)) * (s + s * s)


def of_quaternion(q):
    w, v = q[0], skew(q[1:])
    return mpmath.eye(3) + 2 / sum(c * c for c in q) * (w * v + v * v)


def elementary(axis, angle):
    r = mpmath.eye(3)
    u, v = (axis + 1) % 3, (axis + 2) % 3
    r[u, u] = r[v, v] = mpmath.cos(angle)
    r[v, u] = mpmath.sin(angle)
    r[u, v] = -r[v, u]
    return r


def sequence(axes):
    def rotation(angles):
        first, second, third = (elementary("xyz".index(axis), angle) for axis, angle in zip(axes, angles))
        return first * second * third

    return rotation


ROTATIONS = {
    "axis_angle": lambda x: turn(x[:3], x[3]),
    "rotation_vector": lambda x: exponential(skew(x)),
    "quaternion": of_quaternion,
    "rodrigues": rodrigues,
    **{axes: sequence(axes) for axes in ("zxz", "xyz", "yxz", "yzy")},
}
# The gradient of the constraint, where there is one: the direction in which the coordinates do not move.
NORMALS = {"axis_angle": lambda x: [*x[:3], 0], "quaternion": lambda x: x}


def size(m):
    return mpmath.mnorm(m, "f")


@functools.lru_cache(maxsize=4)
def rotation_and_rates(kind, x):
    rotation = ROTATIONS[kind]
    rates = []
    for n in range(len(x)):
        ahead, behind = list(x), list(x)
        ahead[n], behind[n] = x[n] + STEP, x[n] - STEP
        rates.append((rotation(ahead) - rotation(behind)) / (2 * STEP))
    return rotation(x), rates


def h_matrix(kind, x, axes):
    r, rates = rotation_and_rates(kind, tuple(x))
    h = mpmath.zeros(3, len(x))
    for n, rate in enumerate(rates):
        s = rate * r.T if axes == "base" else r.T * rate
        for i, (row, column) in enumerate(((2, 1), (0, 2), (1, 0))):
            h[i, n] = (s[row, column] - s[column, row]) / 2
    return h


def possible(kind, x, h):
    """What H does on rates that keep the constraint: on others it may do what it likes."""
    if kind not in NORMALS:
        return h
    normal = mpmath.matrix(NORMALS[kind](x))
    return h - h * normal * normal.T / size(normal) ** 2


def k_matrix(kind, x, axes):
    h = h_matrix(kind, x, axes)
    if kind not in NORMALS:
        return h**-1
    square = mpmath.zeros(4, 4)
    square[:3, :] = h
    for n, entry in enumerate(NORMALS[kind](x)):
        square[3, n] = entry
    return (square**-1)[:, :3]


def integral_of_exponential(s):
    """The integral of exp(t s) over t from 0 to 1: a corner of the exponential of a larger matrix."""
    n = s.rows
    large = mpmath.zeros(2 * n, 2 * n)
    large[:n, :n] = s
    large[:n, n:] = mpmath.eye(n)
    return exponential(large)[:n, n:]


def bracket(x):
    m = mpmath.zeros(6, 6)
    m[:3, :3] = m[3:, 3:] = skew(x[:3])
    m[3:, :3] = skew(x[3:])
    return m


def logarithm(q):
    w, v = q[0], mpmath.matrix(q[1:])
    length = size(v)
    if length == 0:
        return v
    if w < 0:
        w, v = -w, -v
    return 2 * mpmath.atan2(length, w) / length * v


def exp_quaternion(phi):
    angle = size(mpmath.matrix(phi))
    factor = mpmath.sin(angle / 2) / angle if angle else mpf(1) / 2
    return mpmath.matrix([mpmath.cos(angle / 2), *(factor * component for component in phi)])


def rows(entries, length):
    return mpmath.matrix([entries[start : start + length] for start in range(0, len(entries), length)])


FUNCTIONS = {
    "exp quaternion": exp_quaternion,
    "exp": lambda phi: exponential(skew(phi)),
    "log": logarithm,
    "J_l": lambda phi: integral_of_exponential(skew(phi)),
    "J_r": lambda phi: integral_of_exponential(-skew(phi)),
    "J_l^-1": lambda phi: integral_of_exponential(skew(phi)) ** -1,
    "J_r^-1": lambda phi: integral_of_exponential(-skew(phi)) ** -1,
    "pose exp": lambda x: integral_of_exponential(skew(x[:3])) * mpmath.matrix(x[3:]),
    "pose J_l": lambda x: integral_of_exponential(bracket(x)),
}


def expected(name, x):
    """The exact result, and what an error in units of rounding may be multiplied with: a part of the argument's size
    moves it, by the derivative."""
    kind, _, what = name.partition(" ")
    # Matrices of Rodrigues parameters are rational: a part of the argument moves them by as many parts.
    rational = kind == "rodrigues"
    extent = 1 if rational else 1 + size(mpmath.matrix(x))
    if name in FUNCTIONS:
        exact = FUNCTIONS[name](x)
        if name.endswith("^-1"):
            return exact, size(exact) ** 2 * extent
        # Tiny vectors keep their own digits.
        return exact, size(exact) * (1 if name == "log" else extent)
    if what == "rotation":
        return ROTATIONS[kind](x), extent
    matrix, axes = what.split()
    if matrix == "H":
        exact = possible(kind, x, h_matrix(kind, x, axes))
        return exact, size(exact) * extent
    exact = k_matrix(kind, x, axes)
    condition = 1 if rational else size(exact) * size(h_matrix(kind, x, axes))
    return exact, size(exact) * condition * extent


class FiftyDigits(unittest.TestCase):
    """Checks K-I-4.2.1b, K-I-4.2.2, K-I-4.2.4, K-I-4.3.2, K-I-4.4.2, K-I-4.5.5, K-I-4.6.2, K-I-4.0a."""

    def test_exp_log_and_rate_matrices(self):
        worst = {}
        output = subprocess.run([os.environ["KOPPEL_PROBE"]], check=True, capture_output=True, text=True).stdout
        for line in output.splitlines():
            name, argument, result = (part.strip() for part in line.split(";"))
            x = [mpf(float.fromhex(number)) for number in argument.split()]
            found = [mpf(float.fromhex(number)) for number in result.split()]
            if " noK " in name:
                self.refused(name, x)
                continue
            if name.endswith(" quaternion") and not name.startswith("exp"):
                kind = name.split()[0]
                exact, scale = ROTATIONS[kind](x), 1 if kind == "rodrigues" else 1 + size(mpmath.matrix(x))
                found = list(of_quaternion(found))
            else:
                exact, scale = expected(name, x)
                if " H " in name:
                    found = list(possible(name.split()[0], x, rows(found, len(x))))
            error = mpmath.sqrt(sum((a - b) ** 2 for a, b in zip(found, exact)))
            units = error / (UNIT * scale) if error else mpf(0)
            self.assertLessEqual(units, 8, f"{name} at {argument}")
            worst[name] = max(worst.get(name, 0), float(units))
        for name, units in worst.items():
            print(f"{name:28} {units:5.2f} units")
        self.assertGreater(len(worst), 50)

    def refused(self, name, x):
        """K is refused only where H is singular to rounding."""
        kind, _, axes = name.split()
        h = h_matrix(kind, x, axes)
        if kind in NORMALS:
            h = mpmath.matrix([*h.tolist(), NORMALS[kind](x)])
        self.assertLess(abs(mpmath.det(h)), 16 * UNIT, f"{name} at {x}")


if __name__ == "__main__":
    unittest.main()
