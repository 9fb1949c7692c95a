# SPDX-License-Identifier: MIT
"""What limit() and the measures return, by hand values."""

import sys
import unittest

import numpy as np

import apsl
from cloth import CORNER, ONE_TRIANGLE, TIME_STEP, Grid, device, limiter


class OneTriangle(unittest.TestCase):
    """Vertices 0 and 2 pinned; vertex 1 moves along x, which changes the area in proportion."""

    def limit(self, speed, **parameters):
        velocities = np.array([[0, 0, 0], [speed, 0, 0], [0, 0, 0]], np.float32)
        plain = {"time_step": TIME_STEP, "first_regularization": 0, "adaptive_threshold": 0, **parameters}
        return limiter(ONE_TRIANGLE, 3, warm_start_sub_steps=0).limit(CORNER, velocities, [0, 2, 0], [0.5], **plain)

    def test_without_regularization_one_sub_step_restores_the_area(self):
        velocities, stats = self.limit(32, regularization=1, sub_steps=1)  # to x = 1.5, area 3/4
        np.testing.assert_allclose(velocities, 0, atol=1e-4)
        self.assertLess(stats.max_area_change, 1e-6)
        self.assertEqual((stats.sub_steps, stats.status), (1, "ok"))

    def test_regularization_divides_the_correction(self):
        velocities, stats = self.limit(32, regularization=2, sub_steps=1)
        np.testing.assert_allclose(velocities, [[0, 0, 0], [16, 0, 0], [0, 0, 0]], atol=1e-3)
        self.assertAlmostEqual(stats.max_area_change, 0.25, delta=1e-5)
        self.assertAlmostEqual(stats.rms_area_change, 0.25, delta=1e-5)

    def test_compressed_is_restored_too(self):
        velocities, _ = self.limit(-32, regularization=2, sub_steps=1)
        np.testing.assert_allclose(velocities[1], [-16, 0, 0], atol=1e-3)

    def test_no_sub_steps_changes_nothing(self):
        velocities, stats = self.limit(32, sub_steps=0)
        np.testing.assert_array_equal(velocities[1], [32, 0, 0])
        self.assertEqual(stats.sub_steps, 0)

    def test_switched_off_nothing_is_looked_at(self):
        velocities, stats = self.limit(np.nan, enabled=False)
        np.testing.assert_array_equal(velocities[1], np.array([np.nan, 0, 0], np.float32))
        self.assertEqual((stats.sub_steps, stats.initial_max_area_change, stats.status), (0, 0, "off"))


