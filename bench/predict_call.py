#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""How long a call may take on another device, from two of its figures: bandwidth and the cost of a launch.

    apsl run SCENE --profile --report report.json
    bench/predict_call.py report.json --bandwidth 500 --launch 4

Every launch takes the greater of its bytes over the bandwidth and the cost of a launch; one that finds nothing to do
takes the cost of a launch. The bytes are those of bench/kernels/bytes.hpp: what must move once, with perfect caches. A
kernel that the table does not hold is small and counts as a launch. No promise: occupancy, caches and the driver's
queue are not in it."""
import argparse
import json
import re
import sys
from pathlib import Path

TABLE = Path(__file__).resolve().parent / "kernels/bytes.hpp"
# What runs in every sub-step that is queued; the device skips those that a cloth does not need.
IN_SUB_STEPS = ("assemble_gradients", "bound_vertices", "begin_solve", "chebyshev_step", "bend_hinges",
                "matrix_free_apply_dot", "assemble_pressure_csr", "csr_spmv_dot", "cg_update", "gather_displacements")


class Refused(Exception):
    pass


def traffic_table(text):
    """By kernel: bytes a vertex, a triangle and, with a ceiling, a second row."""
    rows = re.findall(r'Traffic\{"(\w+)", ([^}]*)\}', text)
    numbers = {name: [float(number) for number in fields.split(",")] + [0.0, 0.0] for name, fields in rows}
    return {name: (fields[0], fields[1], fields[4]) for name, fields in numbers.items()}


def taken_share(report):
    """Of the sub-steps that calls queued, those that a cloth took."""
    queued = next((kernel["launches"] for kernel in report["kernels"] if kernel["name"] == "begin_solve"), 0)
    taken = sum(frame["sub_steps"] for frame in report["frames"])
    return min(taken / queued, 1.0) if queued else 1.0


def predict(report, table, bandwidth, launch):
    """Rows (kernel, launches a call, bytes a launch or None, seconds a call). `bandwidth` in B/s, `launch` in s."""
    calls = next(kernel["launches"] for kernel in report["kernels"] if kernel["name"] == "predict_positions")
    with_ceiling = any(kernel["name"] == "order_stretch_limits" for kernel in report["kernels"])
    taken, rows = taken_share(report), []
    for kernel in report["kernels"]:
        launches = kernel["launches"] / calls
        moved = None
        if kernel["name"] in table:
            vertex, triangle, row = table[kernel["name"]]
            moved = vertex * report["vertices"] + (triangle + (row if with_ceiling else 0)) * report["triangles"]
        working = launches * (taken if kernel["name"] in IN_SUB_STEPS else 1.0)
        seconds = working * max(launch, (moved or 0) / bandwidth) + (launches - working) * launch
        rows.append((kernel["name"], launches, moved, seconds))
    return rows


def main():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("report", type=Path, help="of apsl run --profile --report")
    parser.add_argument("--bandwidth", type=float, required=True, help="that a copy reaches, read and written, GB/s")
    parser.add_argument("--launch", type=float, required=True, help="from the end of a kernel to the start of the next, µs")
    options = parser.parse_args()
    if not (0 < options.bandwidth < 1e6 and 0 <= options.launch < 1e6):
        raise Refused("--bandwidth and --launch: expected numbers above 0")
    try:
        report = json.loads(options.report.read_text())
    except (OSError, ValueError) as error:
        raise Refused(f"{options.report}: {error}") from error
    if not report.get("kernels"):
        raise Refused(f"{options.report}: no kernels in it, expected a report of apsl run --profile on an OpenCL device")
    if not any(kernel["name"] == "predict_positions" for kernel in report["kernels"]):
        raise Refused(f"{options.report}: the cloth was done in one group, in one launch, whose time is not one of bytes")
    rows = predict(report, traffic_table(TABLE.read_text()), options.bandwidth * 1e9, options.launch * 1e-6)
    print(f"{'kernel':28}{'launches':>9}{'kB a launch':>13}{'µs a call':>11}")
    for name, launches, moved, seconds in rows:
        print(f"{name:28}{launches:9.1f}{'' if moved is None else format(moved / 1e3, '.0f'):>13}{seconds * 1e6:11.0f}")
    total, launched = sum(row[3] for row in rows), sum(row[1] for row in rows)
    print(f"{'a call':28}{launched:9.1f}{'':13}{total * 1e6:11.0f}")
    print(f"launches alone: {launched * options.launch:.0f} µs")


if __name__ == "__main__":
    try:
        main()
    except Refused as refused:
        print(f"error: {refused}", file=sys.stderr)
        sys.exit(2)
