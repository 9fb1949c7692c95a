# SPDX-License-Identifier: MIT
"""The interpreter itself: instructions against values worked out by hand or in exact arithmetic, what it must refuse,
races, comparison and coverage."""
import random
import re
import sys
import unittest
from fractions import Fraction
from pathlib import Path
from types import SimpleNamespace

import numpy as np

sys.path.insert(0, str(Path(__file__).resolve().parents[1]))

import check_kernels  # noqa: E402
import coverage  # noqa: E402
import float_arithmetic as floats  # noqa: E402
from assembly import UnknownInstruction, kernels_of, parse_instruction  # noqa: E402
from comparison import TOLERANCE, compare, compare_partials, type_of  # noqa: E402
from launch import Grid, run  # noqa: E402
from memory import DeviceMemory, Fault, LocalMemory  # noqa: E402
from operands import EXEC, VCC  # noqa: E402
from races import Accesses  # noqa: E402
from wave import Wave, decode  # noqa: E402

KERNELS = check_kernels.PROJECT / "kernels"


def bits(*values):
    return np.array(values, np.float32).view(np.uint32).tolist()


class Machine:
    """One wave, on which single instructions are executed. All lanes hold the same unless said otherwise."""

    def __init__(self, wave_size=32):
        self.memory = DeviceMemory()
        self.wave = Wave([], wave_size, self.memory, LocalMemory(64), np.random.default_rng(1), 1, 1)
        self.wave.start(wave_size)

    def set(self, **registers):
        for name, value in registers.items():
            if name == "scc":
                self.wave.scc = value
            elif name[0] == "v":
                self.wave.vectors[int(name[1:])] = value
            else:
                self.wave.scalars[int(name[1:])] = value
        return self

    def execute(self, *texts):
        with np.errstate(all="ignore"):
            for text in texts:
                decode(parse_instruction(text), self.wave.wave_size)(self.wave)
        return self

    def lane(self, register, lane=0):
        return int(self.wave.vectors[register][lane])

    def scalar(self, register):
        return self.wave.scalars[register]


