# SPDX-License-Identifier: MIT
"""Scalar instructions: one value a wave, as Python's whole numbers; scc is the bit that comparisons and carries set."""
import re

import numpy as np
import float_arithmetic as floats
from assembly import UnknownInstruction, common_name
from operands import WORD, parse, scalar, scalar_target


def _signed(x, bits=32):
    return x - (1 << bits) if x >> bits - 1 & 1 else x


def _with_zero_test(function, bits):
    """The result, and scc where it is not zero."""
    def compute(*sources):
        result = function(*sources) & (1 << bits) - 1
        return result, int(result != 0)
    return compute


def _field(x, place, bits, signed):
    first, width = place & bits - 1, place >> 16 & 0x7f
    field = x >> first & (1 << width) - 1
    return field - (1 << width) if signed and width and field >> width - 1 else field


def _overflowing(total):
    return total, int(not -2**31 <= total < 2**31)


def _carrying(total):
    return total, int(not 0 <= total <= WORD)


def _float(function):
    """On single-precision floats in scalar registers."""
    def compute(*sources):
        values = [np.array([x], np.uint32).view(np.float32) for x in sources]
        return int(np.asarray(function(*values), np.float32).view(np.uint32)[0])
    return compute


def _from_float(function):
    return lambda x: int(function(np.array([x], np.uint32).view(np.float32))[0])


