"""Prints reference digits for motions that reduce to a few equations: those of digits.cpp whose source is digits.py.

Equations of each are written down here anew, in coordinates that koppel does not use; they are integrated in the
processor's extended precision (64 bits of mantissa) by extrapolation of order 16 after Gragg, Bulirsch and Stoer, in
two step sizes. What both agree on is printed; koppel has no part in it.

    python3 apps/bench/digits.py
"""

import numpy as np

F = np.longdouble
PI = F("3.14159265358979323846264338327950288")


def exact(text):
    return F(text)


def extrapolated_step(f, y, h, order=8):
    """One step by the modified midpoint rule in 2, 4, ... 2 order parts, extrapolated to parts of no length."""
    table = []
    for j in range(1, order + 1):
        n = 2 * j
        d = h / n
        a, b = y, y + d * f(y)
        for _ in range(n - 1):
            a, b = b, a + 2 * d * f(b)
        row = [(a + b + d * f(b)) / 2]
        for k in range(1, j):
            ratio = (F(n) / F(2 * (j - k))) ** 2
            row.append(row[k - 1] + (row[k - 1] - table[-1][k - 1]) / (ratio - 1))
        table.append(row)
    return table[-1][-1]


def integrate(f, y, end, steps):
    y = np.array(y, dtype=F)
    h = F(end) / steps
    for _ in range(steps):
        y = extrapolated_step(f, y, h)
    return y


def quaternion_rate(q, w):
    """Of q = (w, x, y, z), body to world, from the angular velocity in the body's axes."""
    s, x, y, z = q
    a, b, c = w
    return np.array([-x * a - y * b - z * c, s * a + y * c - z * b, s * b + z * a - x * c, s * c + x * b - y * a]) / 2


def body(inertia, moment):
    """A rigid body about a fixed point: inertia about it, moment (of q) in the body's axes."""
    i = np.array([F(v) for v in inertia], dtype=F)

    def f(state):
        q, w = state[:4], state[4:]
        turning = moment(q) - np.cross(w, i * w)
        return np.concatenate([quaternion_rate(q, w), turning / i])

    return f


def rows(q):
    s, x, y, z = q
    return 2 * (x * z - s * y), 2 * (y * z + s * x), s * s - x * x - y * y + z * z  # world z in the body's axes


def heavy_top():
    weight = 15 * exact("9.81")
    across = exact("0.46875")  # axis y is that of the top; inertia in the scene is about the centre, 1 m from the point

    def moment(q):
        up = rows(q)
        # r x F with r = (0, 1, 0), F = -weight * up
        return np.array([-weight * up[2], F(0), weight * up[0]])

    side = exact("0.234375") + 15
    f = body([side, across, side], moment)
    return f, [1, 0, 0, 0, 0, 150, exact("-4.61538")], "2", ("point.rotation.w", "point.rotation.x", "point.rotation.y",
                                                            "point.rotation.z"), 4000


def satellite():
    f = body([1, 2, 3], lambda q: np.zeros(3, dtype=F))
    return f, [1, 0, 0, 0, exact("0.01"), 1, exact("0.01")], "40", ("satellite.rotation.w", "satellite.rotation.x",
                                                                     "satellite.rotation.y", "satellite.rotation.z"), 400


def folding_slidercrank():
    g = exact("9.81")

    def f(y):
        s, c, w = np.sin(y[0]), np.cos(y[0]), y[1]
        return np.array([w, -(2 * s * c * w * w + g * c) / (2 * (1 / F(3) + s * s))])

    return f, [PI / 4, 2 * np.sqrt(F(2))], "10", ("crank.angle",), 1000