class VectorInstructions(unittest.TestCase):
    def assert_result(self, text, want, wave_size=32, **registers):
        machine = Machine(wave_size).set(**registers).execute(text)
        self.assertEqual(machine.lane(0), want, text)

    def test_bit_fields(self):
        self.assert_result("v_bfe_u32 v0, v1, 4, 8", 0xcd, v1=0xabcde)
        self.assert_result("v_bfe_i32 v0, v1, 4, 8", 0xffffffcd, v1=0xabcde)
        self.assert_result("v_bfe_i32 v0, v1, 16, 16", 0xffff8000, v1=0x80001234)
        self.assert_result("v_bfi_b32 v0, v1, v2, v3", 0x12cd, v1=0xff00, v2=0x1234, v3=0xabcd & 0xff)
        self.assert_result("v_perm_b32 v0, v1, v2, v3", 0x00ff1155, v1=0x44332211, v2=0x88776655, v3=0x0c0d0400)
        self.assert_result("v_lshl_or_b32 v0, v1, 4, v2", 0x123f, v1=0x123, v2=0xf)

    def test_signs_of_sources_and_constants(self):
        self.assert_result("v_add_f32_e64 v0, -|v1|, 0.5", bits(-2.0)[0], v1=bits(2.5)[0])
        self.assert_result("v_mul_f32_e64 v0, v1, v2 clamp", bits(1.0)[0], v1=bits(2.0)[0], v2=bits(3.0)[0])
        self.assert_result("v_mul_f32_e64 v0, v1, v2 mul:2", bits(12.0)[0], v1=bits(2.0)[0], v2=bits(3.0)[0])
        self.assert_result("v_add_f32_e32 v0, 0x40400000, v1", bits(4.0)[0], v1=bits(1.0)[0])
        self.assert_result("v_and_b32_e32 v0, -4, v1", 0xfffffff4, v1=0xfffffff7)

    def test_parts_of_registers(self):
        self.assert_result("v_lshlrev_b32_sdwa v0, v2, v1 dst_sel:DWORD dst_unused:UNUSED_PAD src0_sel:DWORD "
                           "src1_sel:WORD_1", 0xabc0, v1=0xabc1234, v2=4)
        self.assert_result("v_cvt_f32_i32_sdwa v0, sext(v1) dst_sel:DWORD dst_unused:UNUSED_PAD src0_sel:WORD_1",
                           bits(-2.0)[0], v1=0xfffe0000)

    def test_64_bits(self):
        machine = Machine().set(v2=0xffffffff, v3=0xffffffff, v4=5, v5=1)
        machine.execute("v_mad_u64_u32 v[0:1], s0, v2, v3, v[4:5]")
        product = 0xffffffff**2 + (1 << 32) + 5
        self.assertEqual((machine.lane(0), machine.lane(1)), (product & 0xffffffff, product >> 32 & 0xffffffff))
        self.assertEqual(machine.scalar(0), 0 if product < 1 << 64 else 0xffffffff)
        machine = Machine().set(v2=0x80000001, v3=0).execute("v_lshlrev_b64 v[0:1], 2, v[2:3]")
        self.assertEqual((machine.lane(0), machine.lane(1)), (4, 2))

    def test_carries_go_to_the_lanes_that_have_them(self):
        machine = Machine().set(v1=1, s4=0)
        machine.wave.vectors[2] = np.where(np.arange(32) == 5, 0xffffffff, 7)
        machine.execute("v_add_co_u32 v0, vcc_lo, v1, v2", "v_add_co_ci_u32_e64 v3, vcc_lo, 0, 0, vcc_lo")
        self.assertEqual([machine.lane(0, 5), machine.lane(3, 5), machine.lane(0, 6), machine.lane(3, 6)], [0, 1, 8, 0])

    def test_both_of_a_pair_read_before_either_writes(self):
        machine = Machine().set(v0=1, v1=2).execute("v_dual_mov_b32 v0, v1 :: v_dual_mov_b32 v1, v0")
        self.assertEqual((machine.lane(0), machine.lane(1)), (2, 1))

    def test_packed(self):
        machine = Machine(64).set(v2=bits(2.0)[0], v3=bits(3.0)[0], v4=bits(5.0)[0], v5=bits(7.0)[0])
        machine.execute("v_pk_mul_f32 v[0:1], v[2:3], v[4:5] op_sel:[0,1] op_sel_hi:[1,0] neg_lo:[0,1]")
        self.assertEqual([machine.lane(0), machine.lane(1)], bits(-14.0, 15.0))

    def test_lanes_that_are_off_keep_what_they_have(self):
        machine = Machine().set(v0=1, v1=2)
        machine.wave.set_exec(0b10)
        machine.execute("v_mov_b32_e32 v0, v1", "v_cmp_eq_u32_e32 vcc_lo, 2, v1", "v_readfirstlane_b32 s0, v0")
        self.assertEqual((machine.lane(0, 0), machine.lane(0, 1)), (1, 2))
        self.assertEqual((machine.scalar(VCC), machine.scalar(0)), (0b10, 2))

    def test_comparisons_turn_lanes_off(self):
        machine = Machine(64)
        machine.wave.vectors[1] = np.arange(64)
        machine.execute("v_cmpx_gt_u32_e64 s[2:3], 3, v1")
        self.assertEqual(machine.wave.exec_mask(), 0b111)
        machine = Machine()
        machine.wave.floats[1] = np.where(np.arange(32) == 0, np.nan, 1.0)
        machine.execute("v_cmp_nlt_f32_e64 s0, v1, 2.0", "v_cmp_class_f32_e64 s1, v1, 3")
        self.assertEqual((machine.scalar(0), machine.scalar(1)), (1, 1))

    def test_exact_division(self):
        draw = random.Random(1)
        a = np.array([draw.choice((-1, 1)) * 2.0**draw.uniform(-126, 126) for _ in range(2000)], np.float32)
        b = np.array([draw.choice((-1, 1)) * 2.0**draw.uniform(-126, 126) for _ in range(2000)], np.float32)
        with np.errstate(all="ignore"):
            scaled_b, _ = floats.division_scale(b, b, a)
            scaled_a, undo = floats.division_scale(a, b, a)
            inverse = np.float32(1) / scaled_b
            inverse = floats.fma(floats.fma(-scaled_b, inverse, np.float32(1) + 0 * a), inverse, inverse)
            quotient = scaled_a * inverse
            quotient = floats.fma(floats.fma(-scaled_b, quotient, scaled_a), inverse, quotient)
            rest = floats.fma(-scaled_b, quotient, scaled_a)
            got = floats.division_fixup(floats.division_fma(rest, inverse, quotient, undo), b, a)
            want = a / b
        normal = (np.abs(want) >= 2.0**-126) & np.isfinite(want)
        self.assertGreater(normal.sum(), 1000)
        self.assertEqual(got[normal].tolist(), want[normal].tolist())