# name: (32-bit words of the result, those of each source, function). The function gives the result, or the result and
# scc.
_OPERATIONS = {
    "s_mov_b32": (1, (1,), lambda a: a),
    "s_mov_b64": (2, (2,), lambda a: a),
    "s_movk_i32": (1, (1,), lambda a: _signed(a & 0xffff, 16)),
    "s_add_u32": (1, (1, 1), lambda a, b: _carrying(a + b)),
    "s_sub_u32": (1, (1, 1), lambda a, b: _carrying(a - b)),
    "s_add_i32": (1, (1, 1), lambda a, b: _overflowing(_signed(a) + _signed(b))),
    "s_sub_i32": (1, (1, 1), lambda a, b: _overflowing(_signed(a) - _signed(b))),
    "s_absdiff_i32": (1, (1, 1), _with_zero_test(lambda a, b: abs(_signed(a) - _signed(b)), 32)),
    "s_abs_i32": (1, (1,), _with_zero_test(lambda a: abs(_signed(a)), 32)),
    "s_add_nc_u64": (2, (2, 2), lambda a, b: a + b),
    "s_sub_nc_u64": (2, (2, 2), lambda a, b: a - b),
    "s_add_u64": (2, (2, 2), lambda a, b: a + b),
    "s_sub_u64": (2, (2, 2), lambda a, b: a - b),
    "s_mul_u64": (2, (2, 2), lambda a, b: a * b),
    "s_mul_i32": (1, (1, 1), lambda a, b: a * b),
    "s_mul_hi_u32": (1, (1, 1), lambda a, b: a * b >> 32),
    "s_mul_hi_i32": (1, (1, 1), lambda a, b: _signed(a) * _signed(b) >> 32),
    "s_min_u32": (1, (1, 1), lambda a, b: (min(a, b), int(a < b))),
    "s_max_u32": (1, (1, 1), lambda a, b: (max(a, b), int(a > b))),
    "s_min_i32": (1, (1, 1), lambda a, b: (min(_signed(a), _signed(b)), int(_signed(a) < _signed(b)))),
    "s_max_i32": (1, (1, 1), lambda a, b: (max(_signed(a), _signed(b)), int(_signed(a) > _signed(b)))),
    "s_bfm_b32": (1, (1, 1), lambda a, b: ((1 << (a & 31)) - 1) << (b & 31)),
    "s_brev_b32": (1, (1,), lambda a: int(f"{a:032b}"[::-1], 2)),
    "s_ctz_i32_b32": (1, (1,), lambda a: (a & -a).bit_length() - 1 if a else WORD),
    "s_ctz_i32_b64": (1, (2,), lambda a: (a & -a).bit_length() - 1 if a else WORD),
    "s_bcnt1_i32_b32": (1, (1,), lambda a: (bin(a).count("1"), int(a != 0))),
    "s_bcnt1_i32_b64": (1, (2,), lambda a: (bin(a).count("1"), int(a != 0))),
    "s_sext_i32_i16": (1, (1,), lambda a: _signed(a & 0xffff, 16)),
    "s_sext_i32_i8": (1, (1,), lambda a: _signed(a & 0xff, 8)),
    "s_add_f32": (1, (1, 1), _float(lambda a, b: a + b)),
    "s_sub_f32": (1, (1, 1), _float(lambda a, b: a - b)),
    "s_mul_f32": (1, (1, 1), _float(lambda a, b: a * b)),
    "s_max_f32": (1, (1, 1), _float(floats.greater)),
    "s_min_f32": (1, (1, 1), _float(floats.less)),
    "s_fmaak_f32": (1, (1, 1, 1), _float(floats.fma)),
    "s_fmamk_f32": (1, (1, 1, 1), _float(floats.fma)),
    "s_rndne_f32": (1, (1,), _float(np.rint)),
    "s_trunc_f32": (1, (1,), _float(np.trunc)),
    "s_floor_f32": (1, (1,), _float(np.floor)),
    "s_ceil_f32": (1, (1,), _float(np.ceil)),
    "s_cvt_f32_u32": (1, (1,), lambda a: int(np.array([a], np.uint32).astype(np.float32).view(np.uint32)[0])),
    "s_cvt_f32_i32": (1, (1,), lambda a: int(np.array([_signed(a)], np.int32).astype(np.float32).view(np.uint32)[0])),
    "s_cvt_u32_f32": (1, (1,), _from_float(floats.to_uint)),
    "s_cvt_i32_f32": (1, (1,), _from_float(floats.to_int)),
}
for _bits in (32, 64):
    _words = _bits // 32
    for _name, _function in {
            "not_b": lambda a: ~a, "and_b": lambda a, b: a & b, "or_b": lambda a, b: a | b, "xor_b": lambda a, b: a ^ b,
            "nand_b": lambda a, b: ~(a & b), "nor_b": lambda a, b: ~(a | b), "xnor_b": lambda a, b: ~(a ^ b),
            "and_not1_b": lambda a, b: a & ~b, "or_not1_b": lambda a, b: a | ~b}.items():
        _sources = (_words,) * _function.__code__.co_argcount
        _OPERATIONS[f"s_{_name}{_bits}"] = (_words, _sources, _with_zero_test(_function, _bits))
    for _name, _function in {
            "lshl_b": lambda a, b, bits=_bits: a << (b & bits - 1),
            "lshr_b": lambda a, b, bits=_bits: a >> (b & bits - 1),
            "ashr_i": lambda a, b, bits=_bits: _signed(a, bits) >> (b & bits - 1),
            "bfe_u": lambda a, b, bits=_bits: _field(a, b, bits, False),
            "bfe_i": lambda a, b, bits=_bits: _field(a, b, bits, True)}.items():
        _OPERATIONS[f"s_{_name}{_bits}"] = (_words, (_words, 1), _with_zero_test(_function, _bits))
for _shift in (1, 2, 3, 4):
    _OPERATIONS[f"s_lshl{_shift}_add_u32"] = (1, (1, 1), lambda a, b, shift=_shift: _carrying((a << shift) + b))

# The result is the first source too.
_ACCUMULATING = {
    "s_fmac_f32": (1, (1, 1, 1), _float(lambda d, a, b: floats.fma(a, b, d))),
    "s_addk_i32": (1, (1, 1), lambda d, a: _overflowing(_signed(d) + _signed(a & 0xffff, 16))),
    "s_mulk_i32": (1, (1, 1), lambda d, a: _signed(d) * _signed(a & 0xffff, 16)),
    "s_bitset0_b32": (1, (1, 1), lambda d, a: d & ~(1 << (a & 31))),
    "s_bitset1_b32": (1, (1, 1), lambda d, a: d | 1 << (a & 31)),
}
# scc is a source too, the first.
_WITH_SCC = {
    "s_addc_u32": (1, (1, 1), lambda scc, a, b: _carrying(a + b + scc)),
    "s_subb_u32": (1, (1, 1), lambda scc, a, b: _carrying(a - b - scc)),
    "s_cselect_b32": (1, (1, 1), lambda scc, a, b: a if scc else b),
    "s_cselect_b64": (2, (2, 2), lambda scc, a, b: a if scc else b),
}
# exec and a mask to a new exec.
_MASKS = {
    "and": lambda a, e: a & e, "or": lambda a, e: a | e, "xor": lambda a, e: a ^ e, "and_not1": lambda a, e: a & ~e,
    "or_not1": lambda a, e: a | ~e, "and_not0": lambda a, e: ~a & e, "or_not0": lambda a, e: ~a | e}