class StretchCeiling(unittest.TestCase):
    """One triangle, two corners pinned: the third is pulled away along its edge."""

    def limit(self, speed, ceiling, shapes=None, **options):
        made = limiter(ONE_TRIANGLE, 3, limits_stretch=True, **options)
        velocities = np.array([[0, 0, 0], [speed, 0, 0], [0, 0, 0]], np.float32)
        shapes = apsl.rest_shapes(CORNER, ONE_TRIANGLE) if shapes is None else shapes
        return made.limit(CORNER, velocities, [0, 2, 0], [0.5], time_step=TIME_STEP, rest_shapes=shapes,
                          stretch_ceiling=ceiling)

    def test_the_shape_of_a_right_triangle(self):
        np.testing.assert_array_equal(apsl.rest_shapes(CORNER, ONE_TRIANGLE), [[1, 0, 0, 1]])
        np.testing.assert_array_equal(apsl.rest_shapes(np.zeros((3, 3)), ONE_TRIANGLE), [[0, 0, 0, 0]])
        self.assertTrue(np.isnan(apsl.rest_shapes(np.full((3, 3), np.nan), ONE_TRIANGLE)).any())

    def test_stretch_and_area_are_held_and_told_of(self):
        velocities, stats = self.limit(64, 1.1)  # to twice its length
        self.assertLess(stats.max_stretch, 1.11)
        self.assertLess(stats.max_area_change, 0.02)
        self.assertAlmostEqual(stats.initial_max_stretch_excess, 0.9, delta=1e-4)
        self.assertEqual(stats.status, "ok")
        self.assertLess(velocities[1, 0], 7)

    def test_a_ceiling_for_each_triangle_and_none(self):
        _, stats = self.limit(64, [1.1], stretch_ceiling_per_triangle=True)
        self.assertLess(stats.max_stretch, 1.11)
        for nothing in ({"ceiling": 0}, {"ceiling": 1.1, "shapes": [[0, 0, 0, 0]]}):
            _, stats = self.limit(64, **nothing)
            self.assertEqual((stats.max_stretch, stats.stretch_rows), (0, 0))

    def test_what_is_missing_or_of_no_use_is_named(self):
        made = limiter(ONE_TRIANGLE, 3, limits_stretch=True)
        arrays = (CORNER, np.zeros((3, 3)), [0, 2, 0], [0.5])
        with self.assertRaisesRegex(apsl.Error, "rest_shapes"):
            made.limit(*arrays, stretch_ceiling=1.1)
        with self.assertRaisesRegex(apsl.Error, "stretch_ceiling is 1, expected 0 .areas alone. or a finite number >= 1.01"):
            made.limit(*arrays, rest_shapes=[[1, 0, 0, 1]], stretch_ceiling=1.0)
        with self.assertRaisesRegex(apsl.Error, "rest_shapes"):
            made.limit(*arrays, rest_shapes=[[1, 0, 0]], stretch_ceiling=1.1)
        for shapes in ([1, 0, 0, 1], [[1, 0], [0, 1]], [[[1, 0], [0, 1]]]):
            with self.assertRaisesRegex(apsl.Error, r"rest_shapes: got shape \(.*\), expected \(1, 4\)"):
                made.limit(*arrays, rest_shapes=shapes, stretch_ceiling=1.1)
        for ceiling in (1.0, -1, float("nan"), float("inf")):
            with self.assertRaisesRegex(apsl.Error, "triangle 0: stretch_ceiling is .*, expected 0 .areas alone. or a"):
                self.limit(1, [ceiling], stretch_ceiling_per_triangle=True)
        with self.assertRaisesRegex(apsl.Error, "limits_stretch is off"):
            limiter(ONE_TRIANGLE, 3).limit(*arrays, stretch_ceiling=1.1)
        with self.assertRaisesRegex(apsl.Error, "solver chebyshev"):
            limiter(ONE_TRIANGLE, 3, limits_stretch=True, solver="conjugate_gradient")