class FusedMultiplyAdd(unittest.TestCase):
    def test_one_rounding(self):
        draw = random.Random(2)
        for _ in range(3000):
            a, b, c = [np.float32(draw.choice((-1, 1)) * draw.random() * 2.0**draw.randint(-20, 20)) for _ in range(3)]
            if draw.random() < 0.5:  # nearly cancels
                c = np.float32(-float(a) * float(b) * (1 + draw.randint(-3, 3) * 2.0**-24))
            got = float(floats.fma(np.array([a]), np.array([b]), np.array([c]))[0])
            exact = Fraction(float(a)) * Fraction(float(b)) + Fraction(float(c))
            neighbours = [got, float(np.nextafter(np.float32(got), np.float32(np.inf))),
                          float(np.nextafter(np.float32(got), np.float32(-np.inf)))]
            self.assertEqual(min(neighbours, key=lambda x: abs(Fraction(x) - exact)), got, (a, b, c))

    def test_infinity_and_nan(self):
        ones = np.ones(1, np.float32)
        with np.errstate(all="ignore"):
            self.assertEqual(floats.fma(np.inf * ones, ones, ones)[0], np.inf)
            self.assertTrue(np.isnan(floats.fma(np.inf * ones, ones, -np.inf * ones)[0]))
            self.assertEqual(floats.fma(3e38 * ones, 2 * ones, ones)[0], np.inf)


