# SPDX-License-Identifier: MIT
"""The replay can fail: each fault is put into a copy of the kernels, and the launches that have it must be refused for
the reason stated. Without faults the same launches pass. Takes the folder that record.py wrote."""
import re
import shutil
import sys
import tempfile
import unittest
from dataclasses import dataclass
from pathlib import Path

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import check_kernels  # noqa: E402
import variants  # noqa: E402
from compiled import Compiled  # noqa: E402
from recording import launches_of  # noqa: E402
from replay import has_work, replay  # noqa: E402

KERNELS = check_kernels.PROJECT / "kernels"
TARGETS = {str(target): target for target in variants.TARGETS}

HALVING = """        if (l < half_size) scratch[l] += scratch[l + half_size];
        barrier(CLK_LOCAL_MEM_FENCE);
    }
    value = *(volatile __local float*)scratch;
    barrier(CLK_LOCAL_MEM_FENCE);
"""
GATHER = """gradients, residual, cloth.run, forces);
        group_barrier();
"""
END_OF_PATCH = """            curvature += r * q;
        }
        group_barrier();
"""


@dataclass(frozen=True)
class Fault:
    file: str
    old: str  # stands in the file exactly once
    new: str
    scenario: str
    kernel: str  # of the launch that meets it
    says: str  # a regular expression in what is refused


BARRIER_GONE_IN_HALVING = Fault(
    "work_group.h", HALVING, HALVING.replace("        barrier(CLK_LOCAL_MEM_FENCE);\n", "", 1),
    "gradient", "measure_area_change", "off by")
BARRIER_GONE_AFTER_GATHER = Fault(
    "patch_product.h", GATHER, GATHER.replace("        group_barrier();\n", ""),
    "gradient", "matrix_free_apply_dot", "numbers, the first at")
BARRIER_GONE_AT_PATCH_END = Fault(
    "patch_product.h", END_OF_PATCH, END_OF_PATCH.replace("        group_barrier();\n", ""),
    "gradient", "matrix_free_apply_dot", "off by")
BARRIER_IN_BRANCH = Fault(
    "work_group.h", HALVING,
    HALVING.replace("scratch[l] += scratch[l + half_size];\n        barrier(CLK_LOCAL_MEM_FENCE);",
                    "{ scratch[l] += scratch[l + half_size]; barrier(CLK_LOCAL_MEM_FENCE); }"),
    "gradient", "measure_area_change", "fault: .*barrier")
SUM_NOT_FROM_ZERO = Fault(
    "work_group.h", "    float sum = 0.0f;\n    for (uint first",
    "    float sum = scratch[get_local_id(0)];\n    for (uint first",
    "gradient", "matrix_free_apply_dot", "numbers, the first at")
LOCKSTEP_OF_64 = Fault(
    "work_group.h", HALVING,
    HALVING.replace("        barrier(CLK_LOCAL_MEM_FENCE);\n    }\n",
                    "        if (half_size > 64) barrier(CLK_LOCAL_MEM_FENCE);\n    }\n"
                    "    barrier(CLK_LOCAL_MEM_FENCE);\n"),
    "gradient", "measure_area_change", "off by")
# What is read is not used: the offsets grow, so the lesser of the two is what it was.
OUT_OF_BOUNDS = Fault(
    "vertex_gather.h", "float4 sum = (float4)(0.0f);\n    const uint end = corner_offsets[i + 1];",
    "float4 sum = (float4)(0.0f);\n    const uint end = min(corner_offsets[i + 1], corner_offsets[i + 2]);",
    "gradient", "matrix_free_apply_dot", "fault: .*outside of every buffer, from byte")
# The next sum overwrites what some waves have not read yet. Here they take the same decision by either.
RESULT_NOT_READ_BY_ALL = Fault(
    "work_group.h", HALVING,
    HALVING.replace("    value = *(volatile __local float*)scratch;\n    barrier(CLK_LOCAL_MEM_FENCE);\n", "    value = *(volatile __local float*)scratch;\n"),
    "gradient", "matrix_free_apply_dot", "race: local memory")


class PlantedFaults(unittest.TestCase):
    recordings = None

    whole = {}

    def refusals_without(self, fault, target, races=False):
        """Of the kernels as they are. The launches of several faults are the same."""
        key = fault.scenario, fault.kernel, target, races
        if key not in self.whole:
            self.whole[key] = self.refusals(fault, target, races, planted=False)
        return self.whole[key]

    def refusals(self, fault, target, races=False, planted=True):
        """What is refused of the launch that meets the fault."""
        [launch] = [launch for launch in launches_of(self.recordings / fault.scenario)
                    if launch.kernel == fault.kernel and has_work(launch)][:1]
        with tempfile.TemporaryDirectory() as folder:
            kernels = Path(folder) / "kernels"
            shutil.copytree(KERNELS, kernels)
            text = (kernels / fault.file).read_text(encoding="utf-8")
            self.assertEqual(text.count(fault.old), 1, f"{fault.file} has to hold {fault.old!r} once")
            if planted:
                (kernels / fault.file).write_text(text.replace(fault.old, fault.new), encoding="utf-8")
            compiled = Compiled("clang-19", check_kernels.device_libraries(), kernels, TARGETS[target])
            return replay(compiled, launch, races=races)[2]

    def assert_seen(self, fault, *targets, races=False):
        for target in targets:
            with self.subTest(target=target):
                self.assertEqual(self.refusals_without(fault, target, races), [])
                found = self.refusals(fault, target, races=races)
                self.assertTrue(any(re.search(fault.says, line) for line in found), found)

    def test_a_barrier_gone_within_the_halving_of_a_sum(self):
        self.assert_seen(BARRIER_GONE_IN_HALVING, "gfx1100/32", "gfx906/64")

    def test_a_barrier_gone_after_the_gather(self):
        self.assert_seen(BARRIER_GONE_AFTER_GATHER, "gfx1100/32", "gfx906/64")

    def test_a_barrier_gone_at_a_patch_s_end(self):
        self.assert_seen(BARRIER_GONE_AT_PATCH_END, "gfx1100/32", "gfx906/64")

    def test_a_barrier_in_a_branch(self):
        self.assert_seen(BARRIER_IN_BRANCH, "gfx1100/32", "gfx906/64")

    def test_a_sum_not_started_from_zero(self):
        self.assert_seen(SUM_NOT_FROM_ZERO, "gfx1100/32", "gfx906/64")

    def test_a_read_out_of_bounds(self):
        self.assert_seen(OUT_OF_BOUNDS, "gfx1100/32", "gfx906/64")

    def test_lockstep_of_64_shows_where_waves_have_32(self):
        self.assert_seen(LOCKSTEP_OF_64, "gfx1100/32")
        self.assertEqual(self.refusals(LOCKSTEP_OF_64, "gfx906/64", races=True), [])

    def test_what_only_the_look_for_races_sees(self):
        for target in ("gfx1100/32", "gfx906/64"):
            self.assertEqual(self.refusals(RESULT_NOT_READ_BY_ALL, target), [])
        self.assert_seen(RESULT_NOT_READ_BY_ALL, "gfx1100/32", "gfx906/64", races=True)


if __name__ == "__main__":
    if len(sys.argv) < 2 or not Path(sys.argv[1]).is_dir():
        sys.exit("error: expected the folder that record.py wrote")
    PlantedFaults.recordings = Path(sys.argv.pop(1))
    unittest.main()
