# SPDX-License-Identifier: MIT
"""Vector instructions: one value a lane, and lanes that are off keep what they had."""
import re

import numpy as np
import float_arithmetic as floats
from assembly import UnknownInstruction, common_name
from lane_operations import ACCUMULATING, OPERATIONS
from operands import VCC, Operand, lane_mask_target, lanes, parse, scalar, scalar_target

_U, _F, _Q = np.uint32, np.float32, np.uint64

# Sum or difference, of which what 32 bits do not hold is the carry.
_CARRYING = {
    "v_add_co_u32": ("uu", lambda a, b: a + b),
    "v_sub_co_u32": ("uu", lambda a, b: a - b),
    "v_subrev_co_u32": ("uu", lambda a, b: b - a),
    "v_add_co_ci_u32": ("uum", lambda a, b, carry: a + b + carry),
    "v_sub_co_ci_u32": ("uum", lambda a, b, carry: a - b - carry),
}
# On pairs of floats.
_PACKED = {"v_pk_add_f32": lambda a, b: a + b, "v_pk_mul_f32": lambda a, b: a * b, "v_pk_fma_f32": floats.fma}

_PART_MODIFIERS = {"dst_sel", "dst_unused", "src0_sel", "src1_sel"}
_RESULT_MODIFIERS = {"clamp", "mul", "div"}


def _check_modifiers(instruction, allowed):
    for name in instruction.modifiers:
        if name not in allowed:
            raise UnknownInstruction(f"modifier {name} of {instruction.text}")


def _sources(instruction, texts, kinds, wave_size):
    """Readers of the operands `texts`; what an encoding leaves unsaid is vcc."""
    operands = [parse(text, instruction.modifiers.get(f"src{n}_sel", "DWORD")) for n, text in enumerate(texts)]
    if len(operands) == len(kinds) - 1 and kinds[-1] == "m":
        operands.append(Operand("s", VCC))
    if len(operands) != len(kinds):
        raise UnknownInstruction(f"operands of {instruction.text}")
    return [lanes(operand, kind, wave_size) for operand, kind in zip(operands, kinds)]


def _finished(instruction, result):
    """The result after the modifiers that change it."""
    modifiers = instruction.modifiers
    if not modifiers.keys() & (_RESULT_MODIFIERS | {"dst_sel"}):
        return result
    if modifiers.keys() & _RESULT_MODIFIERS and result.dtype != _F:
        raise UnknownInstruction(f"{instruction.text}: clamps a whole number")
    if "mul" in modifiers:
        result = result * _F(int(modifiers["mul"]))
    if "div" in modifiers:
        result = result / _F(int(modifiers["div"]))
    if "clamp" in modifiers:
        result = np.where(np.isnan(result), _F(0), np.clip(result, _F(0), _F(1)))
    part = modifiers.get("dst_sel", "DWORD")
    if part != "DWORD":
        if part not in ("WORD_0", "WORD_1") or modifiers.get("dst_unused") != "UNUSED_PAD":
            raise UnknownInstruction(instruction.text)
        result = (result.view(_U) & _U(0xffff)) << _U(16 * int(part[-1]))
    return result


def _write(wave, number, result):
    if result.dtype == np.uint64:
        wave.write(number, (result & _Q(0xffffffff)).astype(_U))
        wave.write(number + 1, (result >> _Q(32)).astype(_U))
    else:
        wave.write(number, result.view(_U))


def _target(instruction, place=0):
    operand = parse(instruction.operands[place])
    if operand.kind != "v":
        raise UnknownInstruction(f"result of {instruction.text}")
    return operand.number


def _value(instruction, name, wave_size):
    """A function from a wave to the result of an instruction that has one, and the register it goes to."""
    texts = instruction.operands[1:]
    if name in ACCUMULATING:
        kinds, function = ACCUMULATING[name]
        texts = (*texts, instruction.operands[0])
    elif name in OPERATIONS:
        kinds, function = OPERATIONS[name]
    else:
        return None
    _check_modifiers(instruction, _PART_MODIFIERS | _RESULT_MODIFIERS)
    sources = _sources(instruction, texts, kinds, wave_size)
    return lambda wave: _finished(instruction, function(*[source(wave) for source in sources])), _target(instruction)


