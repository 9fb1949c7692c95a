# SPDX-License-Identifier: MIT
"""Arrays that are on the device already: pyopencl's context, queue and arrays, or their handles, without a copy."""

import gc
import os
import subprocess
import sys
import unittest

import numpy as np
import pyopencl as cl
import pyopencl.array as cl_array

import apsl
from cloth import CORNER, ONE_TRIANGLE, Grid, device, limiter


def cl_device():
    """The tests' device, as pyopencl has it."""
    wanted = device()
    for platform in cl.get_platforms():
        for found in platform.get_devices():
            if (platform.name, found.name) == (wanted.platform, wanted.name):
                return found
    raise AssertionError(f"pyopencl does not see {wanted}")


CONTEXT = cl.Context([cl_device()])
QUEUE = cl.CommandQueue(CONTEXT)


def on_device(triangles, vertex_count, **options):
    return apsl.StrainLimiter(triangles, vertex_count, context=CONTEXT, **options)


def array(numbers):
    return cl_array.to_device(QUEUE, np.ascontiguousarray(numbers, np.float32))


class Same(unittest.TestCase):
    """The bytes and statistics of limit()."""

    def setUp(self):
        self.cloth = Grid(8)
        self.numbers = [np.asarray(each, np.float32) for each in self.cloth.arrays()]
        self.parameters = {"sub_steps": 6, "time_step": 1 / 50}
        self.expected, self.stats = limiter(self.cloth.triangles, self.cloth.vertex_count).limit(
            *self.numbers, **self.parameters)
        self.assertGreater(np.abs(self.expected - self.cloth.velocities).max(), 0.1)

    def made(self, **options):
        return on_device(self.cloth.triangles, self.cloth.vertex_count, **options)

    def check(self, velocities, stats):
        self.assertEqual(np.ascontiguousarray(velocities).tobytes(), self.expected.tobytes())
        self.assertEqual(stats, self.stats)

    def test_arrays(self):
        made = self.made()
        arrays = [array(each) for each in self.numbers]
        event = made.enqueue(QUEUE, *arrays, **self.parameters)
        self.assertIsInstance(event, cl.Event)
        stats = made.read_stats(QUEUE)
        self.assertEqual(event.command_execution_status, cl.command_execution_status.COMPLETE)
        self.check(arrays[1].get(), stats)
        for given, after in zip(self.numbers[::2], arrays[::2]):
            np.testing.assert_array_equal(given, after.get())

    def test_buffers_handles_and_offsets(self):
        before, behind = 5, 3  # floats that nobody may touch
        padded = [np.concatenate([np.full(before, 7), each.ravel(), np.full(behind, 7)]).astype(np.float32)
                  for each in self.numbers]
        whole = [array(each) for each in self.numbers]
        for name, place in {
            "buffers": lambda a, p: a.data,
            "handles": lambda a, p: a.data.int_ptr,
            "numpy's integers": lambda a, p: np.uint64(a.data.int_ptr),
            "a buffer and an offset": lambda a, p: (p.data, 4 * before),
            "a handle and an offset": lambda a, p: (p.data.int_ptr, np.int64(4 * before)),
            "part of an array": lambda a, p: p[before:p.size - behind].reshape(a.shape),
        }.items():
            with self.subTest(name):
                whole, parts = ([array(each) for each in group] for group in (self.numbers, padded))
                places = [place(*pair) for pair in zip(whole, parts)]
                made = apsl.StrainLimiter(self.cloth.triangles, self.cloth.vertex_count, context=CONTEXT.int_ptr)
                event = made.enqueue(QUEUE.int_ptr, *places, **self.parameters)
                stats = made.read_stats(QUEUE.int_ptr, wait_for=[event.int_ptr])
                if "part" in name or "offset" in name:
                    result = parts[1].get()
                    self.assertTrue((result[:before] == 7).all() and (result[-behind:] == 7).all())
                    self.check(result[before:-behind], stats)
                else:
                    self.check(whole[1].get(), stats)

    def test_layouts(self):
        positions, velocities, inverse_masses, rest_areas = self.numbers
        count, room = self.cloth.vertex_count, self.cloth.vertex_count + 9
        four = array(np.column_stack([positions, inverse_masses]))
        runs = array(np.pad(velocities.T, ((0, 0), (0, room - count))))
        made = self.made(position_stride=4, inverse_mass_stride=4, velocity_stride=1, velocity_component_stride=room)
        made.enqueue(QUEUE, four, runs[:, :count].T, four[:, 3], array(rest_areas), **self.parameters)
        stats = made.read_stats(QUEUE)
        result = runs.get()
        self.check(result[:, :count].T, stats)
        self.assertFalse(result[:, count:].any())
        self.assertEqual((made.options["position_stride"], made.options["positions_only"]), (4, False))

    def test_positions_alone(self):
        made = on_device(ONE_TRIANGLE, 3, positions_only=True)
        stretched = array(CORNER * [1.5, 1, 1])
        made.enqueue(QUEUE, stretched, None, array([0, 2, 0]), array([0.5]), regularization=1, sub_steps=1)
        self.assertLess(made.read_stats(QUEUE).max_area_change, 1e-5)
        np.testing.assert_allclose(stretched.get(), CORNER, atol=1e-4)

    def test_a_mesh_without_hinges_needs_none(self):
        made = on_device(ONE_TRIANGLE, 3, integrates=True, limits_stretch=True, bends=True)
        shapes = array(apsl.rest_shapes(CORNER, ONE_TRIANGLE))
        for hinges in ({}, {"rest_hinges": None}, {"rest_hinges": np.zeros((0, 2), np.float32)}):
            stretched = array(CORNER * [1.5, 1, 1])
            made.enqueue(QUEUE, stretched, array(np.zeros((3, 3))), array([0, 2, 0]), array([0.5]), rest_shapes=shapes,
                         stretch_ceiling=1.1, bending=1e-3, **hinges)
            self.assertLess(made.read_stats(QUEUE).max_area_change, 0.1)

    def test_an_array_for_each_triangle_and_whole_steps(self):
        cloth, count = self.cloth, len(self.cloth.triangles)
        options = {"limits_stretch": True, "stretch_ceiling_per_triangle": True, "integrates": True,
                   "keeps_contacts": True, "acceleration_per_vertex": True}
        numbers = {"rest_shapes": apsl.rest_shapes(cloth.positions, cloth.triangles),
                   "stretch_ceiling": np.linspace(1.1, 1.3, count),
                   "contacts": np.tile([0, 1, 0, -0.002, 0, 0, 0, 0.5], (cloth.vertex_count, 1)),
                   "accelerations": cloth.positions * [2, -1, 3]}
        settings = {**self.parameters, "acceleration": (0, -9.81, 0)}
        moved, limited, stats = limiter(cloth.triangles, cloth.vertex_count, **options).step(
            *self.numbers, **numbers, **settings)
        made, arrays = self.made(**options), [array(each) for each in self.numbers]
        made.enqueue(QUEUE, *arrays, **{name: array(each) for name, each in numbers.items()}, **settings)
        self.assertEqual(made.read_stats(QUEUE), stats)
        self.assertEqual([arrays[0].get().tobytes(), arrays[1].get().tobytes()], [moved.tobytes(), limited.tobytes()])

        regularization = np.linspace(1.05, 3, count)
        limited, stats = limiter(cloth.triangles, cloth.vertex_count, regularization_per_triangle=True).limit(
            *self.numbers, regularization=regularization, **self.parameters)
        made, arrays = self.made(regularization_per_triangle=True), [array(each) for each in self.numbers]
        made.enqueue(QUEUE, *arrays, regularization=array(regularization), **self.parameters)
        self.assertEqual(made.read_stats(QUEUE), stats)
        self.assertEqual(arrays[1].get().tobytes(), limited.tobytes())

    def test_tethers(self):
        cloth, options = self.cloth, {"integrates": True, "tethers_per_vertex": 2}
        anchors, lengths = apsl.tethers_to_pins(cloth.positions, cloth.triangles, cloth.pins, 2, stretch=0.9)
        moved, limited, stats = limiter(cloth.triangles, cloth.vertex_count, **options).step(
            *self.numbers, tether_anchors=anchors, tether_lengths=lengths, **self.parameters)
        free, _, _ = limiter(cloth.triangles, cloth.vertex_count, integrates=True).step(*self.numbers, **self.parameters)
        self.assertGreater(np.abs(moved - free).max(), 0.01)
        made, given = self.made(**options), cl_array.to_device(QUEUE, anchors)
        behind = cl_array.to_device(QUEUE, np.concatenate([[5], anchors.ravel()]).astype(np.uint32))
        for places in (given, given.data, given.data.int_ptr, (behind.data, 4), behind[1:].reshape(anchors.shape)):
            arrays = [array(each) for each in self.numbers]
            made.enqueue(QUEUE, *arrays, tether_anchors=places, tether_lengths=array(lengths), **self.parameters)
            self.assertEqual(made.read_stats(QUEUE), stats)
            self.assertEqual([arrays[0].get().tobytes(), arrays[1].get().tobytes()],
                             [moved.tobytes(), limited.tobytes()])

    def test_a_device_of_the_context(self):
        for given in (cl_device(), device(), device().number):
            self.assertGreater(self.made(device=given).scratch_bytes, 0)


