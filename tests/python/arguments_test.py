# SPDX-License-Identifier: MIT
"""What arguments are taken, and the line that refuses the rest."""

import pickle
import sys
import unittest
import warnings
from decimal import Decimal

import numpy as np

import apsl
from cloth import CORNER, ONE_TRIANGLE, Grid, device, limiter


class Taken(unittest.TestCase):
    def test_any_layout_of_the_same_numbers_gives_the_same_bytes(self):
        cloth = Grid(6)
        cloth.rest_areas = cloth.rest_areas.astype(np.float32)
        expected = limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays())[0].tobytes()
        variants = {
            "64 bits": [array.astype(np.float64) for array in cloth.arrays()],
            "column by column": [np.asfortranarray(array) for array in cloth.arrays()],
            "with gaps": [np.repeat(array, 2, axis=0)[::2] for array in cloth.arrays()],
            "backwards": [array[::-1].copy()[::-1] for array in cloth.arrays()],
            "other byte order": [array.astype(">f4") for array in cloth.arrays()],
            "lists": [array.tolist() for array in cloth.arrays()],
        }
        for name, arrays in variants.items():
            for triangles in (cloth.triangles.astype(np.uint8), cloth.triangles.tolist(),
                              np.asfortranarray(cloth.triangles)):
                with self.subTest(name, triangles=type(triangles)):
                    limited, _ = limiter(triangles, np.int64(cloth.vertex_count)).limit(*arrays)
                    self.assertEqual(limited.tobytes(), expected)

    def test_arguments_stay_as_they_were_and_the_result_is_new(self):
        cloth = Grid(6)
        given = [array.copy() for array in cloth.arrays()]
        made = limiter(cloth.triangles, cloth.vertex_count)
        first, _ = made.limit(*cloth.arrays())
        for before, after in zip(given, cloth.arrays()):
            np.testing.assert_array_equal(before, after)
        kept = first.copy()
        made.limit(*cloth.arrays(), sub_steps=1)
        np.testing.assert_array_equal(first, kept)
        self.assertEqual((first.dtype, first.shape), (np.float32, cloth.positions.shape))
        self.assertTrue(first.flags["C_CONTIGUOUS"] and first.flags["WRITEABLE"])

    def test_numpy_scalars_are_what_they_hold(self):
        arguments = CORNER, 64 * CORNER, [1, 1, 1], [0.5]
        made = limiter(ONE_TRIANGLE, 3)
        for named in [
            {"enabled": True}, {"enabled": False}, {"sub_steps": 3}, {"max_iterations": 7}, {"adaptive_threshold": 2},
            {"time_step": 0.25}, {"time_step": 1}, {"regularization": 2}, {"regularization": 1.5}, {"tolerance": 0.5},
            {"target_area_change": 0.25}, {"first_regularization": 4.0}, {"stepping": "whole_step"},
        ]:
            (name, plain), = named.items()
            types = {bool: [np.bool_], str: [np.str_],
                     int: [np.int8, np.uint8, np.int16, np.uint32, np.int64, np.uint64, np.intp],
                     float: [np.float16, np.float32, np.float64, np.longdouble]}[type(plain)]
            expected, stats = made.limit(*arguments, **named)
            for value in [kind(plain) for kind in types] + [np.array(plain)]:
                with self.subTest(name, value=repr(value), type=type(value)):
                    got, got_stats = made.limit(*arguments, **{name: value})
                    self.assertEqual(got.tobytes(), expected.tobytes())
                    self.assertEqual(got_stats, stats)

    def test_numpy_scalars_as_options(self):
        options = {"work_group_size": np.uint16(1), "regularization_per_triangle": np.True_,
                   "warm_start_sub_steps": np.int64(2), "bound_interval": np.array(3), "matrix": np.str_("consistent")}
        made = limiter(ONE_TRIANGLE, np.uint8(3), **options)
        for name, value in options.items():
            self.assertEqual(made.options[name], value)
        number = np.int64(device().number)
        self.assertGreater(apsl.StrainLimiter(ONE_TRIANGLE, np.array(3), number).scratch_bytes, 0)

    def test_anchors_of_any_type_of_integers_are_the_same(self):
        anchors, lengths = np.array([[2, 0], [0, 2], [1, 1]]), np.array([[0, 0], [1.25, 2], [0.25, 2]])
        made = limiter(ONE_TRIANGLE, 3, integrates=True, tethers_per_vertex=2)
        arrays = CORNER, [[0, 0, 0], [64, 0, 0], [0, 0, 0]], [0, 1, 0], [0]
        expected = made.step(*arrays, tether_anchors=anchors.astype(np.uint32), tether_lengths=lengths)[0]
        np.testing.assert_allclose(expected, [[0, 0, 0], [1.25, 0, 0], [0, 1, 0]], atol=1e-5)
        kinds = [anchors.astype(kind) for kind in (np.uint8, np.int16, np.int64, np.uint64, ">u4", ">i4")]
        for variant in [*kinds, anchors.tolist(), np.asfortranarray(anchors, np.uint32),
                        np.repeat(anchors.astype(np.uint32), 2, axis=1)[:, ::2]]:
            with self.subTest(getattr(variant, "dtype", list)):
                got = made.step(*arrays, tether_anchors=variant, tether_lengths=np.asfortranarray(lengths))[0]
                self.assertEqual(got.tobytes(), expected.tobytes())

    def test_every_parameter_is_taken_at_its_default(self):
        cloth = Grid(6)
        made = limiter(cloth.triangles, cloth.vertex_count)
        defaults = made.default_parameters()
        self.assertEqual(made.limit(*cloth.arrays())[0].tobytes(), made.limit(*cloth.arrays(), **defaults)[0].tobytes())
        # Where options ask for them; there is no default.
        arrays = {"rest_shapes", "contacts", "rest_hinges", "accelerations", "tether_anchors", "tether_lengths"}
        self.assertEqual(set(defaults) | arrays, set(apsl.Parameters.__annotations__))

    def test_every_resolved_option_is_taken(self):
        options = limiter(ONE_TRIANGLE, 3).options
        self.assertEqual(limiter(ONE_TRIANGLE, 3, **options).options, options)
        self.assertEqual(set(options), set(apsl.Options.__annotations__))