class ScalarInstructions(unittest.TestCase):
    def assert_result(self, text, want, scc=None, **registers):
        machine = Machine().set(**registers).execute(text)
        self.assertEqual(machine.scalar(0), want, text)
        if scc is not None:
            self.assertEqual(machine.wave.scc, scc, text)

    def test_carries_and_overflow(self):
        self.assert_result("s_add_u32 s0, s1, s2", 1, 1, s1=0xffffffff, s2=2)
        self.assert_result("s_sub_u32 s0, s1, s2", 0xffffffff, 1, s1=1, s2=2)
        self.assert_result("s_add_i32 s0, s1, s2", 0x80000000, 1, s1=0x7fffffff, s2=1)
        machine = Machine().set(s1=1, s2=2, scc=1).execute("s_addc_u32 s0, s1, s2")
        self.assertEqual((machine.scalar(0), machine.wave.scc), (4, 0))

    def test_fields_and_shifts(self):
        self.assert_result("s_bfe_u32 s0, s1, 0x80004", 0xcd, 1, s1=0xabcde)
        self.assert_result("s_bfe_i32 s0, s1, 0x80004", 0xffffffcd, 1, s1=0xabcde)
        self.assert_result("s_ashr_i32 s0, s1, 31", 0xffffffff, 1, s1=0x80000000)
        self.assert_result("s_lshl_b32 s0, s1, 33", 2, 1, s1=1)
        self.assert_result("s_mul_hi_i32 s0, s1, s2", 0xffffffff, s1=0xffffffff, s2=2)
        self.assert_result("s_min_i32 s0, s1, s2", 0xffffffff, 1, s1=0xffffffff, s2=2)

    def test_64_bits(self):
        machine = Machine().set(s2=0x80000000, s3=0).execute("s_lshl_b64 s[0:1], s[2:3], 1")
        self.assertEqual((machine.scalar(0), machine.scalar(1)), (0, 1))
        machine = Machine().execute("s_mov_b64 s[0:1], -1")
        self.assertEqual((machine.scalar(0), machine.scalar(1)), (0xffffffff, 0xffffffff))

    def test_lanes_are_saved_and_restored(self):
        machine = Machine(64).set(s2=0b110, s3=1)
        machine.execute("s_and_saveexec_b64 s[0:1], s[2:3]")
        self.assertEqual(machine.wave.exec_mask(), 1 << 32 | 0b110)
        self.assertEqual((machine.scalar(0), machine.scalar(1)), (0xffffffff, 0xffffffff))
        machine.execute("s_or_b64 exec, exec, s[0:1]")
        self.assertTrue(machine.wave.on.all())
        machine.execute("s_and_not1_b32 exec_lo, exec_lo, 0xf")
        self.assertEqual(machine.scalar(EXEC), 0xfffffff0)

    def test_roots_of_scalar_registers(self):
        self.assert_result("v_s_sqrt_f32 s0, s1", bits(3.0)[0], s1=bits(9.0)[0])
        self.assert_result("v_s_exp_f32 s0, |s1|", bits(8.0)[0], s1=bits(-3.0)[0])

    def test_comparisons(self):
        for text, want in (("s_cmp_lt_i32 s1, 0", 1), ("s_cmp_lt_u32 s1, 0", 0), ("s_bitcmp1_b32 s1, 31", 1),
                           ("s_cmpk_lt_i32 s1, 0x5", 1)):
            self.assertEqual(Machine().set(s1=0xfffffff0).execute(text).wave.scc, want, text)


class Refusals(unittest.TestCase):
    def assert_unknown(self, text, named):
        with self.assertRaisesRegex(UnknownInstruction, named):
            Machine().execute(text)

    def test_what_is_not_modelled_is_named(self):
        for text in ("v_dot2_f32_f16 v0, v1, v2, v3", "s_getpc_b64 s[0:1]", "ds_swizzle_b32 v0, v1 offset:4",
                     "global_atomic_add_u32 v0, v1, s[0:1]", "v_add_f64 v[0:1], v[2:3], v[4:5]",
                     "v_mov_b32_dpp v0, v1 row_shr:1 row_mask:0xf bank_mask:0xf", "v_dual_no_f32 v0, v1 :: v_nop"):
            self.assert_unknown(text, text.split(" ")[0])

    def test_modifiers_and_operands_too(self):
        self.assert_unknown("v_add_f32_e64 v0, v1, v2 quad_perm:[0,1,2,3]", "quad_perm")
        self.assert_unknown("v_sub_nc_u32_e64 v0, v1, v2 clamp", "v_sub_nc_u32_e64")
        self.assert_unknown("v_mov_b32_e32 v0, a1", "a1")
        self.assert_unknown("global_load_b32 v0, v1, s[0:1] lds", "lds")

    def test_accesses_outside(self):
        machine = Machine()
        buffer = machine.memory.add(bytes(16))
        machine.set(v1=16, s2=buffer.address & 0xffffffff, s3=buffer.address >> 32)
        with self.assertRaisesRegex(Fault, "byte 16 of a buffer of 16"):
            machine.execute("global_load_b32 v0, v1, s[2:3]")
        machine.set(v1=64)
        with self.assertRaisesRegex(Fault, "byte 64 of 64 of local memory"):
            machine.execute("ds_load_b32 v0, v1")