class Queued(unittest.TestCase):
    def test_nothing_waits_but_read_stats(self):
        # A gate that opens only after enqueue has returned: what waits would wait for ever.
        cloth = Grid(6)
        expected, expected_stats = limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays())
        for properties in (0, cl.command_queue_properties.OUT_OF_ORDER_EXEC_MODE_ENABLE):
            queue = cl.CommandQueue(CONTEXT, properties=properties)
            made, arrays = on_device(cloth.triangles, cloth.vertex_count), [array(each) for each in cloth.arrays()]
            gate = cl.UserEvent(CONTEXT)
            event = made.enqueue(queue, *arrays, wait_for=[gate])
            self.assertNotEqual(event.command_execution_status, cl.command_execution_status.COMPLETE)
            gate.set_status(cl.command_execution_status.COMPLETE)
            self.assertEqual(made.read_stats(queue, wait_for=[event]), expected_stats)
            self.assertEqual(arrays[1].get().tobytes(), expected.tobytes())

    def test_what_is_queued_for_an_array_comes_first(self):
        cloth = Grid(6)
        expected, _ = limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays())
        made, arrays = on_device(cloth.triangles, cloth.vertex_count), [array(each) for each in cloth.arrays()]
        arrays[1].fill(0)
        gate, other = cl.UserEvent(CONTEXT), cl.CommandQueue(CONTEXT)
        arrays[1].add_event(
            cl.enqueue_copy(QUEUE, arrays[1].data, cloth.velocities, is_blocking=False, wait_for=[gate]))
        event = made.enqueue(other, *arrays)
        gate.set_status(cl.command_execution_status.COMPLETE)
        event.wait()
        self.assertEqual(arrays[1].get().tobytes(), expected.tobytes())

    def test_the_limiter_keeps_its_context_and_gives_it_back(self):
        context = cl.Context([cl_device()])

        def references():
            return context.get_info(cl.context_info.REFERENCE_COUNT)

        before = references()
        made = apsl.StrainLimiter(ONE_TRIANGLE, 3, context=context)
        self.assertGreater(references(), before)
        del made
        gc.collect()
        self.assertEqual(references(), before)
        cloth = Grid(6)
        queue = cl.CommandQueue(context)
        made = apsl.StrainLimiter(cloth.triangles, cloth.vertex_count, context=context)
        arrays = [cl_array.to_device(queue, np.asarray(each, np.float32)) for each in cloth.arrays()]
        del context
        event = made.enqueue(queue, *arrays)
        del made, arrays
        gc.collect()
        event.wait()

    def test_before_the_first_call_statistics_are_zero(self):
        self.assertEqual(on_device(ONE_TRIANGLE, 3).read_stats(QUEUE).sub_steps, 0)

    def test_without_pyopencl_handles_do(self):
        # clCreateContext and so on by ctypes, in a process that never imports pyopencl.
        script = os.path.join(os.path.dirname(__file__), "handles.py")
        result = subprocess.run([sys.executable, script], capture_output=True, text=True, timeout=100)
        self.assertEqual((result.returncode, result.stdout), (0, "the same bytes\n"), result.stderr)