def _dual(halves, wave_size):
    """Two instructions that are issued together: both read before either writes."""
    decoded = []
    for half in halves:
        found = _value(half, common_name(half.mnemonic.replace("v_dual_", "v_")), wave_size)
        if not found:
            raise UnknownInstruction(half.text)
        decoded.append(found)
    (first, first_target), (second, second_target) = decoded

    def execute(wave):
        one, two = first(wave), second(wave).copy()
        _write(wave, first_target, one)
        _write(wave, second_target, two)
    return execute


def _compare(instruction, name, wave_size):
    """v_cmp_ and v_cmpx_: one bit a lane; the latter turns the lanes off that do not meet it."""
    match = re.fullmatch(r"v_cmp(x?)_(\w+)_([fiu])(32|64)", name)
    if not match:
        return None
    restricts, relation, kind, bits = match.groups()
    _check_modifiers(instruction, {"src0_sel", "src1_sel"})
    texts = instruction.operands[-2:]
    wide = bits == "64"
    if relation == "class":
        kinds, function = "fu", floats.is_of_class
    elif kind == "f":
        if wide:
            return None
        kinds, function = "ff", floats.FLOAT_RELATIONS.get(relation)
    elif wide:
        plain = floats.WHOLE_RELATIONS.get(relation)
        kinds = "qq"
        function = plain if kind == "u" else plain and (lambda a, b: plain(a.view(np.int64), b.view(np.int64)))
    else:
        kinds, function = kind * 2, floats.WHOLE_RELATIONS.get(relation)
    if not function:
        return None
    first, second = _sources(instruction, texts, kinds, wave_size)
    write = None if len(instruction.operands) == 2 else lane_mask_target(parse(instruction.operands[0]), wave_size)

    def execute(wave):
        met = function(first(wave), second(wave))
        if write:
            write(wave, met)
        if restricts:
            wave.restrict(met)
    return execute


def _with_carry(instruction, name, wave_size):
    kinds, function = _CARRYING[name]
    _check_modifiers(instruction, ())
    target, texts = _target(instruction), instruction.operands[2:]
    sources = _sources(instruction, texts, kinds, wave_size)
    write_carry = lane_mask_target(parse(instruction.operands[1]), wave_size)

    def execute(wave):
        # As 64-bit numbers, where what 32 bits do not hold shows.
        result = function(*[source(wave).astype(np.int64) for source in sources])
        carry = (result < 0) | (result > 0xffffffff)
        wave.write(target, (result & 0xffffffff).astype(_U))
        write_carry(wave, carry)
    return execute


def _multiply_add_64(instruction, wave_size):
    """v_mad_u64_u32: a·b + c in 64 bits, and the carry of that."""
    _check_modifiers(instruction, ())
    target, write_carry = _target(instruction), lane_mask_target(parse(instruction.operands[1]), wave_size)
    first, second, third = _sources(instruction, instruction.operands[2:], "uuq", wave_size)

    def execute(wave):
        product = first(wave).astype(_Q) * second(wave).astype(_Q)
        total = product + third(wave)
        _write(wave, target, total)
        write_carry(wave, total < product)
    return execute


def _division_scale(instruction, wave_size):
    _check_modifiers(instruction, ())
    target, write_undo = _target(instruction), lane_mask_target(parse(instruction.operands[1]), wave_size)
    sources = _sources(instruction, instruction.operands[2:], "fff", wave_size)

    def execute(wave):
        value, undo = floats.division_scale(*[source(wave) for source in sources])
        wave.write(target, value.view(_U))
        write_undo(wave, undo)
    return execute


def _numbers(instruction, name, default):
    return [int(n) for n in instruction.modifiers.get(name, default)[1:-1].split(",")]