class MemoryInstructions(unittest.TestCase):
    def test_loads_and_stores(self):
        machine = Machine()
        buffer = machine.memory.add(np.arange(64, dtype=np.uint32).tobytes())
        machine.set(s2=buffer.address & 0xffffffff, s3=buffer.address >> 32)
        machine.wave.vectors[1] = 4 * np.arange(32)
        machine.execute("global_load_b64 v[4:5], v1, s[2:3] offset:8", "global_load_u16 v6, v1, s[2:3] offset:2",
                        "s_load_b64 s[4:5], s[2:3], 0xc", "global_store_b8 v1, v4, s[2:3] offset:130")
        self.assertEqual((machine.lane(4, 7), machine.lane(5, 7), machine.lane(6, 7)), (9, 10, 0))
        self.assertEqual((machine.scalar(4), machine.scalar(5)), (3, 4))
        self.assertEqual(int(buffer.words[32 + 7]), 39 + (9 << 16))

    def test_local_memory_at_two_places(self):
        machine = Machine().set(v1=0, v2=11, v3=12)
        machine.execute("ds_store_2addr_b32 v1, v2, v3 offset0:1 offset1:3", "ds_load_b128 v[4:7], v1",
                        "ds_read2_b32 v[8:9], v1 offset0:3 offset1:1")
        self.assertEqual([machine.lane(n) for n in (5, 7, 8, 9)], [11, 12, 12, 11])


class Races(unittest.TestCase):
    def wave(self, number, group=1, barriers=1):
        return SimpleNamespace(number=number, group=group, barriers=barriers)

    def test_waves_of_a_group_are_ordered_by_barriers(self):
        words = np.array([3])
        accesses = Accesses(8)
        self.assertFalse(accesses.write(self.wave(1), words))
        self.assertTrue(accesses.read(self.wave(2), words))
        accesses = Accesses(8)
        accesses.write(self.wave(1), words)
        self.assertFalse(accesses.read(self.wave(2, barriers=2), words))
        self.assertTrue(accesses.write(self.wave(1, barriers=2), words))
        self.assertFalse(accesses.write(self.wave(1, barriers=3), words))

    def test_groups_are_not(self):
        accesses = Accesses(8)
        accesses.write(self.wave(1), np.array([3]))
        self.assertTrue(accesses.read(self.wave(5, group=2, barriers=2), np.array([3])))

    def test_reads_and_other_words_do_not_race(self):
        accesses = Accesses(8)
        self.assertFalse(accesses.read(self.wave(1), np.array([3])))
        self.assertFalse(accesses.read(self.wave(2), np.array([3])))
        self.assertFalse(accesses.write(self.wave(2), np.array([4])))
        self.assertTrue(accesses.write(self.wave(2), np.array([3])))


LOOP = """
	.text
wait:                                   ; @wait
; %bb.0:
	v_cmp_gt_u32_e32 vcc_lo, 32, v0
	s_cbranch_vccz .LBB0_2
; %bb.1:
	s_barrier
.LBB0_2:
	s_endpgm
	.section	.rodata,"a",@progbits
	.amdhsa_kernel wait
		.amdhsa_user_sgpr_count 2
		.amdhsa_user_sgpr_kernarg_segment_ptr 1
	.end_amdhsa_kernel
	.text
.Lfunc_end0:
	.amdgpu_metadata
---
amdhsa.kernels:
  - .args:
      - .offset:         0
        .size:           4
        .type_name:      int
        .value_kind:     by_value
    .group_segment_fixed_size: 0
    .kernarg_segment_size: 8
    .name:           wait
    .private_segment_fixed_size: 0
amdhsa.target:   amdgcn-amd-amdhsa--gfx1100
	.end_amdgpu_metadata
"""


class Launches(unittest.TestCase):
    def test_a_barrier_that_one_wave_does_not_come_to(self):
        kernel = kernels_of(LOOP)["wait"]
        target = SimpleNamespace(processor="gfx1100", wave_size=32)
        run(kernel, target, DeviceMemory(), [bytes(4)], Grid(1, 1, 32))
        with self.assertRaisesRegex(Fault, "a barrier that some waves do not come to"):
            run(kernel, target, DeviceMemory(), [bytes(4)], Grid(1, 1, 64))


