# SPDX-License-Identifier: MIT
"""The gate can fail: kernels with one known fault each, and each refused for that fault."""
import os
import shutil
import subprocess
import sys
import tempfile
import unittest
from dataclasses import replace
from pathlib import Path

import amd_compiler
import check_kernels
import gate
import tuning_table
import variants

HERE = Path(__file__).resolve().parent
DEVICE_LIBRARIES = check_kernels.device_libraries()
GENERATIONS = [t for t in variants.TARGETS if t.processor in ("gfx906", "gfx1030", "gfx1201")]


def compiled(name, target=variants.TARGETS[0]):
    [usage] = amd_compiler.compile_kernels("clang-19", DEVICE_LIBRARIES, HERE / "judged" / f"{name}.cl", (), target)
    return usage


class Findings(unittest.TestCase):
    def assert_reasons(self, name, reasons):
        for target in GENERATIONS:
            with self.subTest(kernel=name, target=str(target)):
                try:
                    found = gate.findings(compiled(name, target), target.wave_size)
                except amd_compiler.CompileError as error:
                    found = [gate.compile_finding(str(error))]
                self.assertEqual({finding.split(":")[0] for finding in found}, reasons, found)

    def test_accepts_a_plain_kernel(self):
        self.assert_reasons("accepted", set())

    def test_scratch(self):
        self.assert_reasons("scratch", {"scratch"})

    def test_spill(self):
        self.assert_reasons("spill", {"scratch", "spill"})  # spilled registers go to scratch memory

    def test_double_arithmetic(self):
        self.assert_reasons("double_arithmetic", {"double"})

    def test_local_memory(self):
        self.assert_reasons("local_memory", {"local memory"})

    def test_unresolved_call(self):
        self.assert_reasons("unresolved_call", {"call"})

    def test_flat_access(self):
        self.assert_reasons("flat_access", {"flat access"})

    def test_warning(self):
        self.assert_reasons("warning", {"compile"})

    def test_local_memory_that_a_compiler_lets_pass(self):
        usage = replace(compiled("accepted"), local_bytes=gate.LOCAL_MEMORY_LIMIT + 4)
        self.assertEqual([f.split(":")[0] for f in gate.findings(usage, 64)], ["local memory"])

    def test_wave_size_other_than_asked_for(self):
        self.assertEqual([f.split(":")[0] for f in gate.findings(compiled("accepted"), 32)], ["wave size"])


class Budget(unittest.TestCase):
    def setUp(self):
        self.usage = compiled("accepted")
        self.budget = gate.budget_of(self.usage)

    def test_what_was_measured_passes(self):
        self.assertEqual(gate.over_budget(self.usage, self.budget), [])

    def test_each_figure_over_it_is_refused(self):
        for name in ("vgprs", "sgprs", "local_bytes"):
            worse = replace(self.usage, **{name: self.budget[name] + 1})
            with self.subTest(name):
                [finding] = gate.over_budget(worse, self.budget)
                self.assertIn(name, finding)

    def test_fewer_waves_are_refused(self):
        [finding] = gate.over_budget(replace(self.usage, waves_per_simd=self.usage.waves_per_simd - 1), self.budget)
        self.assertIn("waves_per_simd", finding)

    def test_a_kernel_without_one_is_refused(self):
        [finding] = gate.over_budget(self.usage, None)
        self.assertIn("none stored", finding)


