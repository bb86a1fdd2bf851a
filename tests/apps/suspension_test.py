"""The five-link suspension: against an independent solution of its rod lengths, and what the program leaves behind."""

import re
import unittest
import xml.etree.ElementTree as tree

import numpy as np

from program import FINE, SCENE, SCENES, SYSTEM, USAGE, ProgramTest, log_channels, read_table

MULTILINK = SCENES / "multilink.toml"

# Hardpoints at the design position: chassis end and carrier end of each rod, and the wheel centre.
INNER = np.array([[0.060, 0.547, 0.082], [-0.157, 0.508, 0.062], [0.036, 0.338, -0.133], [0.723, 0.599, -0.072],
                  [-0.257, 0.320, -0.116]])
OUTER = np.array([[0.056, 0.864, 0.151], [0.056, 0.864, 0.151], [0.029, 0.842, -0.093], [0.000, 0.864, -0.156],
                  [-0.144, 0.862, -0.056]])
CENTRE = np.array([0.0, 0.950, 0.0])
LENGTHS = np.linalg.norm(OUTER - INNER, axis=1)


def cross_matrix(v):
    return np.array([[0, -v[2], v[1]], [v[2], 0, -v[0]], [-v[1], v[0], 0]])


def turned(rotation, vector):
    """A rotation followed by a small turn about a world axis, by Rodrigues' formula."""
    angle = np.linalg.norm(vector)
    if angle == 0.0:
        return rotation
    k = cross_matrix(vector / angle)
    return (np.eye(3) + np.sin(angle) * k + (1 - np.cos(angle)) * k @ k) @ rotation


def carrier(height, rotation, centre):
    """Newton's method on five rod lengths and the height: the pose of the carrier."""
    for _ in range(30):
        arms = (OUTER - CENTRE) @ rotation.T
        rods = centre + arms - INNER
        lengths = np.linalg.norm(rods, axis=1)
        residual = np.append(lengths - LENGTHS, centre[2] - height)
        directions = rods / lengths[:, None]
        jacobian = np.vstack([np.hstack([directions, np.cross(arms, directions)]), [0, 0, 1, 0, 0, 0]])
        step = np.linalg.solve(jacobian, -residual)
        centre = centre + step[:3]
        rotation = turned(rotation, step[3:])
        if np.abs(step).max() < 1e-15:
            break
    assert np.abs(residual).max() < 1e-15
    return rotation, centre


def reference(heights):
    """Wheel centre, camber and toe of a left wheel by ISO 8855, for heights that begin at the design position."""
    rotation, centre = np.eye(3), CENTRE
    rows = {}
    for height in heights:
        rotation, centre = carrier(height, rotation, centre)
        axis = rotation[:, 1]
        rows[round(1000 * height)] = [*centre, -np.arcsin(axis[2]), np.arctan2(axis[0], axis[1])]
    return rows


class Sweep(ProgramTest):
    def setUp(self):
        super().setUp()
        self.printed = self.expect(FINE, "suspension", MULTILINK, "--csv", "table.csv").stdout
        self.table = read_table(self.folder / "table.csv")

    def test_rows_cover_the_travel(self):
        self.assertEqual([round(1000 * t) for t in self.table["travel"]], list(range(-80, 81, 10)))

    def test_every_row_is_closed_to_rounding(self):
        self.assertLess(max(self.table["residual"]), 1e-13)
        self.assertTrue(all(0.0 < e < 1e-11 for e in self.table["coordinate_error"]))

    def test_the_wheel_moves_as_the_rod_lengths_demand(self):
        heights = [0.01 * i for i in range(9)]
        rows = {**reference(heights), **reference([-h for h in heights])}
        # Both solve to rounding, 1e-15; the Jacobian's inverse may enlarge that some hundred times.
        for i, travel in enumerate(self.table["travel"]):
            row = [self.table[name][i] for name in ("x", "y", "z", "camber", "toe")]
            np.testing.assert_allclose(row, rows[round(1000 * travel)], rtol=0, atol=1e-12)

    def test_changes_count_from_the_design_position(self):
        design = self.table["travel"].index(0.0)
        for name in ("track_change", "wheelbase_change"):
            self.assertEqual(self.table[name][design], 0.0)
        for i, change in enumerate(self.table["track_change"]):
            self.assertEqual(change, self.table["y"][i] - self.table["y"][design])

    def test_the_printed_rates_are_the_slopes_of_the_columns(self):
        camber, toe = map(float, re.search(r"camber (\S+) deg, toe (\S+) deg for each 10 mm", self.printed).groups())
        design = self.table["travel"].index(0.0)
        for name, printed in (("camber", camber), ("toe", toe)):
            column = np.degrees(self.table[name])
            around = column[design - 2 : design + 3]
            # Central difference of fourth order; its remainder and the three printed decimals stay below the tolerance.
            slope = (around[0] - 8 * around[1] + 8 * around[3] - around[4]) / 12
            self.assertAlmostEqual(slope, printed, delta=6e-4)

    def test_the_contact_point_of_a_tyre_is_used_where_a_radius_is_given(self):
        self.expect(FINE, "suspension", MULTILINK, "--csv", "tyre.csv", "--tyre-radius", "0.3")
        tyre = read_table(self.folder / "tyre.csv")
        # The contact point moves out where the top of the wheel leans in: by the radius times the sine of camber.
        for i, camber in enumerate(tyre["camber"]):
            toe = tyre["toe"][i]
            expected = self.table["track_change"][i] - 0.3 * np.sin(camber) * np.cos(toe)
            self.assertAlmostEqual(tyre["track_change"][i], expected, delta=1e-14)


class Picture(ProgramTest):
    def test_the_picture_is_well_formed_and_complete(self):
        self.expect(FINE, "suspension", MULTILINK, "--svg", "picture.svg")
        root = tree.parse(self.folder / "picture.svg").getroot()
        name = "{http://www.w3.org/2000/svg}"
        self.assertEqual(root.tag, name + "svg")
        rods = [line for line in root.iter(name + "line") if line.get("class").startswith("rod ")]
        # Five rods, three positions, two views, and three lines in the legend.
        self.assertEqual(len(rods), 5 * 3 * 2 + 3)
        self.assertEqual(len(list(root.iter(name + "path"))), 2)
        texts = " ".join(text.text for text in root.iter(name + "text"))
        for label in ("travel [mm]", "toe [deg]", "camber [deg]", "y [m]", "z [m]", "x [m]"):
            self.assertIn(label, texts)
        for element in root.iter():
            self.assertFalse(any(value in ("nan", "inf") for value in element.attrib.values()))

    def test_a_picture_that_cannot_be_written_is_reported(self):
        self.expect(SYSTEM, "suspension", MULTILINK, "--svg", "absent/picture.svg")


class Log(ProgramTest):
    def test_the_log_holds_the_way_down_and_all_rows(self):
        self.expect(FINE, "suspension", MULTILINK, "--log", "run.lcm")
        self.assertEqual(log_channels(self.folder / "run.lcm")["KOPPEL_MULTILINK_STATE"], 8 + 17)


class Usage(ProgramTest):
    def test_a_scene_that_is_no_suspension_is_refused_by_name(self):
        result = self.expect(USAGE, "suspension", SCENES / "4bar.toml")
        self.assertIn("wheel.z", result.stderr)

    def test_a_faulty_scene_is_refused(self):
        self.expect(SCENE, "suspension", self.write("bad.toml", "schema = 1\n[[joint]]\n"))


if __name__ == "__main__":
    unittest.main()
