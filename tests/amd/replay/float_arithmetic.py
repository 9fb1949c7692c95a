# SPDX-License-Identifier: MIT
"""What single-precision instructions compute, on numpy arrays of one entry a lane.

Exactly rounded, denormals kept. Of the device's own approximations (v_rcp_f32, v_rsq_f32, v_sqrt_f32, v_exp_f32,
v_log_f32), which may be off by a unit in the last place, these are the exact values.
"""
import numpy as np

_SMALLEST_NORMAL = np.float32(2.0**-126)


def _exponent(x):
    return (x.view(np.uint32) >> np.uint32(23) & np.uint32(255)).astype(np.int32)


def fma(a, b, c):
    """a·b + c with one rounding: the product of two floats is exact in 64 bits, their sum is rounded to odd there."""
    a, b, c = np.broadcast_arrays(a.astype("f8"), b.astype("f8"), c.astype("f8"))
    product = a * b
    total = product + c
    back = total - product
    error = (product - (total - back)) + (c - back)
    inexact = np.isfinite(total) & np.isfinite(error) & (error != 0)
    if inexact.any():
        towards_zero = np.where((error > 0) == (total > 0), total, np.nextafter(total, 0.0))
        total = np.where(inexact, (towards_zero.view(np.uint64) | np.uint64(1)).view("f8"), total)
    return total.astype(np.float32)


def greater(a, b):
    """A number rather than NaN, +0 rather than −0."""
    zeros = (a == 0) & (b == 0)
    return np.where(zeros, np.where(np.signbit(a), b, a), np.fmax(a, b))


def less(a, b):
    """A number rather than NaN, −0 rather than +0."""
    zeros = (a == 0) & (b == 0)
    return np.where(zeros, np.where(np.signbit(a), a, b), np.fmin(a, b))


def median(a, b, c):
    missing = np.isnan(a) | np.isnan(b) | np.isnan(c)
    return np.where(missing, less(less(a, b), c), greater(less(a, b), less(greater(a, b), c)))


def in_double(function):
    """`function` with one rounding to single precision at its end."""
    return lambda x: function(x.astype("f8")).astype(np.float32)


def to_int(x):
    """Towards zero, clamped; NaN is 0."""
    whole = np.nan_to_num(np.trunc(x.astype("f8")), nan=0.0)
    return np.clip(whole, -2.0**31, 2.0**31 - 1).astype(np.int64).astype(np.int32)


def to_uint(x):
    whole = np.nan_to_num(np.trunc(x.astype("f8")), nan=0.0)
    return np.clip(whole, 0.0, 2.0**32 - 1).astype(np.uint64).astype(np.uint32)


def mantissa(x):
    return np.where(np.isfinite(x), np.frexp(x)[0], x).astype(np.float32)


def mantissa_exponent(x):
    return np.where(np.isfinite(x), np.frexp(x)[1], 0).astype(np.int32)


def scaled_by_power(x, exponent):
    return np.ldexp(x.astype("f8"), np.clip(exponent, -400, 400)).astype(np.float32)


def division_scale(scaled, denominator, numerator):
    """v_div_scale_f32: one of the two, times a power of two where the quotient would lose bits, and whether
    v_div_fmas_f32 has to take it back."""
    scaled, denominator, numerator = np.broadcast_arrays(scaled, denominator, numerator)
    up, down = scaled * np.float32(2.0**64), scaled * np.float32(2.0**-64)
    inverse_is_denormal = ((np.abs(1 / denominator.astype("f8")) < _SMALLEST_NORMAL) & (denominator != 0) &
                           np.isfinite(denominator))
    quotient = np.abs(numerator.astype("f8") / denominator.astype("f8"))
    quotient_is_denormal = (quotient < _SMALLEST_NORMAL) & (quotient > 0)
    denominator_is_denormal = (np.abs(denominator) < _SMALLEST_NORMAL) & (denominator != 0)
    cases = [
        ((numerator == 0) | (denominator == 0), np.full_like(scaled, np.nan), False),
        (_exponent(numerator) - _exponent(denominator) >= 96, np.where(scaled == denominator, up, scaled), True),
        (denominator_is_denormal, up, False),
        (inverse_is_denormal & quotient_is_denormal, np.where(scaled == denominator, up, scaled), True),
        (inverse_is_denormal, down, False),
        (quotient_is_denormal, np.where(scaled == numerator, up, scaled), True),
        (_exponent(numerator) <= 23, up, False)]
    conditions = [condition for condition, _, _ in cases]
    value = np.select(conditions, [value for _, value, _ in cases], scaled)
    undo = np.select(conditions, [np.full(scaled.shape, undo) for _, _, undo in cases], False)
    return value.astype(np.float32), undo


