#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""bench/gpu_bundle.sh and bench/gpu.sh with pocl in a GPU's place, all of it tiny.

Usage: gpu_script_test.py BUILD_FOLDER PROJECT_FOLDER
"""
import json
import os
import re
import statistics
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import jsonschema

build, project = Path(sys.argv[1]), Path(sys.argv[2])
PACK = project / "bench/gpu_bundle.sh"
DEVICE = 2  # the device's row of a trace
POCL = Path("/etc/OpenCL/vendors/pocl.icd").read_text().strip()
# One test of each program, and the smallest cloth that has an inner vertex.
TINY = ["--tests", "*nothing is *", "--grids", "3", "--copy-megabytes", "1"]


def run(*command, **environment):
    return subprocess.run([str(word) for word in command], capture_output=True, text=True, timeout=100,
                          env={**os.environ, **environment})


class GpuScript(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(temporary.cleanup)
        cls.folder = Path(temporary.name)
        cls.bundle = cls.folder / "bundle"
        packed = run(PACK, build, cls.bundle)
        assert packed.returncode == 0, packed.stdout + packed.stderr

    def measure(self, out, *options, driver=POCL, **environment):
        drivers = ["--driver", driver] if driver else []
        return run(self.bundle / "gpu.sh", *drivers, *options, self.bundle, self.folder / out, **environment)

    def summary(self, out):
        return json.loads((self.folder / out / "summary.json").read_text())

    def refused(self, done, message):
        self.assertEqual((done.returncode, done.stdout), (2, ""), done.stderr)
        self.assertRegex(done.stderr, message)
        self.assertEqual(len(done.stderr.splitlines()), 1, done.stderr)

    def test_everything_passes_and_is_summed_up(self):
        done = self.measure("passed", *TINY)
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        summary = self.summary("passed")
        self.assertEqual([part["part"] for part in summary["parts"]],
                         ["kernel_tests", "filter_tests", "kernels_3", "frames_3"])
        for part in summary["parts"]:
            self.assertEqual((part["status"], part["exit"]), ("passed", 0), part)
            self.assertGreater(part["bound"], part["seconds"])
            self.assertTrue((self.folder / "passed" / f"{part['part']}.log").exists())
            self.assertIn(part["told"], done.stdout)
        for part in summary["parts"][:2]:
            self.assertEqual(part["told"], "1 of 1 test cases passed, 0 failed")
        self.assertIn("8 triangles: a frame takes", summary["parts"][3]["told"])
        self.assertIn("Portable Computing Language", summary["platform"])
        for key in ("device", "driver"):
            self.assertTrue(summary[key])
            self.assertIn(summary[key], done.stdout)
        self.assertEqual(summary["commit"], (self.bundle / "commit").read_text().strip())

        rows = json.loads((self.folder / "passed/kernels_3.json").read_text())
        jsonschema.validate(rows, json.loads((project / "docs/benchmark.schema.json").read_text()))
        self.assertEqual({(row["commit"], row["triangles"]) for row in rows}, {(summary["commit"], 8)})
        self.compare_frame_times(self.folder / "passed/frames_3.json", summary["parts"][3]["told"])

    def compare_frame_times(self, path, told):
        device = [event for event in json.loads(path.read_text())["traceEvents"]
                  if event["ph"] == "X" and event["tid"] == DEVICE]
        frames = [[event for event in device if event["args"]["frame"] == frame] for frame in range(10)]
        ends = [frame[-1]["ts"] + frame[-1]["dur"] for frame in frames]
        whole = statistics.median(after - before for before, after in zip(ends, ends[1:]))
        stepped = statistics.median(sum(event["dur"] for event in frame if event["name"] == "step")
                                    for frame in frames[1:])
        stated = [float(number) for number in re.findall(r"([0-9.]+) ms", told)]
        for of_trace, of_program in zip((whole, stepped), stated, strict=True):  # µs, ms
            self.assertAlmostEqual(1e-3 * of_trace, of_program, delta=1e-3)

    def test_bundle_needs_nothing_of_the_build(self):
        libraries = {path.name for path in (self.bundle / "lib").iterdir()}
        self.assertIn("libOpenCL.so.1", libraries)
        self.assertTrue(libraries.isdisjoint({"libc.so.6", "libm.so.6"}))
        self.assertIn("libstdc++.so.6", {path.name for path in (self.bundle / "lib_of_compiler").iterdir()})
        folders = f"{self.bundle}/lib:{self.bundle}/lib_of_compiler"
        for program in (self.bundle / "bin").iterdir():
            used = run("ldd", program, LD_LIBRARY_PATH=folders).stdout
            for name, path in re.findall(r"^\t(\S+) => (\S+)", used, re.MULTILINE):
                if name not in ("libc.so.6", "libm.so.6"):
                    self.assertTrue(path.startswith(str(self.bundle)), (program.name, name, path))

    def test_libraries_of_the_compiler_are_used_where_the_machine_s_do_not_serve(self):
        unusable = self.folder / "unusable"
        unusable.mkdir()
        (unusable / "libgomp.so.1").write_text("no library")
        done = self.measure("compiler", "--tests", "*nothing is *", "--grids", "", LD_LIBRARY_PATH=str(unusable))
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        (self.bundle / "lib_of_compiler").rename(self.folder / "away")
        try:
            self.refused(self.measure("no_compiler", LD_LIBRARY_PATH=str(unusable)), "do not start here: .*libgomp")
        finally:
            (self.folder / "away").rename(self.bundle / "lib_of_compiler")

    def test_what_takes_too_long_is_ended_and_what_follows_is_run(self):
        done = self.measure("late", "--seconds", "12", "--grids", "65", "--copy-megabytes", "1")
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        first, second, *_ = parts = self.summary("late")["parts"]
        for part in (first, second):
            self.assertEqual(part["status"], "timed_out", part)
            self.assertRegex(part["told"], r"^ended after \d+ s")
        self.assertEqual(len(parts), 4)
        self.assertLess(sum(part["seconds"] for part in parts), 12 + 3)

    def test_what_fails_is_told_and_what_follows_is_run(self):
        done = self.measure("failed", *TINY[2:], "--tests", "[set_parameters]")  # the filter has no such test
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        self.assertEqual([part["status"] for part in self.summary("failed")["parts"]],
                         ["passed", "failed", "passed", "passed"])

    def test_a_failing_test_fails_its_part(self):
        # A program in the tests' place: one passes, one fails, and one selects nothing.
        broken = self.bundle / "bin/apsl_kernel_tests"
        kept = broken.rename(self.folder / "apsl_kernel_tests")
        try:
            broken.write_text("""#!/bin/bash
