#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The example of scenes/embedded as its reader runs it: on both kinds of queue, its trace, its host's waits.

Usage: embedded_example_test.py EMBEDDED_CLOTH ITS_GATED TRACED_CLOTH ITS_GATED SCENES_EMBEDDED
A gated one is the same program, its calls counted and its first kernel held back (gated_calls.cpp).
"""
import json
import os
import re
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import numpy as np
from vtkmodules.util.numpy_support import vtk_to_numpy
from vtkmodules.vtkIOXML import vtkXMLPolyDataReader

program, gated, traced, gated_traced, source = (Path(argument) for argument in sys.argv[1:])
GRID, FRAMES, WIDTH = 33, 40, 1.5
STAGES = ["touch_sphere", "step"]
REST_STATE = ["rest_areas", "rest_shapes", "rest_hinges"]
SPHERE_RADIUS, THICKNESS = 0.3, 0.005
HOST, DEVICE = 1, 2  # rows of the trace


def run(executable, folder, *options, frames=FRAMES, **environment):
    """What the program printed; it leaves frame_N.vtp in `folder`."""
    return run_with(executable, "--out", folder, *options, frames=frames, **environment)


def run_with(executable, *options, frames, **environment):
    command = [executable, "--grid", str(GRID), "--frames", str(frames), *options]
    done = subprocess.run(command, capture_output=True, text=True, env={**os.environ, **environment}, timeout=60)
    if done.returncode != 0:
        raise AssertionError(f"{command} ended with {done.returncode}: {done.stderr}")
    return done.stdout


def read_surface(folder, frames=FRAMES):
    """Points [V, 3], triangles [T, 3], area changes [T] of the last frame."""
    reader = vtkXMLPolyDataReader()
    reader.SetFileName(str(folder / f"frame_{frames - 1}.vtp"))
    reader.Update()
    surface = reader.GetOutput()
    return (vtk_to_numpy(surface.GetPoints().GetData()).astype(float),
            vtk_to_numpy(surface.GetPolys().GetConnectivityArray()).reshape(-1, 3),
            vtk_to_numpy(surface.GetCellData().GetArray("area_change")).astype(float))


def stated(printed):
    """Greatest area change, greatest stretch and status of the last frame, as the program printed them."""
    found = re.search(r"greatest area change (\S+), greatest stretch (\S+), .* status (\d+)", printed)
    return float(found[1]), float(found[2]), int(found[3])


def rest_points():
    along = np.linspace(-0.5 * WIDTH, 0.5 * WIDTH, GRID)
    z, x = np.meshgrid(along, along, indexing="ij")
    return np.stack([x, np.zeros_like(x), z], axis=-1).reshape(-1, 3)


def greatest_stretches(points, triangles):
    """Greatest singular value of each triangle's deformation gradient."""
    rest, now = ((at[triangles[:, 1:]] - at[triangles[:, :1]]).swapaxes(1, 2) for at in (rest_points(), points))
    return np.linalg.norm(now @ np.linalg.inv(rest[:, ::2]), ord=2, axis=(1, 2))  # at rest in the plane of x and z


def sphere_center(frames):
    """m, after that many frames: it swings once a second."""
    return np.array([0.0, -0.35, 0.15 * np.sin(2.0 * np.pi * frames / 60.0)])