class FourBar:
    """Crank 1, coupler 3, rocker 2.5, ground 3.5 m; uniform rods of 1 kg. The crank's angle is the only coordinate."""

    lengths = [F(1), F(3), exact("2.5")]

    def __init__(self):
        self.b, self.c = F("0.656"), F("1.714")

    def close(self, a):
        b, c = self.b, self.c
        for _ in range(40):
            x = np.cos(a) + 3 * np.cos(b) - exact("3.5") - exact("2.5") * np.cos(c)
            y = np.sin(a) + 3 * np.sin(b) - exact("2.5") * np.sin(c)
            xb, yb, xc, yc = -3 * np.sin(b), 3 * np.cos(b), exact("2.5") * np.sin(c), -exact("2.5") * np.cos(c)
            d = xb * yc - xc * yb
            db, dc = (-x * yc + xc * y) / d, (-xb * y + x * yb) / d
            b, c = b + db, c + dc
            if abs(db) + abs(dc) < F("1e-18"):
                break
        self.b, self.c = b, c
        return b, c

    def f(self, state):
        a, w = state
        b, c = self.close(a)
        sa, ca, sb, cb, sc, cc = np.sin(a), np.cos(a), np.sin(b), np.cos(b), np.sin(c), np.cos(c)
        half = exact("2.5")
        d = -3 * sb * (-half * cc) - half * sc * 3 * cb

        def solve(x, y):  # of the rates of b and c against what the crank does to the loop
            return (-x * (-half * cc) + half * sc * y) / d, (3 * sb * y + x * 3 * cb) / d

        kb, kc = solve(-sa, ca)
        vb, vc = kb * w, kc * w
        ab, ac = solve(-ca * w * w - 3 * cb * vb * vb + half * cc * vc * vc,
                       -sa * w * w - 3 * sb * vb * vb + half * sc * vc * vc)
        g = exact("9.81")
        # centres: of the crank at 1/2, of the coupler at crank end + 3/2, of the rocker at 5/4 from the ground
        reach = [[(-sa / 2, ca / 2)], [(-sa, ca), (-1.5 * sb, 1.5 * cb)], [(-half / 2 * sc, half / 2 * cc)]]
        turn = [[F(1)], [F(1), kb], [kc]]
        bend = [[(-ca / 2, -sa / 2)], [(-ca, -sa), (-1.5 * cb, -1.5 * sb)], [(-half / 2 * cc, -half / 2 * sc)]]
        fast = [[w], [w, vb], [vc]]
        extra = [[F(0)], [F(0), ab], [ac]]
        mass = rest = F(0)
        for i in range(3):
            vx = sum(r[0] * k for r, k in zip(reach[i], turn[i]))
            vy = sum(r[1] * k for r, k in zip(reach[i], turn[i]))
            ax = sum(r[0] * e + p[0] * s * s for r, e, p, s in zip(reach[i], extra[i], bend[i], fast[i]))
            ay = sum(r[1] * e + p[1] * s * s for r, e, p, s in zip(reach[i], extra[i], bend[i], fast[i]))
            inertia = self.lengths[i] ** 2 / 12
            k, e = turn[i][-1], extra[i][-1]
            mass += vx * vx + vy * vy + inertia * k * k
            rest += ax * vx + (ay + g) * vy + inertia * e * k
        return np.array([w, -rest / mass])


def fourbar_free():
    return FourBar().f, [exact("0.7"), exact("0.5")], "10", ("crank.angle",), 500


def digits(made):
    f, start, end, names, steps = made
    coarse, fine = (integrate(f, start, end, n) for n in (steps, 2 * steps))
    for name, value, other in zip(names, fine, coarse):
        print(f"  {name:24} {np.format_float_positional(value, precision=21, unique=False)}  +- {abs(value - other):.1e}")


def top():
    """Steady precession in closed form: turns about the vertical, the line of nodes and the top's own axis."""
    tilt, spin, axial, across = PI / 6, F(200), exact("0.002"), exact("0.005")
    b = axial * spin / (2 * across * np.cos(tilt))
    c = 4 * exact("9.81") * exact("0.025") / (across * np.cos(tilt))
    precession = b - np.sqrt(b * b - c)
    own = spin - precession * np.cos(tilt)  # at 1 s
    plus, minus = (precession + own) / 2, (precession - own) / 2
    for name, value in zip("wxyz", (np.cos(tilt / 2) * np.cos(plus), np.sin(tilt / 2) * np.cos(minus),
                                    np.sin(tilt / 2) * np.sin(minus), np.cos(tilt / 2) * np.sin(plus))):
        print(f"  point.rotation.{name}         {np.format_float_positional(value, precision=21, unique=False)}")


def pendulum():
    """From the published place of the bob after 10 s."""
    print("  pivot.angle             ",
          np.format_float_positional(np.arcsin(exact("-0.275087462576116860054")), precision=21, unique=False))


if __name__ == "__main__":
    for made in (heavy_top, satellite, folding_slidercrank, fourbar_free):
        print(made.__name__)
        digits(made())
    for closed in (top, pendulum):
        print(closed.__name__)
        closed()