def _packed(instruction, function, wave_size):
    """One operation on each half of pairs; op_sel says which half of a source a half of the result takes."""
    _check_modifiers(instruction, {"op_sel", "op_sel_hi", "neg_lo", "neg_hi"})
    target, operands = _target(instruction), [parse(text) for text in instruction.operands[1:]]
    halves = []
    for choice, default, negation in (("op_sel", "[0,0,0]", "neg_lo"), ("op_sel_hi", "[1,1,1]", "neg_hi")):
        chosen, negated = _numbers(instruction, choice, default), _numbers(instruction, negation, "[0,0,0]")
        readers = []
        for operand, offset, negate in zip(operands, chosen, negated):
            # A constant is the same for both halves.
            half = operand.register(offset) if operand.kind in "vs" else operand
            read = lanes(half, "f", wave_size)
            readers.append((lambda wave, read=read: -read(wave)) if negate else read)
        halves.append(readers)

    def execute(wave):
        low, high = [function(*[read(wave) for read in readers]).copy() for readers in halves]
        wave.write(target, low.view(_U))
        wave.write(target + 1, high.view(_U))
    return execute


def _packed_move(instruction, wave_size):
    _check_modifiers(instruction, {"op_sel", "op_sel_hi"})
    target = _target(instruction)
    choice = _numbers(instruction, "op_sel", "[0,0]")
    readers = []
    for text, offset in zip(instruction.operands[1:], choice):
        operand = parse(text)
        readers.append(lanes(operand.register(offset) if operand.kind in "vs" else operand, "u", wave_size))

    def execute(wave):
        low, high = [read(wave).copy() for read in readers]
        wave.write(target, low)
        wave.write(target + 1, high)
    return execute


def _read_lane(instruction, name, wave_size):
    """One lane's value to a scalar register: of the first lane that is on, or of a lane with a number."""
    write, read = scalar_target(parse(instruction.operands[0])), lanes(parse(instruction.operands[1]), "u", wave_size)
    lane = scalar(parse(instruction.operands[2])) if name == "v_readlane_b32" else lambda wave: wave.first_lane()

    def execute(wave):
        values = read(wave)
        write(wave, int(values[lane(wave) % wave_size if len(values) > 1 else 0]))
    return execute


def _write_lane(instruction, wave_size):
    target = _target(instruction)
    value, lane = scalar(parse(instruction.operands[1])), scalar(parse(instruction.operands[2]))

    def execute(wave):
        wave.vectors[target][lane(wave) % wave_size] = value(wave)
    return execute


def _of_scalar(instruction, name):
    """v_s_exp_f32 and the like: what the vector instruction does, of a scalar register."""
    function = OPERATIONS["v_" + name.removeprefix("v_s_")][1]
    read = lanes(parse(instruction.operands[1]), "f", 32)
    write = scalar_target(parse(instruction.operands[0]))
    return lambda wave: write(wave, int(function(read(wave)).view(_U)[0]))


def decode(instruction, halves, wave_size):
    """What a vector instruction does to a wave, or None. `halves`: of a pair that is issued together."""
    if halves:
        return _dual(halves, wave_size)
    name = common_name(instruction.mnemonic)
    if found := _value(instruction, name, wave_size):
        value, target = found
        return lambda wave: _write(wave, target, value(wave))
    if name in _CARRYING:
        return _with_carry(instruction, name, wave_size)
    if name in _PACKED:
        return _packed(instruction, _PACKED[name], wave_size)
    if name in ("v_readfirstlane_b32", "v_readlane_b32"):
        return _read_lane(instruction, name, wave_size)
    if re.fullmatch("v_s_(exp|log|rcp|rsq|sqrt)_f32", name):
        return _of_scalar(instruction, name)
    others = {"v_mad_u64_u32": _multiply_add_64, "v_div_scale_f32": _division_scale, "v_pk_mov_b32": _packed_move,
              "v_writelane_b32": _write_lane}
    if name in others:
        return others[name](instruction, wave_size)
    return _compare(instruction, name, wave_size)