class Comparison(unittest.TestCase):
    def lines(self, want, got, type_name, dtype):
        want, got = np.array(want, dtype).tobytes(), np.array(got, dtype).tobytes()
        return compare(KERNELS, want, got, type_name, TOLERANCE)[1]

    def test_floats(self):
        self.assertEqual(self.lines([100.0, 1.0], [100.0, 1.0 + 100 * TOLERANCE / 2], "float*", "f4"), [])
        self.assertIn("off by", self.lines([100.0, 1.0], [100.0, 1.0 + 100 * TOLERANCE * 2], "float*", "f4")[0])
        self.assertEqual(self.lines([np.nan, np.inf], [np.nan, np.inf], "float*", "f4"), [])
        for other in ([np.nan, -np.inf], [0.0, np.inf], [np.nan, 1.0]):
            self.assertEqual(len(self.lines([np.nan, np.inf], other, "float*", "f4")), 1)

    def test_whole_numbers_are_the_same(self):
        self.assertEqual(len(self.lines([1, 2], [1, 3], "uint*", "u4")), 1)

    def test_a_struct_is_compared_field_by_field(self):
        size = type_of(KERNELS, "apslk_solve_state*").itemsize
        want, got = bytearray(size), bytearray(size)
        got[8] = 1
        self.assertIn("iterating", compare(KERNELS, bytes(want), bytes(got), "apslk_solve_state*", TOLERANCE)[1][0])

    def test_each_kind_of_partial_result_has_a_size_of_its_own(self):
        kinds = int(re.search(r"PARTIAL_KINDS (\d+)", (KERNELS / "layout.h").read_text(encoding="utf-8"))[1])
        want, got = np.ones((2, kinds, 3), np.float32), np.ones((2, kinds, 3), np.float32)
        want[:, 4], got[:, 4] = 1e6, 1e6
        got[1, 7, 2] = 1.001
        lines = compare_partials(KERNELS, want.tobytes(), got.tobytes(), 2, TOLERANCE)[1]
        self.assertEqual(len(lines), 1)
        self.assertTrue(lines[0].startswith("kind 7: off by 0.001"), lines)

    def test_a_gradient_may_be_rounded_to_either_side(self):
        want, near, far = (np.zeros(16, np.int16) for _ in range(3))
        near[2], far[2] = 1, 2
        self.assertEqual(self.lines(want, near, "apslk_gradients*", "i2"), [])
        self.assertEqual(len(self.lines(want, far, "apslk_gradients*", "i2")), 1)


class Coverage(unittest.TestCase):
    def launch(self, source, kernel):
        return SimpleNamespace(source=source, kernel=kernel)

    def test_what_was_not_executed_is_named(self):
        lines = coverage.missing(KERNELS, [(self.launch("cg_update.cl", "cg_update"),
                                            (("APSLK_WARM_START_SUB_STEPS", 3), ("APSLK_WORK_GROUP_SIZE", 64)))])
        self.assertTrue(any(line.startswith("rest_areas.cl:rest_shapes: no launch") for line in lines))
        of_it = [line for line in lines if line.startswith("cg_update.cl")]
        self.assertEqual(of_it, ["cg_update.cl: no launch was executed with APSLK_WARM_START_SUB_STEPS=0",
                                 "cg_update.cl: no launch was executed with APSLK_WORK_GROUP_SIZE=256"])

    def test_enough_takes_every_setting_of_every_kernel(self):
        offered = [(self.launch("a.cl", kernel), (("D", d), ("E", e)))
                   for kernel, d, e in (("one", 0, 0), ("two", 0, 0), ("one", 1, 0), ("one", 1, 1), ("two", 1, 1))]
        taken = coverage.enough(offered)
        self.assertEqual({id(launch) for launch in taken}, {id(offered[n][0]) for n in (0, 1, 3, 4)})


if __name__ == "__main__":
    unittest.main()
