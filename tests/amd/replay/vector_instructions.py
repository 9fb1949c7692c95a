# SPDX-License-Identifier: MIT
"""Vector instructions: one value a lane, and lanes that are off keep what they had."""
import re

import numpy as np
import float_arithmetic as floats
from assembly import UnknownInstruction, common_name
from operands import VCC, Operand, lane_mask_target, lanes, parse, scalar, scalar_target

_U, _I, _F, _Q = np.uint32, np.int32, np.float32, np.uint64


def _low_24(x):
    return x & _U(0xffffff)


def _low_24_signed(x):
    return (x << _U(8)).view(_I) >> _I(8)


def _shift(amount, bits=32):
    return amount & amount.dtype.type(bits - 1)


def _unsigned_field(x, first, width):
    return x >> _shift(first) & ((_U(1) << _shift(width)) - _U(1))


def _signed_field(x, first, width):
    width = _shift(width)
    rest = _shift(_U(32) - width)
    field = (_unsigned_field(x, first, width) << rest).view(_I) >> rest.view(_I)
    return np.where(width == 0, _I(0), field)


def _permuted_bytes(high, low, selectors):
    both = high.astype(_Q) << _Q(32) | low.astype(_Q)
    result = _U(0)
    for place in range(4):
        selector = selectors >> _U(8 * place) & _U(0xff)
        if ((selector > 7) & (selector < 12)).any():
            raise UnknownInstruction("v_perm_b32 with the sign of a byte")
        byte = (both >> (selector & _U(7)).astype(_Q) * _Q(8)).astype(_U) & _U(0xff)
        filled = np.where(selector == 12, _U(0), _U(0xff))
        result = result | np.where(selector <= 7, byte, filled) << _U(8 * place)
    return result


def _reversed_bits(x):
    return np.array([int(f"{int(word):032b}"[::-1], 2) for word in x], _U)


def _multiplied_high(a, b):
    return (a.astype(_Q) * b.astype(_Q) >> _Q(32)).astype(_U)