case "$*" in
  *--list-test-names-only*) printf '%s\\n' 'one, with a comma' 'two [in brackets]' three;;
  'one\\, with a comma') echo 'All tests passed (1 assertion in 1 test case)' ;;
  'two \\[in brackets\\]') echo 'what it said'; exit 1 ;;
  three*) echo 'No tests ran' ;;
esac
""")
            broken.chmod(0o755)
            done = self.measure("broken", "--tests", "*nothing is *", "--grids", "")
        finally:
            broken.unlink()
            kept.rename(broken)
        self.assertEqual(done.returncode, 1, done.stdout + done.stderr)
        part = self.summary("broken")["parts"][0]
        self.assertEqual((part["status"], part["exit"], part["told"]),
                         ("failed", 1, "1 of 3 test cases passed, 2 failed"))
        log = (self.folder / "broken/kernel_tests.log").read_text()
        self.assertIn("what it said\nFAILED with 1: two [in brackets]\n", log)
        self.assertIn("No tests ran\nFAILED with 0: three\n", log)

    def test_a_cloth_beyond_the_memory_is_passed_over(self):
        done = self.measure("large", *TINY[:2], "--grids", "9999")
        self.assertEqual(done.returncode, 0, done.stdout + done.stderr)
        for part in self.summary("large")["parts"][2:]:
            self.assertEqual((part["status"], part["exit"], part["results"]), ("skipped", None, None))
            self.assertRegex(part["told"], r"^\d+ triangles need about \d+ MB of memory and \d+ MB on the device; ")

    def test_no_driver(self):
        missing = self.folder / "libnone.so"
        self.refused(self.measure("none", driver=missing), f"^error: --driver {missing}: no such file$")
        self.refused(self.measure("none", driver="libm.so.6"), "^error: --driver libm.so.6: no OpenCL device ")
        if not any(Path(path).exists() for path in ("/dev/nvidiactl", "/dev/kfd", "/dev/dri")):
            self.refused(self.measure("none", driver=None), "^error: no OpenCL driver with a GPU found: ")

    def test_wrong_arguments(self):
        self.refused(self.measure("wrong", "--device", "7"), "^error: --device 7: .* has no such device$")
        for options, message in ((["--seconds", "x"], "--seconds x: expected a whole number"),
                                 (["--nonsense"], "--nonsense: no such option"),
                                 ([self.bundle], "expected a bundle and a folder")):
            self.refused(self.measure("wrong", *options), message)
        self.refused(run(self.bundle / "gpu.sh", self.folder, self.folder / "wrong"), "no bundle of bench/gpu_bundle")
        self.refused(run(self.bundle / "gpu.sh", self.bundle, self.folder), "is there already")
        self.refused(run(PACK, build, self.folder), "is there already")
        self.refused(run(PACK, self.folder, self.folder / "new"), "apsl is not there; build it: ")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