class Example(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.folder = Path(cls.temporary.name)
        cls.printed = run(program, cls.folder / "in_order")
        cls.points, cls.triangles, cls.changes = read_surface(cls.folder / "in_order")

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def test_both_kinds_of_queue_give_the_same_bytes(self):
        out_of_order = run(program, self.folder / "out_of_order", "--out-of-order")
        self.assertIn("out of order", out_of_order)
        name = f"frame_{FRAMES - 1}.vtp"
        self.assertEqual((self.folder / "out_of_order" / name).read_bytes(),
                         (self.folder / "in_order" / name).read_bytes())
        self.assertEqual(stated(out_of_order), stated(self.printed))

    def test_cloth_lies_on_the_sphere_and_not_in_it(self):
        for frames in (15, 30, 45, 60):
            folder = self.folder / str(frames)
            run(program, folder, frames=frames)
            points, triangles, _ = read_surface(folder, frames=frames)
            center = sphere_center(frames)
            depth = SPHERE_RADIUS + THICKNESS - np.linalg.norm(points - center, axis=1)
            self.assertLess(depth.max(), 1e-5)
            self.assertGreater(np.count_nonzero(depth > -1e-5), 20)
            # Triangles are flat, and the cloth's thickness keeps their middles out too.
            self.assertGreater(np.linalg.norm(points[triangles].mean(axis=1) - center, axis=1).min(), SPHERE_RADIUS)

    def test_pins_stay_where_they_were_and_the_rest_falls(self):
        run(program, self.folder / "one", frames=1)
        first, *_ = read_surface(self.folder / "one", frames=1)
        for points in (first, self.points):
            np.testing.assert_allclose(points[:GRID], rest_points()[:GRID], rtol=0, atol=1e-6)
        self.assertLess(first[GRID:, 1].max(), 0.0)

    def test_what_is_stated_is_what_is_drawn(self):
        for frames, printed in ((5, run(program, self.folder / "air", frames=5)), (FRAMES, self.printed)):
            points, triangles, changes = read_surface(self.folder / ("air" if frames == 5 else "in_order"), frames)
            greatest_change, greatest_stretch, status = stated(printed)
            self.assertEqual(status, 0)
            self.assertGreater(greatest_change, 1e-4)
            self.assertAlmostEqual(changes.max(), greatest_change, delta=2e-5)
            self.assertAlmostEqual(greatest_stretches(points, triangles).max(), greatest_stretch, delta=1e-4)

    def test_area_and_stretch_are_held(self):
        for frames in (15, 30, 45, 60, 90):
            greatest_change, greatest_stretch, status = stated(run(program, self.folder / "held", frames=frames))
            self.assertEqual(status, 0)
            self.assertLess(greatest_change, 0.03)
            self.assertGreater(greatest_stretch, 1.05)  # it hangs, and the ceiling has something to hold
            self.assertLess(greatest_stretch, 1.13)

    def test_host_waits_for_nothing_before_the_end(self):
        for options in ([], ["--out-of-order"]):
            commands = []
            for frames in (1, 2, 4):
                calls = self.folder / "calls.json"
                run(gated, self.folder / "gated", *options, frames=frames, APSL_TEST_CALLS=str(calls))
                counted = json.loads(calls.read_text())
                for what in ("host_waits", "polls", "blocking_calls", "reads", "allocations", "releases", "builds"):
                    self.assertEqual(counted["frames"][what], 0, what)
                # All of it was queued before the first wait; then come the statistics and the picture.
                self.assertEqual(counted["rest"]["commands"], 0)
                self.assertGreater(counted["rest"]["host_waits"], 0)
                self.assertGreater(counted["rest"]["reads"], 1)
                commands.append(counted["frames"]["commands"])
            one_frame = commands[1] - commands[0]
            self.assertGreater(one_frame, len(STAGES))
            rest_state = commands[0] - one_frame
            self.assertIn(rest_state, (len(REST_STATE), 2 * len(REST_STATE)))  # kernels, in order markers behind them
            self.assertEqual(commands[2], rest_state + 4 * one_frame)

    def test_held_back_cloth_moves_alike(self):
        run(gated, self.folder / "held_back", APSL_TEST_CALLS=str(self.folder / "calls.json"))
        points, *_ = read_surface(self.folder / "held_back")
        np.testing.assert_array_equal(points, self.points)


class TraceFile(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        folder = Path(cls.temporary.name)
        cls.traces = {}
        for options in ((), ("--out-of-order",)):
            for executable in (traced, gated_traced):
                path = folder / "trace.json"
                run_with(executable, "--trace", path, *options, frames=3, APSL_TEST_CALLS=str(folder / "calls"))
                cls.traces[executable, options] = json.loads(path.read_text())

    @classmethod
    def tearDownClass(cls):
        cls.temporary.cleanup()

    def rows(self, trace):
        slices = [event for event in trace["traceEvents"] if event["ph"] == "X"]
        return [[event for event in slices if event["tid"] == row] for row in (HOST, DEVICE)]

    def test_is_chrome_s_format(self):
        for trace in self.traces.values():
            self.assertEqual(trace["displayTimeUnit"], "ms")
            names = {event["tid"]: event["args"]["name"] for event in trace["traceEvents"] if event["ph"] == "M"}
            self.assertEqual(names, {HOST: "host: enqueue", DEVICE: "device: queue"})
            for event in trace["traceEvents"]:
                self.assertIn(event["ph"], "MX")
                self.assertEqual(event["pid"], 1)
                if event["ph"] == "M":
                    self.assertEqual(set(event), {"ph", "pid", "tid", "name", "args"})
                    self.assertEqual(event["name"], "thread_name")
                else:
                    self.assertEqual(set(event), {"ph", "pid", "tid", "name", "ts", "dur", "args"})
                    self.assertIsInstance(event["ts"], float)
                    self.assertGreaterEqual(event["dur"], 0.0)
                    self.assertEqual(set(event["args"]), {"frame"})

    def test_rows_hold_every_stage_of_every_frame_in_order(self):
        for trace in self.traces.values():
            for row in self.rows(trace):
                self.assertEqual([(event["args"]["frame"], event["name"]) for event in row],
                                 [(frame, stage) for frame in range(3) for stage in STAGES])
                for event, following in zip(row, row[1:]):
                    self.assertGreaterEqual(following["ts"], event["ts"] + event["dur"] - 0.002)  # ns, rounded

    def test_no_stage_begins_before_the_host_began_to_queue_it(self):
        for trace in self.traces.values():
            host, device = self.rows(trace)
            shortest = min(event["dur"] for event in host)  # the clocks are known to half of this
            for queued, done in zip(host, device):
                self.assertGreaterEqual(done["ts"] + done["dur"], queued["ts"] - shortest)

    def test_device_never_waits_for_the_host_where_the_host_needs_nothing_of_it(self):
        # Held back, every command was queued before the device began: what gaps are left are the device's own.
        for options in ((), ("--out-of-order",)):
            host, device = self.rows(self.traces[gated_traced, options])
            shortest = min(event["dur"] for event in host)
            self.assertLess(host[-1]["ts"] + host[-1]["dur"], device[0]["ts"] + shortest)

    def test_is_drawn(self):
        script = source.parent / "pictures/draw_trace.py"
        folder = Path(self.temporary.name)
        (folder / "drawn.json").write_text(json.dumps(self.traces[traced, ()]))
        for trace, code, message in (("drawn.json", 0, ""), ("none.json", 2, "cannot be read")):
            done = subprocess.run([script, folder / trace, "--out", folder / "trace.png"], capture_output=True, text=True,
                                  timeout=60)
            self.assertEqual(done.returncode, code, done.stderr)
            self.assertIn(message, done.stderr)
        self.assertTrue((folder / "trace.png").read_bytes().startswith(b"\x89PNG"))


class Source(unittest.TestCase):
    def test_pipeline_is_short_enough_to_read(self):
        lines = sum(len((source / name).read_text().splitlines())
                    for name in ("embedded_cloth.cpp", "cloth.hpp", "touch_sphere.cl"))
        self.assertLess(lines, 250)

    def test_includes_nothing_of_ours_but_public_headers(self):
        own = {path.name for path in source.glob("*.hpp")}
        for path in (*source.glob("*.cpp"), *source.glob("*.hpp")):
            for name in re.findall(r'#include [<"]([^>"]+)[>"]', path.read_text()):
                ours = name.startswith("apsl/") or name in own
                self.assertTrue(ours or "/" not in name or name.split("/")[0] in ("CL", "CLI"), f"{path}: {name}")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1], verbosity=2)
