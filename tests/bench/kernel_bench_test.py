#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""apsl_kernel_bench at one tiny size: its results fit the schema, are right, and can be drawn and summed up.

Usage: kernel_bench_test.py APSL_KERNEL_BENCH PROJECT_FOLDER
"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema

program, project = Path(sys.argv[1]), Path(sys.argv[2])
CHARTS, SUMMARY = project / "bench/charts/kernel_charts.py", project / "bench/kernels/summary.py"
METHODS = ["consistent matrix_free", "consistent assembled_csr", "Eigen CG, 1 thread", "ViennaCL CG",
           "Eigen reference, float", "Eigen LDLT"]


def run(*arguments):
    return subprocess.run([str(argument) for argument in arguments], capture_output=True, text=True, timeout=250)


class KernelBench(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.results = cls.folder / "results.json"
        # 161 × 41 vertices make 12,800 triangles: more than one work-group takes, whatever the device.
        done = run(program, "--grids", "9x9,161x41", "--awkward-grids", "7x12", "--cloths", "3", "--repetitions", "3",
                   "--copy-megabytes", "8", "--out", cls.results)
        assert done.returncode == 0, done.stdout + done.stderr
        cls.rows = json.loads(cls.results.read_text())

    def of(self, quantity, method=None):
        return [row for row in self.rows if row["quantity"] == quantity and method in (None, row["method"])]

    def test_results_fit_the_schema(self):
        schema = json.loads((project / "docs/benchmark.schema.json").read_text())
        jsonschema.validate(self.rows, schema)

    def test_every_method_and_size_is_there(self):
        sizes = {128, 132, 12800}
        for method in METHODS[:2]:
            self.assertLessEqual(sizes, {row["triangles"] for row in self.of("filter_call", method)})
            # Differences of two small times may drown in noise and are then left out, but not everywhere.
            self.assertTrue(self.of("cg_iteration", method))
        for method in METHODS[2:4]:
            self.assertTrue(self.of("cg_iteration", method), method)
        self.assertEqual({row["triangles"] for row in self.of("filter_call", "Eigen LDLT")}, {128, 12800})
        self.assertEqual([row["triangles"] for row in self.of("filter_call", "3 cloths of 2,048")], [3 * 2048])

    def test_what_was_timed_is_right(self):
        for row in self.of("cg_iteration"):
            # 32-bit positions and 16-bit gradients; the residual is what 8 iterations leave of it, for everyone.
            self.assertLess(row["error"], 2e-3, row["method"])
            others = [other["residual"] for other in self.of("cg_iteration") if other["triangles"] == row["triangles"]]
            self.assertLess(row["residual"], 1.0)
            self.assertLess(max(others) - min(others), 1e-2 * max(others))
        for row in self.of("filter_call"):
            # The direct solver finds another (the exact) end of each solve.
            self.assertLess(row["error"], 0.5 if row["method"] == "Eigen LDLT" else 2e-3, row["method"])

    def test_every_kernel_with_triangles_to_move_has_its_bytes_counted(self):
        small = {"begin_solve", "end_call", "finish_solve", "set_parameters", "filter_in_one_group"}
        names = {row["name"] for row in self.of("kernel")}
        self.assertIn("cg_update", names)
        for row in self.of("kernel"):
            self.assertEqual(row["bytes_moved"] is None, row["name"] in small, row["name"])
            self.assertGreater(row["copy_gb_per_second"], 0.0)

    def test_phases_add_up_to_the_call(self):
        for call in self.of("filter_call", METHODS[0]):
            phases = [row for row in self.of("phase", METHODS[0]) if row["triangles"] == call["triangles"]]
            if any(row["name"] == "between kernels" for row in phases):
                total = sum(row["median_seconds"] for row in phases)
                self.assertAlmostEqual(total / call["median_seconds"], 1.0, places=6)

    def test_charts_and_summary(self):
        done = run("/usr/bin/python3", CHARTS, self.results, "--methods", *METHODS, "--out", self.folder / "charts")
        self.assertEqual((done.returncode, done.stderr), (0, ""))
        self.assertEqual(len(list((self.folder / "charts").iterdir())), 3)
        done = run("/usr/bin/python3", SUMMARY, self.results)
        self.assertEqual(done.returncode, 0, done.stderr)
        self.assertIn("from 2,000 triangles up", done.stdout)
        self.assertIn("not measured: no cg_iteration of Eigen CG, 1 thread at 131,072 triangles", done.stdout)

    def test_errors(self):
        for arguments in (["--grids", "9by9"], ["--grids", "1x9"], ["--repetitions", "0"], ["--platform", "no such"],
                          ["--filter", "no such benchmark"], ["--nonsense"]):
            done = run(program, "--copy-megabytes", "1", "--out", self.folder / "none.json", *arguments)
            self.assertEqual(done.returncode, 2, (arguments, done.stdout + done.stderr))
        self.assertFalse((self.folder / "none.json").exists())


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