class WholeStep(unittest.TestCase):
    """Integration inside the call: positions and velocities come back."""

    def test_what_nothing_limits_falls(self):
        made = limiter(ONE_TRIANGLE, 3, integrates=True)
        positions, velocities, stats = made.step(CORNER, np.zeros((3, 3)), [0, 2, 2], [0], time_step=TIME_STEP,
                                                 sub_steps=5, acceleration=(0, -8, 4), damping=0)
        # Four parts of symplectic Euler: (1 + 2 + 3 + 4) / 16 of g Δt².
        fallen = np.array([0, -8, 4]) * TIME_STEP**2 * 10 / 16
        np.testing.assert_allclose(positions, CORNER + [[0, 0, 0], fallen, fallen], atol=1e-7)
        np.testing.assert_allclose(velocities[1:], [np.array([0, -8, 4]) * TIME_STEP] * 2, rtol=1e-6)
        np.testing.assert_array_equal(velocities[0], 0)
        self.assertEqual(stats.status, "ok")

    def test_what_hangs_stays(self):
        made = limiter(ONE_TRIANGLE, 3, integrates=True, limits_stretch=True)
        positions, velocities = CORNER, np.zeros((3, 3))
        for _ in range(30):
            positions, velocities, stats = made.step(positions, velocities, [0, 2, 0], [0.5], time_step=TIME_STEP,
                                                     acceleration=[9.81, 0, 0], stretch_ceiling=1.1,
                                                     rest_shapes=apsl.rest_shapes(CORNER, ONE_TRIANGLE))
        np.testing.assert_allclose(positions, CORNER, atol=2e-3)
        self.assertLess(stats.max_area_change, 2e-3)

    def test_what_falls_stays_on_the_floor(self):
        made = limiter(ONE_TRIANGLE, 3, integrates=True, keeps_contacts=True)
        floor = np.tile([0, 0, 1, -0.01, 0, 0, 0, 1], (3, 1))
        positions, velocities = CORNER, np.zeros((3, 3))
        for _ in range(10):
            positions, velocities, stats = made.step(positions, velocities, [2, 2, 2], [0.5], time_step=TIME_STEP,
                                                     acceleration=[0, 0, -9.81], contacts=floor)
        np.testing.assert_allclose(positions, CORNER - [0, 0, 0.01], atol=1e-6)
        np.testing.assert_allclose(velocities, 0, atol=1e-6)
        self.assertEqual(stats.status, "ok")
        for wrong in (floor[:2], floor[:, :7], "x"):
            with self.assertRaisesRegex(apsl.Error, "contacts"):
                made.step(CORNER, velocities, [2, 2, 2], [0.5], contacts=wrong)
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'contact', expected contacts"):
            made.step(CORNER, velocities, [2, 2, 2], [0.5], contact=floor)
        with self.assertRaisesRegex(apsl.Error, "contacts: got nothing"):
            made.step(CORNER, velocities, [2, 2, 2], [0.5])

    def test_each_vertex_falls_by_its_own_acceleration(self):
        made = limiter(ONE_TRIANGLE, 3, integrates=True, acceleration_per_vertex=True)
        arrays, winds = (CORNER, np.zeros((3, 3)), [2, 2, 0], [0]), np.array([[1, 2, 3], [-4, 0, 0.5], [9, 9, 9]])
        settings = {"time_step": TIME_STEP, "sub_steps": 2, "acceleration": (0, -8, 4)}
        positions, velocities, stats = made.step(*arrays, accelerations=winds, **settings)
        # One part: u = (g + a) Δt, and x moves on by u Δt. The last vertex is pinned.
        expected = (winds + [0, -8, 4]) * TIME_STEP * [[1], [1], [0]]
        np.testing.assert_allclose(velocities, expected, rtol=1e-6)
        np.testing.assert_allclose(positions, CORNER + expected * TIME_STEP, atol=1e-7)
        self.assertEqual(stats.status, "ok")
        for wrong in (winds[:2], winds[:, :2], "x"):
            with self.assertRaisesRegex(apsl.Error, "accelerations"):
                made.step(*arrays, accelerations=wrong)
        with self.assertRaisesRegex(apsl.Error, "accelerations: got nothing"):
            made.step(*arrays)
        with self.assertRaisesRegex(apsl.Error, "acceleration_per_vertex is on, which needs integrates"):
            limiter(ONE_TRIANGLE, 3, acceleration_per_vertex=True)

    def test_a_fold_that_was_opened_closes_again(self):
        pair = [[0, 1, 2], [1, 0, 3]]
        fold = [[0, 0, 0], [0, 1, 0], [1, 0.5, 0], [0, 0.5, 1]]
        hinges = apsl.rest_hinges(fold, pair)
        np.testing.assert_allclose(hinges, [[np.pi / 2, 1]], rtol=1e-12)
        made = limiter(pair, 4, integrates=True, limits_stretch=True, bends=True)
        rest = {"rest_shapes": apsl.rest_shapes(fold, pair), "rest_hinges": hinges}
        positions, velocities = [*fold[:3], [-1, 0.5, 0]], np.zeros((4, 3))
        for _ in range(600):  # critically damped, within some e^−10
            positions, velocities, stats = made.step(positions, velocities, [10] * 4, [0.5, 0.5], time_step=1 / 60,
                                                     stretch_ceiling=1.05, damping=2, bending=0.1, **rest)
        self.assertEqual(stats.status, "ok")
        np.testing.assert_allclose(apsl.rest_hinges(positions, pair)[0, 0], np.pi / 2, atol=0.01)
        with self.assertRaisesRegex(apsl.Error, "rest_hinges: got nothing"):
            made.step(fold, velocities, [10] * 4, [0.5, 0.5], rest_shapes=rest["rest_shapes"])

    def test_each_kind_of_limiter_has_its_call(self):
        arrays = (CORNER, np.zeros((3, 3)), [0, 2, 0], [0.5])
        with self.assertRaisesRegex(apsl.Error, "step: .*expected a call of limit"):
            limiter(ONE_TRIANGLE, 3).step(*arrays)
        made = limiter(ONE_TRIANGLE, 3, integrates=True)
        with self.assertRaisesRegex(apsl.Error, "limit: .*expected a call of step"):
            made.limit(*arrays)
        for wrong in (9.81, [1, 2], [1, 2, "x"], None):
            with self.assertRaisesRegex(apsl.Error, "acceleration"):
                made.step(*arrays, acceleration=wrong)
        with self.assertRaisesRegex(apsl.Error, "integrates is off"):
            limiter(ONE_TRIANGLE, 3).limit(*arrays, damping=1.0)


