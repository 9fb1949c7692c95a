#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""What was asked of the speed and what one run of apsl_kernel_bench reached, as a Markdown table. Ratios are within
that run; a line without its measurements says so."""

import argparse
import json
import sys
from pathlib import Path

OURS, CSR = "consistent matrix_free", "consistent assembled_csr"
EIGEN, VIENNACL, REFERENCE = "Eigen CG, 1 thread", "ViennaCL CG", "Eigen reference, float"
MIDDLING, LARGE = 131072, 2097152


class Missing(Exception):
    """The run holds no such measurement."""


class Run:
    def __init__(self, rows):
        self.rows = rows

    def row(self, quantity, method, triangles):
        for row in self.rows:
            if (row["quantity"], row["method"], row["triangles"]) == (quantity, method, triangles):
                return row
        raise Missing(f"no {quantity} of {method} at {triangles:,} triangles")

    def seconds(self, quantity, method, triangles):
        return self.row(quantity, method, triangles)["median_seconds"]

    def times_faster(self, quantity, method, triangles):
        """How many times as long `method` takes as ours."""
        return self.seconds(quantity, method, triangles) / self.seconds(quantity, OURS, triangles)

    def sizes(self, quantity, method):
        return {row["triangles"] for row in self.rows if (row["quantity"], row["method"]) == (quantity, method)}


def bandwidth_share(run):
    row = run.row("cg_iteration", OURS, LARGE)
    if row["gb_per_second"] is None or row["copy_gb_per_second"] is None:
        raise Missing("bytes or copy bandwidth not known")
    share = row["gb_per_second"] / row["copy_gb_per_second"]
    return f"{share:.0%} ({row['gb_per_second']:.1f} of {row['copy_gb_per_second']:.1f} GB/s)", share >= 0.6


def bytes_against_csr(run):
    ours, csr = (run.row("cg_iteration", method, LARGE)["bytes_moved"] for method in (OURS, CSR))
    if ours is None or csr is None:
        raise Missing("bytes not known")
    return f"{ours / LARGE:.0f} B against {csr / LARGE:.0f} B a triangle", ours < csr


def crossover(run):
    """The smallest size from which on ours is faster at every size measured."""
    sizes = sorted(run.sizes("filter_call", OURS) & run.sizes("filter_call", REFERENCE))
    if not sizes:
        raise Missing("no size with both filters")
    ratios = [run.times_faster("filter_call", REFERENCE, size) for size in sizes]
    first = len(sizes)
    while first > 0 and ratios[first - 1] > 1.0:
        first -= 1
    if first == len(sizes):
        return f"slower still at {sizes[-1]:,}: {ratios[-1]:.1f}×", False
    return (f"from {sizes[first]:,} triangles up ({ratios[first]:.1f}× there; {min(ratios[first:]):.1f}× to "
            f"{max(ratios[first:]):.1f}×)"), sizes[first] <= 2048


def frame_of_8192(run):
    seconds = run.seconds("filter_call", OURS, 8192)
    return f"{1e3 * seconds:.2f} ms", seconds < 3e-3


def cost_per_triangle(run):
    """Greatest over least cost per triangle among the sizes in between: a cost that rises and falls again counts."""
    costs = {size: run.seconds("filter_call", OURS, size) / size for size in run.sizes("filter_call", OURS)
             if 8192 <= size <= LARGE}
    if 8192 not in costs or LARGE not in costs:
        raise Missing("8,192 and 2,097,152 triangles are needed")
    ratio = costs[LARGE] / costs[8192]
    return (f"{ratio:.2f}× ({1e9 * costs[8192]:.0f} ns at 8,192, {1e9 * costs[LARGE]:.0f} ns at 2,097,152; "
            f"between the dearest and the cheapest size {max(costs.values()) / min(costs.values()):.2f}×)",
            max(ratio, 1.0 / ratio) <= 1.5)


def thousand_cloths(run):
    total = 1000 * 2048
    ratio = run.seconds("filter_call", OURS, total) / run.seconds("filter_call", "1000 cloths of 2,048", total)
    return f"{ratio:.0%}", ratio >= 0.8


def fifty_cloths(run):
    seconds = run.seconds("filter_call", "50 cloths of 2,048", 50 * 2048)
    return f"{1e3 * seconds:.1f} ms", seconds < 20e-3


def faster(quantity, method, triangles, asked):
    def judge(run):
        ratio = run.times_faster(quantity, method, triangles)
        return f"{ratio:.1f}×", ratio >= asked
    return judge


ASKED = (
    ("CG iteration against Eigen, 1 thread, 131,072 triangles", "3×", faster("cg_iteration", EIGEN, MIDDLING, 3.0)),
    ("CG iteration against Eigen, 1 thread, 2,097,152", "5×", faster("cg_iteration", EIGEN, LARGE, 5.0)),
    ("CG iteration against ViennaCL, 131,072", "10×", faster("cg_iteration", VIENNACL, MIDDLING, 10.0)),
    ("CG iteration against ViennaCL, 2,097,152", "10×", faster("cg_iteration", VIENNACL, LARGE, 10.0)),
    ("share of copy bandwidth in an iteration, 2,097,152", "60 %", bandwidth_share),
    ("bytes an iteration, against assembled 32-bit CSR", "fewer", bytes_against_csr),
    ("whole filter faster than the Eigen reference in float", "from 2,000 triangles up", crossover),
    ("whole filter, 8,192 triangles", "under 3 ms", frame_of_8192),
    ("cost per triangle, 2,097,152 over 8,192", "within 1.5×", cost_per_triangle),
    ("1,000 cloths of 2,048: triangles per second of one cloth as large", "80 %", thousand_cloths),
    ("50 cloths of 2,048 in one call", "under 20 ms", fifty_cloths),
)


def summary(rows):
    run = Run(rows)
    lines = ["| | target | measured | |", "|---|---|---|---|"]
    for what, asked, judge in ASKED:
        try:
            reached, enough = judge(run)
            lines.append(f"| {what} | {asked} | {reached} | {'yes' if enough else 'no'} |")
        except Missing as missing:
            lines.append(f"| {what} | {asked} | not measured: {missing} | |")
    return lines


def main():
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("results", metavar="results.json", help="written by apsl_kernel_bench --out")
    path = Path(parser.parse_args().results)
    try:
        rows = json.loads(path.read_text(encoding="utf-8"))
    except (OSError, ValueError) as error:
        print(f"error: {path}: cannot be read as JSON ({error})", file=sys.stderr)
        return 2
    facts = {field: ", ".join(dict.fromkeys(row[field] for row in rows)) for field in ("device", "driver", "commit")}
    print(f"{facts['device']}; {facts['driver']}; commit {facts['commit']}\n")
    print("\n".join(summary(rows)))
    return 0


if __name__ == "__main__":
    sys.exit(main())