# Kinds of the sources, as operands.lanes names them, and the result: 32 bits, or 64 in two registers.
_OPERATIONS = {
    "v_mov_b32": ("b", lambda a: a),
    "v_mov_b64": ("q", lambda a: a),
    "v_add_f32": ("ff", lambda a, b: a + b),
    "v_sub_f32": ("ff", lambda a, b: a - b),
    "v_subrev_f32": ("ff", lambda a, b: b - a),
    "v_mul_f32": ("ff", lambda a, b: a * b),
    "v_max_f32": ("ff", floats.greater),
    "v_min_f32": ("ff", floats.less),
    "v_max3_f32": ("fff", lambda a, b, c: floats.greater(floats.greater(a, b), c)),
    "v_min3_f32": ("fff", lambda a, b, c: floats.less(floats.less(a, b), c)),
    "v_minmax_f32": ("fff", lambda a, b, c: floats.greater(floats.less(a, b), c)),
    "v_maxmin_f32": ("fff", lambda a, b, c: floats.less(floats.greater(a, b), c)),
    "v_med3_f32": ("fff", floats.median),
    "v_fma_f32": ("fff", floats.fma),
    "v_fmaak_f32": ("fff", floats.fma),
    "v_fmamk_f32": ("fff", floats.fma),
    "v_rcp_f32": ("f", lambda a: _F(1) / a),
    "v_rcp_iflag_f32": ("f", lambda a: _F(1) / a),
    "v_rsq_f32": ("f", floats.in_double(lambda a: 1 / np.sqrt(a))),
    "v_sqrt_f32": ("f", np.sqrt),
    "v_exp_f32": ("f", floats.in_double(np.exp2)),
    "v_log_f32": ("f", floats.in_double(np.log2)),
    "v_rndne_f32": ("f", np.rint),
    "v_trunc_f32": ("f", np.trunc),
    "v_floor_f32": ("f", np.floor),
    "v_ceil_f32": ("f", np.ceil),
    "v_fract_f32": ("f", lambda a: a - np.floor(a)),
    "v_frexp_mant_f32": ("f", floats.mantissa),
    "v_frexp_exp_i32_f32": ("f", floats.mantissa_exponent),
    "v_ldexp_f32": ("fi", floats.scaled_by_power),
    "v_cvt_f32_i32": ("i", lambda a: a.astype(_F)),
    "v_cvt_f32_u32": ("u", lambda a: a.astype(_F)),
    "v_cvt_i32_f32": ("f", floats.to_int),
    "v_cvt_u32_f32": ("f", floats.to_uint),
    "v_div_fmas_f32": ("fffm", floats.division_fma),
    "v_div_fixup_f32": ("fff", floats.division_fixup),
    "v_cndmask_b32": ("bbm", lambda a, b, chosen: np.where(chosen, b, a)),
    "v_and_b32": ("uu", lambda a, b: a & b),
    "v_or_b32": ("uu", lambda a, b: a | b),
    "v_xor_b32": ("uu", lambda a, b: a ^ b),
    "v_xnor_b32": ("uu", lambda a, b: ~(a ^ b)),
    "v_not_b32": ("u", lambda a: ~a),
    "v_bfrev_b32": ("u", _reversed_bits),
    "v_lshlrev_b32": ("uu", lambda a, b: b << _shift(a)),
    "v_lshrrev_b32": ("uu", lambda a, b: b >> _shift(a)),
    "v_ashrrev_i32": ("ui", lambda a, b: b >> _shift(a).view(_I)),
    "v_lshlrev_b64": ("uq", lambda a, b: b << _shift(a, 64).astype(_Q)),
    "v_lshrrev_b64": ("uq", lambda a, b: b >> _shift(a, 64).astype(_Q)),
    "v_lshl_add_u64": ("quq", lambda a, b, c: (a << (b & _U(7)).astype(_Q)) + c),
    "v_add_nc_u32": ("uu", lambda a, b: a + b),
    "v_add_nc_i32": ("uu", lambda a, b: a + b),
    "v_sub_nc_u32": ("uu", lambda a, b: a - b),
    "v_subrev_nc_u32": ("uu", lambda a, b: b - a),
    "v_add3_u32": ("uuu", lambda a, b, c: a + b + c),
    "v_lshl_add_u32": ("uuu", lambda a, b, c: (a << _shift(b)) + c),
    "v_add_lshl_u32": ("uuu", lambda a, b, c: (a + b) << _shift(c)),
    "v_lshl_or_b32": ("uuu", lambda a, b, c: a << _shift(b) | c),
    "v_and_or_b32": ("uuu", lambda a, b, c: a & b | c),
    "v_or3_b32": ("uuu", lambda a, b, c: a | b | c),
    "v_xad_u32": ("uuu", lambda a, b, c: (a ^ b) + c),
    "v_mul_lo_u32": ("uu", lambda a, b: a * b),
    "v_mul_hi_u32": ("uu", _multiplied_high),
    "v_mul_u32_u24": ("uu", lambda a, b: _low_24(a) * _low_24(b)),
    "v_mad_u32_u24": ("uuu", lambda a, b, c: _low_24(a) * _low_24(b) + c),
    "v_mul_i32_i24": ("uu", lambda a, b: _low_24_signed(a) * _low_24_signed(b)),
    "v_mad_i32_i24": ("uui", lambda a, b, c: _low_24_signed(a) * _low_24_signed(b) + c),
    "v_min_u32": ("uu", np.minimum),
    "v_max_u32": ("uu", np.maximum),
    "v_min_i32": ("ii", np.minimum),
    "v_max_i32": ("ii", np.maximum),
    "v_min3_u32": ("uuu", lambda a, b, c: np.minimum(np.minimum(a, b), c)),
    "v_max3_u32": ("uuu", lambda a, b, c: np.maximum(np.maximum(a, b), c)),
    "v_min3_i32": ("iii", lambda a, b, c: np.minimum(np.minimum(a, b), c)),
    "v_max3_i32": ("iii", lambda a, b, c: np.maximum(np.maximum(a, b), c)),
    "v_bfe_u32": ("uuu", _unsigned_field),
    "v_bfe_i32": ("uuu", _signed_field),
    "v_bfi_b32": ("uuu", lambda a, b, c: a & b | ~a & c),
    "v_perm_b32": ("uuu", _permuted_bytes),
}
# d += a·b: the result is a source too.
_ACCUMULATING = {"v_fmac_f32": ("fff", floats.fma)}
# Sum or difference, and its carry.
_CARRYING = {
    "v_add_co_u32": ("qq", lambda a, b: a + b),
    "v_sub_co_u32": ("qq", lambda a, b: a - b),
    "v_subrev_co_u32": ("qq", lambda a, b: b - a),
    "v_add_co_ci_u32": ("qqm", lambda a, b, carry: a + b + carry),
    "v_sub_co_ci_u32": ("qqm", lambda a, b, carry: a - b - carry),
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
    if name in _ACCUMULATING:
        kinds, function = _ACCUMULATING[name]
        texts = (*texts, instruction.operands[0])
    elif name in _OPERATIONS:
        kinds, function = _OPERATIONS[name]
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
    # As 64-bit numbers, so that the carry is one of their bits.
    sources = _sources(instruction, texts, kinds.replace("q", "u"), wave_size)
    write_carry = lane_mask_target(parse(instruction.operands[1]), wave_size)

    def execute(wave):
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


def _scalar_transcendental(instruction):
    """v_s_exp_f32: of a scalar register."""
    read = lanes(parse(instruction.operands[1]), "f", 32)
    write = scalar_target(parse(instruction.operands[0]))
    return lambda wave: write(wave, int(_OPERATIONS["v_exp_f32"][1](read(wave)).view(_U)[0]))


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
    if name == "v_s_exp_f32":
        return _scalar_transcendental(instruction)
    others = {"v_mad_u64_u32": _multiply_add_64, "v_div_scale_f32": _division_scale, "v_pk_mov_b32": _packed_move,
              "v_writelane_b32": _write_lane}
    if name in others:
        return others[name](instruction, wave_size)
    return _compare(instruction, name, wave_size)