class Tethers(unittest.TestCase):
    """One triangle without a rest area, so that nothing but tethers moves it: vertex 0 is pinned."""

    def step(self, lengths, anchors=((0,), (0,), (0,)), velocities=((0, 0, 0),) * 3, sub_steps=2, **settings):
        """By default one part, and a last sub-step that has nothing to correct."""
        made = limiter(ONE_TRIANGLE, 3, integrates=True, tethers_per_vertex=len(anchors[0]))
        return made.step(CORNER, velocities, [0, 2, 2], [0], time_step=TIME_STEP, sub_steps=sub_steps,
                         tether_anchors=anchors, tether_lengths=lengths, **settings)

    def test_what_is_out_of_reach_goes_no_further_and_is_not_pulled_back(self):
        positions, after, stats = self.step([[0], [0.75], [0.75]], velocities=[[0, 0, 0], [16, 0, 0], [0, -8, 0]])
        np.testing.assert_allclose(positions, [[0, 0, 0], [1, 0, 0], [0, 0.875, 0]], atol=1e-6)
        np.testing.assert_allclose(after, [[0, 0, 0], [0, 0, 0], [0, -8, 0]], atol=1e-4)
        self.assertEqual(stats.status, "ok")

    def test_what_is_within_reach_goes_its_way(self):
        velocities = [[0, 0, 0], [16, 0, 0], [0, 8, 0]]
        expected = CORNER + np.array(velocities) * TIME_STEP
        positions, after, _ = self.step([[0], [1.25], [0]], velocities=velocities)
        np.testing.assert_array_equal(positions, expected)
        np.testing.assert_array_equal(after, velocities)
        positions, after, _ = self.step([[0], [1.125], [0]], velocities=velocities)  # half of the way
        np.testing.assert_allclose(positions, [[0, 0, 0], [1.125, 0, 0], expected[2]], atol=1e-6)
        np.testing.assert_allclose(after, [[0, 0, 0], [8, 0, 0], [0, 8, 0]], atol=1e-4)

    def test_an_anchor_goes_on_with_the_velocity_of_its_pin(self):
        # The pin ends at x = −1/2, and what is tethered to it 9/8 and 1 away from there, the latter from (1/2, 1).
        velocities = [[-32, 0, 0], [0, 0, 0], [0, 0, 0]]
        positions, after, _ = self.step([[0], [1.125], [1]], velocities=velocities)
        third = np.array([0.5, 1, 0]) / np.sqrt(1.25) - [0.5, 0, 0]
        np.testing.assert_allclose(positions, [[-0.5, 0, 0], [0.625, 0, 0], third], atol=1e-6)
        np.testing.assert_allclose(after, (positions - CORNER) / TIME_STEP, atol=1e-4)
        # In two parts: at half time the pin is at −1/4 and vertex 1 at 7/8, with 16 m/s; then it goes as the pin does.
        positions, after, _ = self.step([[0], [1.125], [0]], velocities=velocities, sub_steps=3)
        np.testing.assert_allclose(positions[:2], [[-0.5, 0, 0], [0.625, 0, 0]], atol=1e-6)
        np.testing.assert_allclose(after[1], [-32, 0, 0], atol=1e-4)
        # Out of reach from the start it goes as the pin does from the start.
        positions, after, _ = self.step([[0], [0.75], [0]], velocities=velocities)
        np.testing.assert_allclose(positions[:2], [[-0.5, 0, 0], [0.5, 0, 0]], atol=1e-6)

    def test_what_falls_is_held_at_its_length(self):
        # Vertex 2 hangs below the pin at its length, vertex 1 has none: g Δt² a call of one part.
        positions, velocities, _ = self.step([[0], [0], [1]], acceleration=(0, 16, 0))
        np.testing.assert_allclose(positions, [[0, 0, 0], [1, 16 * TIME_STEP**2, 0], [0, 1, 0]], atol=1e-6)
        np.testing.assert_allclose(velocities, [[0, 0, 0], [0, 16 * TIME_STEP, 0], [0, 0, 0]], atol=1e-4)

    def test_several_tethers_a_vertex_and_anchors_that_are_none(self):
        anchors = [[7, 7], [7, 0], [0, 4294967295]]
        positions, _, _ = self.step([[1, 1], [0.5, 1.125], [1.0625, 0.25]], anchors=anchors,
                                    velocities=[[0, 0, 0], [16, 0, 0], [0, 16, 0]])
        np.testing.assert_allclose(positions, [[0, 0, 0], [1.125, 0, 0], [0, 1.0625, 0]], atol=1e-6)

    def test_a_curtain_hangs_hardly_lower_than_its_tethers(self):
        cloth = Grid(10)
        rest = cloth.positions * [1, 1, 0]
        anchors, lengths = apsl.tethers_to_pins(rest, cloth.triangles, cloth.pins, 2)
        areas, ends = apsl.rest_areas(rest, cloth.triangles), []
        for tethers in ({}, {"tether_anchors": anchors, "tether_lengths": lengths}):
            made = limiter(cloth.triangles, cloth.vertex_count, integrates=True, tethers_per_vertex=2 * bool(tethers))
            positions, velocities = rest, 0 * rest
            for _ in range(60):
                positions, velocities, stats = made.step(positions, velocities, cloth.inverse_masses, areas,
                                                         sub_steps=10, acceleration=(0, 9.81, 0), damping=0.5, **tethers)
                self.assertEqual(stats.status, "ok")
            away = np.linalg.norm(positions[:, None] - positions[anchors], axis=2)
            ends.append((away / np.maximum(lengths, 1e-9))[lengths > 0].max())
        self.assertGreater(ends[0], 1.2)  # areas alone let it grow long
        self.assertLess(ends[1], 1.1)

    def test_how_they_are_made(self):
        anchors, lengths = apsl.tethers_to_pins(CORNER, ONE_TRIANGLE, [0], 2, stretch=1.5)
        self.assertEqual((anchors.dtype, lengths.dtype), (np.uint32, np.float32))
        np.testing.assert_array_equal(anchors, 0)
        np.testing.assert_array_equal(lengths, [[0, 0], [1.5, 0], [1.5, 0]])
        # Two pinned pieces, the nearer one first; the first of them is an edge, and 4 nearest to its own end.
        strip = [[0, 1, 2], [2, 1, 3], [2, 3, 4], [4, 3, 5]]
        points = [[x, y, 0] for x in (0, 1, 3) for y in (0, 1)]
        anchors, lengths = apsl.tethers_to_pins(points, strip, np.array([5, 0, 1]), 2)
        np.testing.assert_array_equal(anchors[2:5], [[0, 5], [1, 5], [5, 0]])
        np.testing.assert_allclose(lengths[2:5], [[1, np.sqrt(5)], [1, 2], [1, 3]], rtol=1e-6)
        np.testing.assert_array_equal(lengths[[0, 1, 5]], 0)
        self.assertEqual(apsl.pinned_piece_count(strip, 6, [5, 0, 1]), 2)
        self.assertEqual(apsl.pinned_piece_count(strip, 9, [5, 0, 8]), 2)  # in no triangle, 8 is no piece
        self.assertEqual(apsl.pinned_piece_count(strip, 6, []), 0)
        np.testing.assert_array_equal(apsl.tethers_to_pins(points, strip, [], 1)[1], np.zeros((6, 1)))


