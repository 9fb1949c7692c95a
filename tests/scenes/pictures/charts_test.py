#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""The charts on made-up reports and benchmark results: what is drawn where, and what goes wrong in one line."""

import contextlib
import importlib
import io
import json
import os
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema
import numpy as np
from PIL import Image

from made_up_results import COPY, benchmark_results, measurement, report

PROJECT = Path(__file__).resolve().parents[3]
CHARTS = PROJECT / "bench" / "charts"
CURVES, KERNELS = (CHARTS / f"{name}.py" for name in ("area_change_curves", "kernel_charts"))
sys.path.insert(0, str(CHARTS))
BLUE, VERMILLION, GREEN = (0, 114, 178), (213, 94, 0), (0, 158, 115)


def run(script, *arguments):
    """The script inside this process: matplotlib is slow to load, and errors are many."""
    module = importlib.import_module(script.stem)
    said, complained = io.StringIO(), io.StringIO()
    with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
        code = module.exit_code_of(lambda _: module.run([str(argument) for argument in arguments]))
    return subprocess.CompletedProcess(arguments, code, said.getvalue(), complained.getvalue())


def run_command(script, *arguments, **environment):
    """The script as a user starts it."""
    return subprocess.run([script, *map(str, arguments)], capture_output=True, text=True, timeout=100,
                          env={**os.environ, **environment})


def pixels_of(path, colour):
    """(rows, columns) of the pixels that have exactly this colour."""
    with Image.open(path) as picture:
        return np.nonzero((np.asarray(picture.convert("RGB")) == colour).all(axis=2))


class Folder(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)

    def write(self, name, content):
        path = self.folder / name
        path.write_text(content if isinstance(content, str) else json.dumps(content))
        return path

    def draw(self, script, *arguments):
        done = run_command(script, *arguments)
        self.assertEqual((done.returncode, done.stderr), (0, ""))

    def assert_one_line_error(self, done, *parts):
        self.assertEqual(done.returncode, 2, done.stdout + done.stderr)
        self.assertEqual(len(done.stderr.strip().splitlines()), 1, done.stderr)
        for part in parts:
            self.assertIn(part, done.stderr)


class AreaChangeCurves(Folder):
    def test_curves_lie_in_the_order_of_their_values_on_a_logarithmic_axis(self):
        names = [self.write(f"{value}.json", report([value] * 50)) for value in (1.0, 0.1, 0.01)]
        out = self.folder / "curves.png"
        self.draw(CURVES, *names, "--labels", "off", "on", "stand-alone", "--out", out)
        with Image.open(out) as picture:
            self.assertEqual(picture.size[0], 1200)
        # The median row is the curve's: it is far longer than its line in the legend.
        off, on, alone = (float(np.median(pixels_of(out, colour)[0])) for colour in (BLUE, VERMILLION, GREEN))
        self.assertLess(off, on)
        self.assertAlmostEqual(on - off, alone - on, delta=3)  # a factor of ten each: equal distances

    def test_rest_and_frames_that_are_not_finite_are_passed_over(self):
        whole = self.write("whole.json", report([0.0] + [0.05] * 99))
        broken = self.write("broken.json", report([0.0] + [0.05] * 49 + [None] * 50, status="diverged"))
        for name, path in (("a.png", whole), ("b.png", broken)):
            self.draw(CURVES, path, "--labels", "run", "--out", self.folder / name)
        ends = [np.percentile(pixels_of(self.folder / name, BLUE)[1], 60) for name in ("a.png", "b.png")]
        self.assertLess(ends[1], ends[0])

    def test_errors(self):
        good, out = self.write("good.json", report([0.1, 0.2])), self.folder / "c.png"
        self.assert_one_line_error(run(CURVES, self.folder / "no.json", "--out", out), "no.json", "cannot be read")
        self.assert_one_line_error(run(CURVES, self.write("x.json", "{"), "--out", out), "x.json", "not JSON")
        self.assert_one_line_error(run(CURVES, self.write("y.json", {"frames": [{}]}), "--out", out), "y.json")
        self.assert_one_line_error(run(CURVES, self.write("z.json", report([])), "--out", out), "no frame")
        self.assert_one_line_error(run(CURVES, self.write("n.json", report([None])), "--out", out), "not finite")
        self.assert_one_line_error(run(CURVES, good, "--labels", "a", "b", "--out", out), "--labels")
        self.assert_one_line_error(run(CURVES, good, "--out", self.folder / "c.jpg"), ".png")
        self.assert_one_line_error(run(CURVES, good, "--out", good / "c.png"), "cannot be written")
        self.assertFalse(out.exists())

    def test_missing_matplotlib_is_named(self):
        self.write("matplotlib.py", "raise ImportError('No module named matplotlib')")
        done = run_command(CURVES, "a", "--out", "b.png", PYTHONPATH=str(self.folder))
        self.assert_one_line_error(done, "apt-get install python3-matplotlib")


