# SPDX-License-Identifier: MIT
"""Vector instructions with one result that depends on their sources in the same lane alone: what they compute."""
import numpy as np
import float_arithmetic as floats
from assembly import UnknownInstruction

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
OPERATIONS = {
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
ACCUMULATING = {"v_fmac_f32": ("fff", floats.fma)}