class Refused(unittest.TestCase):
    def setUp(self):
        self.made = on_device(ONE_TRIANGLE, 3)
        self.arguments = {"queue": QUEUE, "positions": array(CORNER), "velocities": array(0 * CORNER),
                          "inverse_masses": array([1, 1, 1]), "rest_areas": array([0.5])}

    def refuse(self, line, call, *arguments, **named):
        with self.assertRaises(apsl.Error) as caught:
            call(*arguments, **named)
        self.assertIn(line, str(caught.exception))
        self.assertNotIn("\n", str(caught.exception))
        self.assertEqual(caught.exception.code, "invalid_argument")

    def test_what_a_call_cannot_use(self):
        other = cl.Context([cl_device()])
        expected = "expected a pyopencl Buffer or Array, or a handle as an integer"
        short = cl.Buffer(CONTEXT, cl.mem_flags.READ_WRITE, 35)
        for name, value, line in [
            ("queue", None, "queue: got NoneType, expected a pyopencl.CommandQueue, or a handle as an integer"),
            ("queue", CONTEXT, "queue: got Context, expected a pyopencl.CommandQueue"),
            ("queue", 0, "queue: got 0, expected a pyopencl.CommandQueue"),
            ("queue", True, "queue: got bool, expected a pyopencl.CommandQueue"),
            ("queue", cl.CommandQueue(other), "queue is of another context, expected the limiter's"),
            ("positions", CORNER, f"positions: got ndarray, {expected}"),
            ("positions", QUEUE, f"positions: got CommandQueue, {expected}"),
            ("velocities", None, f"velocities: got NoneType, {expected}"),
            ("velocities", -1, f"velocities: got -1, {expected}"),
            ("velocities", short, "buffers.velocities holds 35 bytes, expected at least 36 from offset 0 on"),
            ("velocities", (array(CORNER).data, 4), "buffers.velocities holds 36 bytes, expected at least 36 from"),
            ("velocities", (array(CORNER).data, 2), "buffers.velocities has offset 2, expected a multiple of 4"),
            ("velocities", (array(CORNER).data, -4), "expected a buffer and an offset in bytes"),
            ("velocities", (array(CORNER).data,), "expected a buffer and an offset in bytes"),
            ("velocities", cl.Buffer(other, cl.mem_flags.READ_WRITE, 36), "buffers.velocities is of another context"),
            ("velocities", cl.Buffer(CONTEXT, cl.mem_flags.READ_ONLY, 36), "buffers.velocities is CL_MEM_READ_ONLY"),
            ("positions", cl_array.zeros(QUEUE, (3, 3), np.float64), "positions: got dtype float64, expected float32"),
            ("positions", array(CORNER[:2]), "positions: got shape (2, 3), expected (3, 3)"),
            ("positions", array(CORNER.ravel()), "positions: got shape (9,), expected (3, 3)"),
            ("positions", array(np.zeros((3, 4))), "positions: got strides (16, 4) bytes, expected (12, 4)"),
            ("positions", array(CORNER).T, "positions: got strides (4, 12) bytes, expected (12, 4)"),
            ("inverse_masses", array([[1, 1, 1]]), "inverse_masses: got shape (1, 3), expected (3,)"),
            ("inverse_masses", array(np.ones(6))[::2], "inverse_masses: got strides (8,) bytes, expected (4,)"),
            ("rest_areas", array([1, 1]), "rest_areas: got shape (2,), expected (1,)"),
            ("wait_for", [QUEUE], "wait_for[0]: got CommandQueue, expected a pyopencl.Event"),
            ("wait_for", cl.UserEvent(CONTEXT), "wait_for: got UserEvent, expected a list of events"),
            ("wait_for", [cl.UserEvent(other)], "wait_list[0] is of another context"),
            ("time_step", -1, "time_step is -1"),
            ("sub_steps", 2.5, "sub_steps: got 2.5, expected an integer"),
            ("regularization", array([1]), "expected a number"),
        ]:
            with self.subTest(line):
                self.refuse(line, self.made.enqueue, **{**self.arguments, name: value})
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'sub_step', expected .*sub_steps"):
            self.made.enqueue(**self.arguments, sub_step=3)
        self.made.enqueue(**self.arguments).wait()  # still usable
        self.assertEqual(self.made.read_stats(QUEUE).status, "ok")

    def test_arrays_that_options_ask_for(self):
        made = on_device(ONE_TRIANGLE, 3, limits_stretch=True)
        self.refuse("rest_shapes: got nothing, expected an array (limiter made with limits_stretch)", made.enqueue,
                    **self.arguments, stretch_ceiling=1.1)
        self.refuse("rest_shapes: got shape (1, 3), expected (1, 4)", made.enqueue, **self.arguments,
                    rest_shapes=array([[1, 0, 0]]))
        self.refuse("buffers.velocities is given, but Options::positions_only is on",
                    on_device(ONE_TRIANGLE, 3, positions_only=True).enqueue, **self.arguments)

    def test_tethers(self):
        made = on_device(ONE_TRIANGLE, 3, integrates=True, tethers_per_vertex=2)
        anchors, lengths = np.zeros((3, 2), np.uint32), np.ones((3, 2), np.float32)
        good = {**self.arguments, "tether_anchors": cl_array.to_device(QUEUE, anchors), "tether_lengths": array(lengths)}
        short = cl.Buffer(CONTEXT, cl.mem_flags.READ_WRITE, 23)
        for name, value, line in [
            ("tether_anchors", cl_array.to_device(QUEUE, anchors.astype(np.int32)),
             "tether_anchors: got dtype int32, expected uint32"),
            ("tether_anchors", array(lengths), "tether_anchors: got dtype float32, expected uint32"),
            ("tether_anchors", cl_array.to_device(QUEUE, anchors[:2]), "tether_anchors: got shape (2, 2), expected (3, 2)"),
            ("tether_anchors", cl_array.to_device(QUEUE, np.zeros((3, 3), np.uint32)),
             "tether_anchors: got strides (12, 4) bytes, expected (8, 4)"),
            ("tether_anchors", anchors, "tether_anchors: got ndarray, expected a pyopencl Buffer or Array"),
            ("tether_anchors", short, "buffers.tether_anchors holds 23 bytes, expected at least 24"),
            ("tether_lengths", good["tether_anchors"], "tether_lengths: got dtype uint32, expected float32"),
            ("tether_lengths", array(lengths[:, 0]), "tether_lengths: got shape (3,), expected (3, 2)"),
            ("tether_lengths", short, "buffers.tether_lengths holds 23 bytes, expected at least 24"),
        ]:
            with self.subTest(line):
                self.refuse(line, made.enqueue, **{**good, name: value})
        for name in ("tether_anchors", "tether_lengths"):
            self.refuse(f"{name}: got nothing, expected an array (limiter made with tethers_per_vertex)", made.enqueue,
                        **{key: value for key, value in good.items() if key != name})
            self.refuse(f"{name}: got {type(good[name]).__name__}, expected nothing (limiter made without tethers_per_vertex)",
                        self.made.enqueue, **self.arguments, **{name: good[name]})
        made.enqueue(**good).wait()  # still usable

    def test_limiters(self):
        make = apsl.StrainLimiter
        self.refuse("context: got CommandQueue, expected a pyopencl.Context, or a handle as an integer", make,
                    ONE_TRIANGLE, 3, context=QUEUE)
        self.refuse("context: got 0, expected a pyopencl.Context", make, ONE_TRIANGLE, 3, context=0)
        self.refuse("device: got Context, expected a pyopencl.Device", make, ONE_TRIANGLE, 3, CONTEXT, context=CONTEXT)
        self.refuse("device: got 'gpu', expected an integer", make, ONE_TRIANGLE, 3, "gpu", context=CONTEXT)
        self.refuse("position_stride", make, ONE_TRIANGLE, 3, context=CONTEXT, position_stride=2)
        with self.assertRaisesRegex(TypeError, "unexpected keyword argument 'position_stride'"):
            limiter(ONE_TRIANGLE, 3, position_stride=4)
        self.refuse("limit: the limiter was made with a context, expected a call of enqueue()", self.made.limit,
                    CORNER, CORNER, [1, 1, 1], [0.5])
        self.refuse("step: the limiter was made with a context", self.made.step, CORNER, CORNER, [1, 1, 1], [0.5])
        without = limiter(ONE_TRIANGLE, 3)
        self.refuse("enqueue: the limiter was made without a context, expected StrainLimiter(…, context=…)",
                    without.enqueue, **self.arguments)
        self.refuse("read_stats: the limiter was made without a context", without.read_stats, QUEUE)

    def test_every_resolved_option_is_taken(self):
        options = self.made.options
        self.assertEqual(on_device(ONE_TRIANGLE, 3, **options).options, options)
        self.assertEqual(set(options), set(apsl.DeviceOptions.__annotations__))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