class KernelCharts(Folder):
    def test_made_up_results_fit_the_schema(self):
        schema = json.loads((PROJECT / "docs" / "benchmark.schema.json").read_text())
        jsonschema.Draft202012Validator.check_schema(schema)
        jsonschema.validate(benchmark_results(), schema)
        nameless = measurement("kernel", None, "ours", 8, 1.0)
        with self.assertRaises(jsonschema.ValidationError):
            jsonschema.validate([nameless], schema)

    def test_all_three_charts_are_drawn(self):
        self.draw(KERNELS, self.write("results.json", benchmark_results()), "--out", self.folder / "charts")
        names = sorted(path.name for path in (self.folder / "charts").iterdir())
        self.assertEqual(names, ["copy_bandwidth.png", "cost_breakdown.png", "time_against_size.png"])
        for name in names:
            with Image.open(self.folder / "charts" / name) as picture:
                self.assertEqual(picture.size[0], 1200)
                self.assertGreater(len(picture.convert("RGB").getcolors(1 << 20)), 20)

    def test_bars_are_as_long_as_the_share_of_copy_bandwidth(self):
        results = [measurement("kernel", name, "ours", 1000, 1e-9 * 5e6 / (COPY * share), 5e6)
                   for name, share in (("full", 1.0), ("half", 0.5))]
        done = run(KERNELS, self.write("results.json", results), "--out", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("time_against_size.png left out", done.stderr)
        rows, columns = pixels_of(self.folder / "copy_bandwidth.png", BLUE)
        lengths = sorted({np.ptp(columns[rows == row]) for row in rows})
        self.assertAlmostEqual(lengths[0] / lengths[-1], 0.5, delta=0.02)

    def test_parts_of_the_cost_breakdown_are_as_long_as_their_times(self):
        times = (("CG", 3e-3), ("rest", 1e-3))
        results = [measurement("phase", name, "ours", 1000, seconds) for name, seconds in times]
        done = run(KERNELS, self.write("results.json", results), "--out", self.folder)
        self.assertEqual(done.returncode, 0, done.stderr)
        wide, narrow = (len(pixels_of(self.folder / "cost_breakdown.png", colour)[0]) for colour in (BLUE, VERMILLION))
        self.assertAlmostEqual(wide / narrow, 3.0, delta=0.25)

    def test_one_method_on_two_devices_must_be_asked_for(self):
        results = [measurement("cg_iteration", None, "ours", 1000, 1e-3, device=device) for device in ("A", "B")]
        path = self.write("results.json", results)
        self.assert_one_line_error(run(KERNELS, path, "--out", self.folder), "2 devices (A, B)", "--device")
        for device in ("A", "all"):
            self.assertEqual(run(KERNELS, path, "--device", device, "--out", self.folder).returncode, 0)

    def test_errors(self):
        def broken(**changes):
            results = benchmark_results()
            results[1].update(changes)
            return run(KERNELS, self.write("results.json", results), "--out", self.folder / "charts")
        self.assert_one_line_error(broken(median_seconds=0), "measurement 1", "median_seconds")
        self.assert_one_line_error(broken(median_seconds="fast"), "measurement 1", "median_seconds", "'fast'")
        self.assert_one_line_error(broken(quantity="speed"), "measurement 1", "quantity")
        self.assert_one_line_error(broken(quantity="kernel", name=None), "measurement 1", "name")
        self.assert_one_line_error(broken(device=None), "measurement 1", "device")
        self.assert_one_line_error(broken(error=-1), "measurement 1", "error")
        self.assert_one_line_error(run(KERNELS, self.write("o.json", {}), "--out", self.folder), "expected a list")
        self.assert_one_line_error(run(KERNELS, self.write("e.json", []), "--out", self.folder), "no measurement")
        good = self.write("good.json", benchmark_results())
        self.assert_one_line_error(run(KERNELS, good, "--methods", "none", "--out", self.folder), "no measurement")
        self.assert_one_line_error(run(KERNELS, good, "--triangles", "5", "--out", self.folder), "--triangles 5")
        self.assertFalse((self.folder / "charts").exists())


if __name__ == "__main__":
    unittest.main()