class Cloth(unittest.TestCase):
    def test_area_change_shrinks_to_what_stats_say(self):
        cloth = Grid(12)
        velocities, stats = limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays(), time_step=TIME_STEP)
        before = apsl.area_change(cloth.positions + TIME_STEP * cloth.velocities, cloth.triangles, cloth.rest_areas)
        after = apsl.area_change(cloth.positions + TIME_STEP * velocities, cloth.triangles, cloth.rest_areas)
        self.assertLess(after.max(), 0.5 * before.max())
        self.assertAlmostEqual(after.max(), stats.max_area_change, delta=1e-4)
        weights = cloth.rest_areas / cloth.rest_areas.sum()
        self.assertAlmostEqual(np.sqrt((weights * after**2).sum()), stats.rms_area_change, delta=0.02 * after.max())

    def test_pinned_velocities_come_back_bit_for_bit(self):
        cloth = Grid(12)
        velocities, _ = limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays(), time_step=TIME_STEP)
        self.assertEqual(velocities[cloth.pins].tobytes(), cloth.velocities[cloth.pins].tobytes())
        self.assertFalse((velocities == cloth.velocities).all())

    def test_vertices_in_no_triangle_are_left_alone(self):
        velocities = np.array([[0, 0, 0], [32, 0, 0], [0, 0, 0], [5, 6, 7]], np.float32)
        positions = np.vstack([CORNER, [[9, 9, 9]]])
        limited, _ = limiter(ONE_TRIANGLE, 4).limit(positions, velocities, [1, 1, 1, 1], [0.5])
        np.testing.assert_array_equal(limited[3], [5, 6, 7])

    def test_not_finite_is_a_status_and_velocities_come_back_as_given(self):
        cloth = Grid(6)
        for value in (np.nan, np.inf):
            cloth.positions[7, 1] = value
            velocities, stats = limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays())
            self.assertEqual(stats.status, "diverged")
            self.assertEqual(velocities.tobytes(), cloth.velocities.tobytes())

    def test_budget_used_up_is_a_status(self):
        cloth = Grid(12)
        _, stats = limiter(cloth.triangles, cloth.vertex_count).limit(
            *cloth.arrays(), regularization=1.001, tolerance=1e-6, max_iterations=1, sub_steps=1)
        self.assertEqual(stats.status, "not_converged")

    def test_regularization_per_triangle(self):
        cloth = Grid(6)
        by_number, _ = limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays(), regularization=2)
        mapped = limiter(cloth.triangles, cloth.vertex_count, regularization_per_triangle=True)
        by_array, _ = mapped.limit(*cloth.arrays(), regularization=np.full(len(cloth.triangles), 2.0))
        np.testing.assert_allclose(by_array, by_number, rtol=1e-5, atol=1e-5)
        uneven, _ = mapped.limit(*cloth.arrays(), regularization=np.linspace(1.1, 50, len(cloth.triangles)))
        self.assertGreater(np.abs(uneven - by_number).max(), 1e-3)


