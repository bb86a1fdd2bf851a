"""The five-link suspension X-5LINK through Python: golden positions and rates, shapes, a run, a stream."""

import math
import pathlib
import tempfile
import threading
import unittest

import numpy
from scenes import SUSPENSION

import koppel

PRINTED = 0.5e-9  # half a unit of the last digit of the golden values


class Suspension(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.mechanism = koppel.load(SUSPENSION)
        cls.wheel = cls.mechanism.frames.index("wheel_centre")

    def closed(self, travel, rack, rate=0.0):
        """A state that was led there from the start, in small steps."""
        state = self.mechanism.state()
        start = -0.08
        for fraction in numpy.linspace(0.0, 1.0, 21):
            state.set_input("wheel.z", start + fraction * (travel - start), rate)
            state.set_input("rack.displacement", fraction * rack)
            report = state.close()
            self.assertLess(report.residual, 1e-13)
        return state

    def records_of(self, state):
        return dict(zip(self.mechanism.records, state.records()))


class Golden(Suspension):
    def expect(self, travel, rack, x, y, angles):
        records = self.records_of(self.closed(travel, rack))
        self.assertAlmostEqual(records["wheel_centre.x"], x, delta=PRINTED)
        self.assertAlmostEqual(records["wheel_centre.y"], y, delta=PRINTED)
        for name, angle in zip(("alpha", "beta", "gamma"), angles):
            self.assertAlmostEqual(math.degrees(records[f"wheel_angles.{name}"]), angle, delta=PRINTED)

    def test_wheel_up(self):
        self.expect(0.08, 0.0, 0.000131326, -0.749874340, (-2.927474653, -0.690343763, -1.188588650))

    def test_wheel_down(self):
        self.expect(-0.08, 0.0, 0.001681270, -0.748538075, (1.276787261, 0.845735264, 2.368945167))

    def test_rack_moved(self):
        self.expect(0.0, 0.02, -0.005088751, -0.758076689, (-0.082519902, -1.715507801, -8.362647593))

    def test_twist_at_the_design_position(self):
        state = self.closed(0.0, 0.0, rate=1.0)
        state.velocities()
        golden = (-0.452162529, -0.166312272, -0.377515966, -0.008969121, -0.006120659, 1.0)
        numpy.testing.assert_allclose(state.twists("frame")[self.wheel], golden, rtol=0, atol=PRINTED)


class Arrays(Suspension):
    def test_shapes(self):
        state, sizes = self.mechanism.state(), self.mechanism.sizes
        report = state.move(0.5)
        self.assertEqual(report.verdict, "closed")
        self.assertEqual((report.rank, report.redundant), (report.unknowns, False))
        self.assertEqual(state.time, 0.5)
        self.assertEqual(state.q.shape, (sizes.coordinates,))
        self.assertEqual((state.v.shape, state.a.shape), ((sizes.rates,),) * 2)
        self.assertEqual(state.poses().shape, (8, 3, 4))
        self.assertEqual(state.poses("frame").shape, (2, 3, 4))
        self.assertEqual(state.twists().shape, (8, 6))
        self.assertEqual(state.frame_accelerations("frame").shape, (2, 6))
        self.assertEqual(state.jacobian("carrier").shape, (6, sizes.rates))
        self.assertEqual(state.jacobian_rate("wheel_centre", "frame").shape, (6, sizes.rates))
        self.assertEqual(state.records().shape, (len(self.mechanism.records),))
        for array in (state.q, state.poses(), state.records()):
            self.assertEqual(array.dtype, numpy.float64)

    def test_names_and_units_belong_together(self):
        mechanism = self.mechanism
        self.assertEqual((mechanism.name, mechanism.title), ("fivelink", "Five-link suspension"))
        self.assertEqual(mechanism.bodies[:2], ["ground", "carrier"])
        self.assertEqual(mechanism.inputs, ["wheel.z", "rack.displacement"])
        self.assertEqual(mechanism.unit("coordinate", "wheel.z"), "m")
        self.assertEqual(mechanism.unit("coordinate", "inner_link1.angle1"), "rad")
        self.assertEqual(mechanism.index("coordinate", mechanism.coordinates[7]), 7)
        self.assertEqual(mechanism.warnings, [])
        self.assertIn("wheel", mechanism.explain())
        self.assertEqual(mechanism.gravity, (0.0, 0.0, -9.81))

    def test_a_rotation_is_orthogonal(self):
        state = self.closed(0.08, 0.0)
        rotation = state.poses("frame")[self.wheel, :, :3]
        numpy.testing.assert_allclose(rotation @ rotation.T, numpy.eye(3), atol=1e-14)

    def test_the_jacobian_maps_rates(self):
        state = self.mechanism.state()
        state.move(0.3)
        at = "wheel_centre", "frame"
        numpy.testing.assert_allclose(state.jacobian(*at) @ state.v, state.twists("frame")[self.wheel], atol=1e-12)
        numpy.testing.assert_allclose(state.jacobian(*at) @ state.a + state.jacobian_rate(*at) @ state.v,
                                      state.frame_accelerations("frame")[self.wheel], atol=1e-11)

    def test_mobility_is_travel_and_steering(self):
        analysis = self.closed(0.0, 0.0).analyse()
        self.assertEqual((analysis.mobility_count, analysis.mobility_rank), (2, 2))

    def test_freedoms_need_no_excuse(self):
        state = self.closed(0.0, 0.0)
        self.assertEqual(state.freedoms(), koppel.Freedoms(2, 2, 2, 0, 0, 0, 0, 0, 0, False))
        self.assertIn("spatial, closed by 6 conditions", state.explain_freedoms())

    def test_a_start_is_taken_and_read_back(self):
        state, there = self.mechanism.state(), self.closed(0.04, 0.0)
        state.q = there.q
        numpy.testing.assert_allclose(state.q, there.q, rtol=0, atol=1e-15)
        state.set_input("wheel.z", 0.04)
        state.set_input("rack.displacement", 0.0)
        self.assertEqual(state.close(method="newton").verdict, "closed")

    def test_a_copy_goes_its_own_way(self):
        state = self.mechanism.state()
        state.move(0.2)
        other = state.copy()
        numpy.testing.assert_array_equal(other.q, state.q)
        other.move(0.4)
        self.assertEqual((state.time, other.time), (0.2, 0.4))
        self.assertFalse(numpy.array_equal(other.q, state.q))


class Run(Suspension):
    def test_returns_every_record_over_time(self):
        table = koppel.run(self.mechanism, numpy.linspace(0.0, 1.0, 41))
        self.assertEqual(set(table), {"time", "residual", *self.mechanism.records})
        self.assertEqual({column.shape for column in table.values()}, {(41,)})
        self.assertLess(table["residual"].max(), 1e-13)
        self.assertAlmostEqual(table["wheel_centre.y"][-1], -0.749874340, delta=PRINTED)

    def test_takes_a_file_and_the_times_that_it_proposes(self):
        table = koppel.run(SUSPENSION)
        self.assertEqual(table["time"].size, 321)
        numpy.testing.assert_allclose(table["wheel.z"], -0.08 + 0.16 * table["time"], atol=1e-15)

    def test_threads_share_a_mechanism(self):
        times, tables = numpy.linspace(0.0, 1.0, 41), [None] * 3

        def fill(index):
            tables[index] = koppel.run(self.mechanism, times)

        threads = [threading.Thread(target=fill, args=(index,)) for index in range(len(tables))]
        for thread in threads:
            thread.start()
        for thread in threads:
            thread.join()
        alone = koppel.run(self.mechanism, times)
        for table in tables:
            for name, column in alone.items():
                numpy.testing.assert_array_equal(table[name], column)


class Streams(Suspension):
    def test_a_log_holds_every_state(self):
        with tempfile.TemporaryDirectory() as folder:
            file = pathlib.Path(folder, "run.lcm")
            state = self.mechanism.state()
            with koppel.Stream(self.mechanism, url=f"file://{file}?mode=w", name="PY") as stream:
                for time in numpy.linspace(0.0, 1.0, 11):
                    stream.publish(state, state.move(time))
                stream.event(1.0, "bump stop", severity="warning")
                statistics = stream.close()
            self.assertEqual(statistics, koppel.Statistics(published=11, sent=11, dropped=0, failed=0))
            log = file.read_bytes()
            self.assertEqual((log.count(b"KOPPEL_PY_STATE"), log.count(b"bump stop")), (11, 1))


if __name__ == "__main__":
    unittest.main()