class KernelFolder(unittest.TestCase):
    """The program itself, on a folder of its own."""

    def setUp(self):
        folder = tempfile.TemporaryDirectory()
        self.addCleanup(folder.cleanup)
        self.kernels = Path(folder.name)
        self.budget = self.kernels / "budget.json"

    def add(self, name, text=None):
        """A file of judged/, or one with this text."""
        if text is None:
            shutil.copy(HERE / "judged" / name, self.kernels / name)
        else:
            (self.kernels / name).write_text(text, encoding="utf-8")

    def check(self, *options):
        command = [sys.executable, str(HERE / "check_kernels.py"), "--kernels", str(self.kernels), "--budget",
                   str(self.budget), *options]
        environment = {name: value for name, value in os.environ.items() if name != "APSL_TEST_THOROUGH"}
        return subprocess.run(command, capture_output=True, text=True, timeout=120, env=environment)

    def assert_refused(self, words, *options):
        result = self.check(*options)
        self.assertEqual(result.returncode, 1, result.stdout + result.stderr)
        self.assertIn(words, result.stderr)

    def test_budget_from_missing_to_kept_to_exceeded(self):
        self.add("accepted.cl")
        self.assert_refused("accepted.cl:accepted gfx906/64: budget: none stored")
        self.assertEqual(self.check("--update-budget").returncode, 0)
        kept = self.check()
        self.assertEqual(kept.returncode, 0, kept.stderr)
        self.assertIn("passed: 1 kernel variants on 9 targets", kept.stdout)
        self.budget.write_text(self.budget.read_text(encoding="utf-8").replace('"vgprs": 8', '"vgprs": 1'))
        self.assert_refused("accepted.cl:accepted gfx1201/32: budget:")
        (self.kernels / "accepted.cl").rename(self.kernels / "renamed.cl")
        self.assert_refused("accepted.cl:accepted: budget: the kernel is gone")

    def test_a_fault_is_refused_even_while_the_budget_is_rewritten(self):
        self.add("scratch.cl")
        self.assert_refused("scratch.cl:scratch gfx90a/64: scratch:", "--update-budget")
        self.assertFalse(self.budget.exists())

    def test_a_kernel_that_no_variant_compiles(self):
        self.add("hidden.cl", "#define APSLK_NEVER 0\n"
                              "#if APSLK_NEVER\n"
                              "__kernel void hidden(__global float* v) { v[0] = 1; }\n"
                              "#endif\n"
                              "__kernel void seen(__global float* v) { v[0] = 1; }\n")
        self.assert_refused("hidden.cl:hidden: coverage:", "--update-budget")

    def test_a_define_without_values(self):
        self.add("new_define.cl", "#ifndef APSLK_NEW\n"
                                  "#define APSLK_NEW 1\n"
                                  "#endif\n"
                                  "__kernel void k(__global float* v) { v[0] = APSLK_NEW; }\n")
        self.assert_refused("new_define.cl reads APSLK_NEW")

    def test_a_table_out_of_date(self):
        self.add("accepted.cl")
        document = self.kernels / "amd_registers.md"
        document.write_text(f"before\n{tuning_table.BEGIN}\n{tuning_table.END}\nafter\n", encoding="utf-8")
        self.assertEqual(self.check("--update-budget", "--write-table", str(document)).returncode, 0)
        self.assertEqual(self.check("--check-table", str(document)).returncode, 0)
        text = document.read_text(encoding="utf-8")
        self.assertTrue(text.startswith("before\n") and text.endswith("\nafter\n"), text)
        self.assertIn("| accepted | 0 |", text)
        document.write_text(text.replace("| accepted | 0 |", "| accepted | 4 |"), encoding="utf-8")
        self.assert_refused("amd_registers.md: table: out of date", "--check-table", str(document))

    def test_few_targets_keep_to_a_budget_of_the_same_sources_alone(self):
        self.add("accepted.cl")
        document = self.kernels / "amd_registers.md"
        document.write_text(f"{tuning_table.BEGIN}\n{tuning_table.END}\n", encoding="utf-8")
        self.assertEqual(self.check("--update-budget", "--write-table", str(document)).returncode, 0)
        few = ("--few-targets", "--check-table", str(document))
        kept = self.check(*few)
        self.assertEqual(kept.returncode, 0, kept.stderr)
        self.assertIn("passed: 1 kernel variants on 3 targets", kept.stdout)
        text = (self.kernels / "accepted.cl").read_text(encoding="utf-8")
        self.add("accepted.cl", "// a comment makes no code\n" + text)
        self.assertEqual(self.check(*few).returncode, 0)
        self.add("accepted.cl", text + "constant int unused = 1;\n")
        self.assert_refused("budget.json: sources: written for other kernels", *few)
        self.assertEqual(self.check("--few-targets", "--update-budget").returncode, 2)


class Variants(unittest.TestCase):
    def test_a_file_is_compiled_with_the_defines_it_reads_through_its_includes(self):
        with tempfile.TemporaryDirectory() as folder:
            kernels = Path(folder)
            (kernels / "a.h").write_text("#ifndef APSLK_A_H\n#define APSLK_A_H\n#if APSLK_WORK_GROUP_SIZE > 64\n#endif\n"
                                         "#ifndef APSLK_MATRIX\n#define APSLK_MATRIX 0\n#endif\n#endif\n")
            (kernels / "free.cl").write_text('#include "a.h"\n')
            (kernels / "fixed.cl").write_text('#define APSLK_MATRIX 1\n#include "a.h"\n')
            self.assertEqual(variants.defines_read_by(kernels / "free.cl"), ["APSLK_MATRIX", "APSLK_WORK_GROUP_SIZE"])
            self.assertEqual(variants.defines_read_by(kernels / "fixed.cl"), ["APSLK_WORK_GROUP_SIZE"])
            self.assertEqual([(v.source.name, v.defines) for v in variants.variants(kernels)], [
                ("fixed.cl", (("APSLK_WORK_GROUP_SIZE", 64),)),
                ("fixed.cl", (("APSLK_WORK_GROUP_SIZE", 256),)),
                ("free.cl", (("APSLK_MATRIX", 0), ("APSLK_WORK_GROUP_SIZE", 64))),
                ("free.cl", (("APSLK_MATRIX", 1), ("APSLK_WORK_GROUP_SIZE", 64))),
                ("free.cl", (("APSLK_MATRIX", 0), ("APSLK_WORK_GROUP_SIZE", 256))),
                ("free.cl", (("APSLK_MATRIX", 1), ("APSLK_WORK_GROUP_SIZE", 256)))])


if __name__ == "__main__":
    unittest.main()