def _saveexec(instruction, name):
    match = re.fullmatch(r"s_(\w+)_saveexec_b(32|64)", name)
    if not match or match[1] not in _MASKS:
        return None
    bits = int(match[2])
    words, function, all_bits = bits // 32, _MASKS[match[1]], (1 << bits) - 1
    write, read = scalar_target(parse(instruction.operands[0]), words), scalar(parse(instruction.operands[1]), words)

    def execute(wave):
        mask, before = read(wave), wave.exec_mask()
        write(wave, before)
        after = function(mask, before) & all_bits
        wave.set_exec(after)
        wave.scc = int(after != 0)
    return execute


def _compare(instruction, name):
    if match := re.fullmatch(r"s_bitcmp([01])_b32", name):
        wanted = int(match[1])
        word, bit = [scalar(parse(text)) for text in instruction.operands]

        def test(wave):
            wave.scc = int((word(wave) >> (bit(wave) & 31) & 1) == wanted)
        return test
    match = re.fullmatch(r"s_cmp(k?)_(\w+)_([fiu])(32|64)", name)
    if not match:
        return None
    short, relation, kind, bits = match[1], match[2], match[3], int(match[4])
    function = (floats.FLOAT_RELATIONS if kind == "f" else floats.WHOLE_RELATIONS).get(relation)
    if not function or (kind == "f" and bits == 64):
        return None
    first, second = [scalar(parse(text), bits // 32) for text in instruction.operands]

    def execute(wave):
        a, b = first(wave), second(wave)
        if short:
            b = _signed(b & 0xffff, 16) & WORD if kind == "i" else b & 0xffff
        if kind == "f":
            a, b = [np.array([x], np.uint32).view(np.float32) for x in (a, b)]
        elif kind == "i":
            a, b = _signed(a, bits), _signed(b, bits)
        wave.scc = int(bool(function(a, b)))
    return execute


def decode(instruction):
    """What a scalar instruction that touches no memory does to a wave, or None."""
    name = common_name(instruction.mnemonic)
    if instruction.modifiers:
        raise UnknownInstruction(f"modifiers of {instruction.text}")
    texts, with_scc = instruction.operands[1:], False
    if name in _OPERATIONS:
        words, sources, function = _OPERATIONS[name]
    elif name in _ACCUMULATING:
        words, sources, function = _ACCUMULATING[name]
        texts = instruction.operands
    elif name in _WITH_SCC:
        words, sources, function = _WITH_SCC[name]
        with_scc = True
    else:
        return _saveexec(instruction, name) or _compare(instruction, name)
    if len(texts) != len(sources):
        raise UnknownInstruction(f"operands of {instruction.text}")
    write = scalar_target(parse(instruction.operands[0]), words)
    readers = [_reader(text, words_of_it) for text, words_of_it in zip(texts, sources)]

    def execute(wave):
        values = [read(wave) for read in readers]
        result = function(wave.scc, *values) if with_scc else function(*values)
        if isinstance(result, tuple):
            result, wave.scc = result
        write(wave, result)
    return execute


def _reader(text, words):
    operand = parse(text)
    read = scalar(operand, words)
    if not operand.negated and not operand.absolute:
        return read
    if words != 1:
        raise UnknownInstruction(f"operand {text}")
    keep, flip = (WORD >> 1 if operand.absolute else WORD), (1 << 31 if operand.negated else 0)
    return lambda wave: read(wave) & keep ^ flip