class Measures(unittest.TestCase):
    def test_rest_areas(self):
        positions = [[0, 0, 0], [3, 0, 0], [0, 4, 0], [0, 0, 5], [6, 0, 0]]
        np.testing.assert_allclose(apsl.rest_areas(positions, [[0, 1, 2], [2, 0, 3], [0, 1, 4]]), [6, 10, 0])

    def test_area_change_is_relative_unsigned_and_zero_without_rest_area(self):
        triangles = [[0, 1, 2]] * 5
        change = apsl.area_change(CORNER, triangles, [0.5, 0.25, 1.0, 0.0, -1.0])
        np.testing.assert_allclose(change, [0, 1, 0.5, 0, 0])

    def test_devices_are_numbered_in_order(self):
        found = apsl.devices()
        self.assertEqual([entry.number for entry in found], list(range(len(found))))
        self.assertTrue(found)
        self.assertTrue(all(entry.name and entry.compute_units > 0 and entry.memory > 0 for entry in found))
        self.assertIn(device(), found)

    def test_options_are_resolved(self):
        made = limiter(ONE_TRIANGLE, 3, execution="many_groups", warm_start_sub_steps=2)
        self.assertEqual((made.options["execution"], made.options["warm_start_sub_steps"]), ("many_groups", 2))
        self.assertGreater(made.options["work_group_size"], 0)
        self.assertGreater(made.scratch_bytes, limiter(ONE_TRIANGLE, 3, execution="many_groups").scratch_bytes)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