def division_fma(a, b, c, undo):
    """v_div_fmas_f32: a·b + c, with the scale of v_div_scale_f32 taken back."""
    result = fma(a, b, c)
    back = np.where(_exponent(c) > 127, result * np.float32(2.0**64), result * np.float32(2.0**-64))
    return np.where(undo, back, result).astype(np.float32)


def division_fixup(quotient, denominator, numerator):
    """v_div_fixup_f32: the quotient, but for the cases that the steps before it get wrong."""
    quotient, denominator, numerator = np.broadcast_arrays(quotient, denominator, numerator)
    sign = np.where(np.signbit(denominator) ^ np.signbit(numerator), np.float32(-1), np.float32(1))
    result = np.copysign(np.abs(quotient), sign)
    result = np.where(_exponent(numerator) - _exponent(denominator) < -150, sign * np.float32(0),
                      np.where(_exponent(denominator) == 255, sign * np.float32(np.inf), result))
    result = np.where(np.isinf(numerator) | (denominator == 0), sign * np.float32(np.inf), result)
    result = np.where(np.isinf(denominator) | (numerator == 0), sign * np.float32(0), result)
    undefined = (((denominator == 0) & (numerator == 0)) | (np.isinf(denominator) & np.isinf(numerator)) |
                 np.isnan(denominator) | np.isnan(numerator))
    return np.where(undefined, np.float32(np.nan), result).astype(np.float32)


# The bits by which v_cmp_class_f32 asks, in order.
_CLASSES = (lambda x, quiet, normal: np.isnan(x) & ~quiet,
            lambda x, quiet, normal: np.isnan(x) & quiet,
            lambda x, quiet, normal: np.isneginf(x),
            lambda x, quiet, normal: normal & (x < 0),
            lambda x, quiet, normal: np.isfinite(x) & ~normal & (x < 0),
            lambda x, quiet, normal: (x == 0) & np.signbit(x),
            lambda x, quiet, normal: (x == 0) & ~np.signbit(x),
            lambda x, quiet, normal: np.isfinite(x) & ~normal & (x > 0),
            lambda x, quiet, normal: normal & (x > 0),
            lambda x, quiet, normal: np.isposinf(x))


def is_of_class(x, wanted):
    """Whether x is of a class that has its bit set in `wanted`."""
    quiet = (x.view(np.uint32) >> np.uint32(22) & np.uint32(1)).astype(bool)
    normal = np.isfinite(x) & (np.abs(x) >= _SMALLEST_NORMAL)
    found = np.zeros(np.broadcast_shapes(x.shape, wanted.shape), bool)
    for bit, belongs in enumerate(_CLASSES):
        found |= belongs(x, quiet, normal) & ((wanted >> np.uint32(bit) & np.uint32(1)) != 0)
    return found


FLOAT_RELATIONS = {
    "lt": lambda a, b: a < b, "eq": lambda a, b: a == b, "le": lambda a, b: a <= b, "gt": lambda a, b: a > b,
    "ge": lambda a, b: a >= b, "lg": lambda a, b: (a < b) | (a > b),
    "o": lambda a, b: ~(np.isnan(a) | np.isnan(b)), "u": lambda a, b: np.isnan(a) | np.isnan(b),
    "nlt": lambda a, b: ~(a < b), "neq": lambda a, b: ~(a == b), "nle": lambda a, b: ~(a <= b),
    "ngt": lambda a, b: ~(a > b), "nge": lambda a, b: ~(a >= b), "nlg": lambda a, b: ~((a < b) | (a > b))}
WHOLE_RELATIONS = {
    "lt": lambda a, b: a < b, "eq": lambda a, b: a == b, "le": lambda a, b: a <= b, "gt": lambda a, b: a > b,
    "ge": lambda a, b: a >= b, "ne": lambda a, b: a != b, "lg": lambda a, b: a != b}
