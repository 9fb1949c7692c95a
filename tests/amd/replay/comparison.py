# SPDX-License-Identifier: MIT
"""What a launch left in its buffers, against what pocl left there, number by number.

Whole numbers must be the same, and NaN and infinity in the same places. Floats may differ by a share of the greatest
number of their array or field: the two compilers contract products and sums, and divide, each in its own way. Within
one kernel that is a few roundings, and cancellation makes more of them. Kernels that iterate feed roundings back.
"""
import re
from functools import lru_cache

import numpy as np

TOLERANCE = 2e-6
TOLERANCES = {
    "assemble_gradients": 5e-5,  # a stretch at its ceiling is the difference of nearly equal numbers
    "finish_solve": 2e-4,  # up to 24 CG iterations, each of which amplifies the roundings of those before
    "filter_in_one_group": 5e-4,  # a whole call; velocities are differences of positions over a time step
}
# Vectors of a solve that has ended, near zero and of no more use.
LEFT_BY_SOLVES = {"filter_in_one_group": {"residual", "product", "direction", "direction_product"}}
# Of the caller's positions and velocities, where each launch starts from what the last one left.
WHOLE_CALL_TOLERANCE = 1e-3
# A gradient's components are whole numbers that a float was rounded to: it may lie on the edge between two.
GRADIENT_STEP = 1

_STRUCT = re.compile(r"typedef struct \{\n(.*?)\n\} (\w+);", re.DOTALL)
_FIELD = re.compile(r"(\w+) ([\w, \[\]]+);")
_TYPES = {"float": "f4", "float4": "f4", "uint": "u4", "uint2": "u4", "int": "i4", "ushort": "u2", "apslk_uint": "u4",
          "apslk_int": "i4", "short4": ("i2", 4)}


@lru_cache(maxsize=None)
def _structs(kernels):
    """{name: numpy type} of the structs in device memory, from the sources."""
    found = {}
    for header in ("layout.h", "gradients.h", "hinges.h"):
        text = re.sub(r"//.*", "", (kernels / header).read_text(encoding="utf-8"))
        for body, name in _STRUCT.findall(text):
            fields = []
            for kind, names in _FIELD.findall(body):
                for word in names.split(","):
                    field, _, count = word.strip().partition("[")
                    if kind == "float4":
                        fields.append((field, "f4", 4))
                    elif kind in _TYPES:
                        base = _TYPES[kind]
                        fields.append((field, base, int(count[:-1])) if count.rstrip("]").isdigit() else
                                      (field, *base) if isinstance(base, tuple) else (field, base))
            found[name] = np.dtype(fields)
    return found


def type_of(kernels, type_name):
    """numpy's type for what an OpenCL pointer points to; single bytes where it is not known."""
    name = type_name.rstrip("*").removeprefix("const ").strip()
    return np.dtype(_TYPES[name]) if name in _TYPES else _structs(kernels).get(name, np.dtype("u1"))


def _compare_floats(got, want, tolerance):
    got, want = got.astype("f8"), want.astype("f8")
    both = np.isfinite(got) & np.isfinite(want)
    same = both | (np.isnan(got) & np.isnan(want)) | (got == want)
    if not same.all():
        at = int(np.argmin(same))
        return 0.0, f"{int((~same).sum())} numbers, the first at {at}: {got[at]}, expected {want[at]}"
    if not both.any():
        return 0.0, None
    difference = np.where(both, np.abs(got - want), 0.0)
    greatest = np.abs(want[both]).max()
    share = difference.max() / greatest if greatest > 0 else difference.max()
    if not share <= tolerance:
        at = int(np.argmax(difference))
        return share, f"off by {share:.2g} of the greatest, at {at}: {got[at]}, expected {want[at]}"
    return share, None


def _compare_whole(got, want, step):
    difference = np.abs(got.astype(np.int64) - want.astype(np.int64))
    if difference.max(initial=0) > step:
        at = int(np.argmax(difference))
        return f"{int((difference > step).sum())} numbers, the first at {at}: {got[at]}, expected {want[at]}"
    return None


def tolerance_of(kernel):
    return TOLERANCES.get(kernel, TOLERANCE)


def compare_partials(kernels, want, got, cloths, tolerance):
    """The same of the partial results of all work-groups: each kind of them is an array of its own."""
    kinds = int(re.search(r"#define APSLK_PARTIAL_KINDS (\d+)", (kernels / "layout.h").read_text(encoding="utf-8"))[1])
    got, want = [np.frombuffer(x, np.float32).reshape(cloths, kinds, -1) for x in (got, want)]
    wrong, greatest = [], 0.0
    for kind in range(kinds):
        share, line = _compare_floats(got[:, kind].ravel(), want[:, kind].ravel(), tolerance)
        greatest = max(greatest, share)
        if line:
            wrong.append(f"kind {kind}: {line}")
    return greatest, wrong


def compare(kernels, want, got, type_name, tolerance):
    """The greatest difference of floats, as a share, and lines on what is wrong. `kernels`: folder of the sources;
    `want`, `got`: the bytes of a buffer, which holds what an argument of the type `type_name` points to."""
    if got == want:
        return 0.0, []
    kind = type_of(kernels, type_name)
    count = len(want) // kind.itemsize
    end = count * kind.itemsize
    wrong, greatest = [] if got[end:] == want[end:] else ["the bytes behind its last entry"], 0.0
    got, want = np.frombuffer(got, kind, count), np.frombuffer(want, kind, count)
    for field in kind.names or [None]:
        a, b = (got[field], want[field]) if field else (got, want)
        if a.tobytes() == b.tobytes():
            continue
        if a.dtype.kind == "f":
            share, line = _compare_floats(a.ravel(), b.ravel(), tolerance)
            greatest = max(greatest, share)
        else:
            line = _compare_whole(a.ravel(), b.ravel(), GRADIENT_STEP if a.dtype == np.int16 else 0)
        if line:
            wrong.append(f"{field}: {line}" if field else line)
    return greatest, wrong