class Refused(unittest.TestCase):
    def setUp(self):
        self.limiter = limiter(ONE_TRIANGLE, 3)
        self.arguments = {"positions": CORNER, "velocities": 0 * CORNER, "inverse_masses": [1, 1, 1],
                          "rest_areas": [0.5]}

    def refuse(self, line, call, *arguments, code="invalid_argument", **named):
        with self.assertRaises(apsl.Error) as caught:
            call(*arguments, **named)
        self.assertIn(line, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        self.assertEqual(caught.exception.code, code)

    def test_arrays(self):
        for name, value, line in [
            ("positions", CORNER[:2], "positions: got shape (2, 3), expected (3, 3)"),
            ("positions", CORNER[:, :2], "positions: got shape (3, 2), expected (3, 3)"),
            ("velocities", CORNER.ravel(), "velocities: got shape (9,), expected (3, 3)"),
            ("velocities", CORNER * 1j, "velocities: got dtype complex64, expected an array of real numbers"),
            ("inverse_masses", [[1, 1, 1]], "inverse_masses: got shape (1, 3), expected (3,)"),
            ("inverse_masses", [True] * 3, "inverse_masses: got dtype bool, expected an array of real numbers"),
            ("rest_areas", ["a"], "rest_areas: got dtype <U1, expected an array of real numbers"),
            ("rest_areas", 0.5, "rest_areas: got shape (), expected (1,)"),
            ("rest_areas", None, "rest_areas: got dtype object, expected an array of real numbers"),
        ]:
            with self.subTest(line):
                self.refuse(line, self.limiter.limit, **{**self.arguments, name: value})

    def test_numbers_that_32_bits_do_not_hold(self):
        large = np.zeros((3, 3))
        large[1, 2] = -1e39
        with warnings.catch_warnings():
            warnings.simplefilter("error")
            for name, value, line in [
                ("positions", large, "positions: got -1e+39 in row 1, expected numbers that 32 bits hold"),
                ("velocities", large.tolist(), "velocities: got -1e+39 in row 1, expected numbers that 32 bits hold"),
                ("inverse_masses", [1, 1, 3.5e38], "inverse_masses: got 3.5e+38 in row 2, expected numbers that"),
                ("rest_areas", [1e300], "rest_areas: got 1e+300 in row 0, expected numbers that 32 bits hold"),
            ]:
                with self.subTest(line):
                    self.refuse(line, self.limiter.limit, **{**self.arguments, name: value})
            # What is not finite from the start is what the limiter says of it.
            for value in (np.inf, np.nan):
                _, stats = self.limiter.limit(**{**self.arguments, "velocities": np.full((3, 3), value)})
                self.assertEqual(stats.status, "diverged")
            self.limiter.limit(**{**self.arguments, "velocities": np.full((3, 3), 3.4e38)})

    def test_arrays_that_the_limiter_was_not_made_for(self):
        for name, option in [("rest_shapes", "limits_stretch"), ("contacts", "keeps_contacts"),
                             ("rest_hinges", "bends"), ("accelerations", "acceleration_per_vertex"),
                             ("tether_anchors", "tethers_per_vertex"), ("tether_lengths", "tethers_per_vertex")]:
            self.refuse(f"{name}: got ndarray, expected nothing (limiter made without {option})", self.limiter.limit,
                        **self.arguments, **{name: np.zeros((1, 4))})

    def test_parameters(self):
        for named, line in [
            ({"sub_steps": 3.5}, "sub_steps: got 3.5, expected an integer"),
            ({"sub_steps": True}, "sub_steps: got True, expected an integer"),
            ({"sub_steps": 2**31}, "sub_steps: got 2147483648, expected an integer"),
            ({"sub_steps": -1}, "sub_steps"),
            ({"sub_steps": np.True_}, "sub_steps: got True, expected an integer"),
            ({"sub_steps": np.float32(3)}, "sub_steps: got 3.0, expected an integer"),
            ({"sub_steps": np.float32(3.5)}, "sub_steps: got 3.5, expected an integer"),
            ({"sub_steps": np.array(3.5)}, "sub_steps: got 3.5, expected an integer"),
            ({"sub_steps": np.array([3])}, "sub_steps: got array([3]), expected an integer"),
            ({"sub_steps": np.int64(2**31)}, "sub_steps: got 2147483648, expected an integer"),
            ({"sub_steps": Decimal("3.5")}, "sub_steps: got Decimal('3.5'), expected an integer"),
            ({"sub_steps": None}, "sub_steps: got None, expected an integer"),
            ({"time_step": np.True_}, "time_step: got True, expected a number"),
            ({"time_step": np.complex64(1)}, "time_step: got (1+0j), expected a number"),
            ({"time_step": np.array([0.1])}, "time_step: got array([0.1]), expected a number"),
            ({"time_step": np.float64("nan")}, "time_step is nan"),
            ({"time_step": 1e300}, "time_step is inf"),
            ({"enabled": 1}, "enabled: got 1, expected True or False"),
            ({"enabled": np.int64(1)}, "enabled: got 1, expected True or False"),
            ({"enabled": None}, "enabled: got None, expected True or False"),
            ({"enabled": np.array([True])}, "enabled: got array([ True]), expected True or False"),
            ({"stepping": np.int32(1)}, "stepping: got 1, expected one of"),
            ({"time_step": "1"}, "time_step: got '1', expected a number"),
            ({"time_step": 0}, "time_step"),
            ({"regularization": 0.9}, "regularization"),
            ({"regularization": [1.2]}, "regularization: got [1.2], expected a number"),
        ]:
            with self.subTest(line):
                self.refuse(line, self.limiter.limit, **self.arguments, **named)
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'sub_step', expected .*sub_steps"):
            self.limiter.limit(**self.arguments, sub_step=3)

    def test_the_limiter_stays_usable(self):
        self.refuse("time_step", self.limiter.limit, **self.arguments, time_step=-1)
        self.assertEqual(self.limiter.limit(**self.arguments)[1].status, "ok")

    def test_a_map_of_regularization_where_it_is_compiled_in(self):
        mapped = limiter(ONE_TRIANGLE, 3, regularization_per_triangle=True)
        self.refuse("regularization: got nothing, expected an array", mapped.limit, **self.arguments)
        self.refuse("regularization: got shape (2,), expected (1,)", mapped.limit, **self.arguments,
                    regularization=[2, 2])

    def test_tethers(self):
        made = limiter(ONE_TRIANGLE, 3, integrates=True, tethers_per_vertex=2)
        anchors, lengths = np.zeros((3, 2), np.uint32), np.ones((3, 2), np.float32)
        good = {**self.arguments, "tether_anchors": anchors, "tether_lengths": lengths}
        for name, value, line in [
            ("tether_anchors", anchors[:2], "tether_anchors: got shape (2, 2), expected (3, 2)"),
            ("tether_anchors", anchors[:, :1], "tether_anchors: got shape (3, 1), expected (3, 2)"),
            ("tether_anchors", anchors.ravel(), "tether_anchors: got shape (6,), expected (3, 2)"),
            ("tether_anchors", lengths, "tether_anchors: got dtype float32, expected an array of integers"),
            ("tether_anchors", anchors > 0, "tether_anchors: got dtype bool, expected an array of integers"),
            ("tether_anchors", None, "tether_anchors: got dtype object, expected an array of integers"),
            ("tether_anchors", [[0, 0], [0, -1], [0, 0]], "tether_anchors: got vertex -1 in row 1, expected 0 to"),
            ("tether_anchors", [[0, 0], [0, 0], [2**32, 0]], "tether_anchors: got vertex 4294967296 in row 2"),
            ("tether_lengths", lengths[:, :1], "tether_lengths: got shape (3, 1), expected (3, 2)"),
            ("tether_lengths", lengths[0], "tether_lengths: got shape (2,), expected (3, 2)"),
            ("tether_lengths", [["a"] * 2] * 3, "tether_lengths: got dtype <U1, expected an array of real numbers"),
        ]:
            with self.subTest(line):
                self.refuse(line, made.step, **{**good, name: value})
        for name in ("tether_anchors", "tether_lengths"):
            self.refuse(f"{name}: got nothing, expected an array (limiter made with tethers_per_vertex)", made.step,
                        **{key: value for key, value in good.items() if key != name})
            self.refuse(f"{name}: got {type(good[name]).__name__}, expected nothing (limiter made without tethers_per_vertex)",
                        self.limiter.limit, **self.arguments, **{name: good[name]})
        self.refuse("tethers_per_vertex is 1, which needs integrates", limiter, ONE_TRIANGLE, 3, tethers_per_vertex=1)
        self.refuse("tethers_per_vertex is 5, expected a whole number >= 0 and <= 4", limiter, ONE_TRIANGLE, 3,
                    integrates=True, tethers_per_vertex=5)
        self.refuse("tethers_per_vertex: got True, expected an integer", limiter, ONE_TRIANGLE, 3, integrates=True,
                    tethers_per_vertex=True)
        self.assertEqual(made.step(**good)[2].status, "ok")  # still usable

    def test_what_tethers_are_made_of(self):
        good = {"rest_positions": CORNER, "triangles": ONE_TRIANGLE, "pinned": [0], "per_vertex": 1}
        for named, line in [
            ({"rest_positions": CORNER.ravel()}, "rest_positions: got shape (9,), expected (vertices, 3)"),
            ({"rest_positions": CORNER * np.nan}, "rest_positions of vertex 0 is not finite"),
            ({"triangles": [[0, 1, 2.5]]}, "triangles: got dtype float64, expected an array of integers"),
            ({"pinned": [0.0]}, "pinned: got dtype float64, expected an array of integers"),
            ({"pinned": [True, False, False]}, "pinned: got dtype bool, expected an array of integers"),
            ({"pinned": 0}, "pinned: got shape (), expected (rows,)"),
            ({"pinned": [[0]]}, "pinned: got shape (1, 1), expected (rows,)"),
            ({"pinned": [0, -1]}, "pinned: got vertex -1 in row 1, expected 0 to 4294967295"),
            ({"pinned": [3]}, "pinned vertex 3, expected one below 3"),
            ({"per_vertex": 0}, "per_vertex is 0, expected a whole number from 1 to 4"),
            ({"per_vertex": -1}, "per_vertex: got -1, expected an integer"),
            ({"per_vertex": 1.0}, "per_vertex: got 1.0, expected an integer"),
            ({"stretch": 0}, "stretch is 0"),
            ({"stretch": np.nan}, "stretch is nan"),
            ({"stretch": "1"}, "stretch: got '1', expected a number"),
        ]:
            with self.subTest(line):
                self.refuse(line, apsl.tethers_to_pins, **{**good, **named})
        self.refuse("names vertex 3", apsl.tethers_to_pins, CORNER, [[0, 1, 3]], [0], 1, code="invalid_mesh")
        self.refuse("pinned vertex 3, expected one below 3", apsl.pinned_piece_count, ONE_TRIANGLE, 3, [3])
        self.refuse("pinned: got dtype float64", apsl.pinned_piece_count, ONE_TRIANGLE, 3, [0.5])
        self.refuse("vertex_count: got -3, expected an integer", apsl.pinned_piece_count, ONE_TRIANGLE, -3, [])

    def test_triangles(self):
        for triangles, line in [
            ([[0, 1, 2.5]], "triangles: got dtype float64, expected an array of integers"),
            ([0, 1, 2], "triangles: got shape (3,), expected (triangles, 3)"),
            ([[0, 1, 2], [0, 1, -1]], "triangles: got vertex -1 in triangle 1"),
            ([[0, 1, 2**32]], "triangles: got vertex 4294967296 in triangle 0"),
        ]:
            with self.subTest(line):
                self.refuse(line, limiter, triangles, 3)
        self.refuse("names vertex 3", limiter, [[0, 1, 3]], 3, code="invalid_mesh")
        self.refuse("triangle 0", limiter, [[0, 1, 1]], 3, code="invalid_mesh")
        self.refuse("triangles", limiter, np.zeros((0, 3), int), 3, code="invalid_mesh")

    def test_limiters(self):
        self.refuse("vertex_count: got -3, expected an integer", limiter, ONE_TRIANGLE, -3)
        self.refuse("matrix: got 'dense', expected one of 'consistent', 'printed'", limiter, ONE_TRIANGLE, 3,
                    matrix="dense")
        self.refuse("work_group_size", limiter, ONE_TRIANGLE, 3, work_group_size=3)
        self.refuse(f"device: got {len(apsl.devices())}, expected 0 to", apsl.StrainLimiter, ONE_TRIANGLE, 3,
                    device=len(apsl.devices()))
        self.refuse("device: got 'gpu', expected an integer", apsl.StrainLimiter, ONE_TRIANGLE, 3, device="gpu")
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'strides'"):
            limiter(ONE_TRIANGLE, 3, strides=4)

    def test_measures(self):
        self.refuse("triangles: got vertex 3 in triangle 0, expected 0 to 2", apsl.rest_areas, CORNER, [[0, 1, 3]])
        self.refuse("positions: got shape (3,), expected (vertices, 3)", apsl.rest_areas, [1, 2, 3], ONE_TRIANGLE)
        self.refuse("rest_areas: got shape (2,), expected (1,)", apsl.area_change, CORNER, ONE_TRIANGLE, [1, 1])

    def test_an_error_can_be_sent_to_another_process(self):
        error = pickle.loads(pickle.dumps(apsl.Error("line", "opencl", -5, "log")))
        self.assertEqual((str(error), error.code, error.opencl_code, error.build_log), ("line", "opencl", -5, "log"))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
