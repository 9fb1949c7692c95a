# SPDX-License-Identifier: MIT
"""Compiles every variant of every kernel to AMD machine code and refuses what would run badly.

Exit status: 0 all kernels passed; 1 some were refused, one line each on standard error; 2 wrong usage or no compiler.
"""
import argparse
import glob
import os
import shutil
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import amd_compiler
import gate
import tuning_table
from variants import EXECUTED, TARGETS, VariantError, kernels_named_in, sources_hash, variants

PROJECT = Path(__file__).resolve().parents[2]


def device_libraries():
    """Where Debian puts AMD's device libraries, on any architecture: Debian 12, or 13 in a folder of a clang's."""
    places = ("/usr/lib/*/amdgcn/bitcode", "/usr/lib/llvm-*/lib/clang/*/amdgcn/bitcode")
    return Path(next((folder for place in places for folder in sorted(glob.glob(place))), "."))


def require_compiler(parser, arguments):
    """Ends with a line and status 2 where the compiler or AMD's libraries are missing."""
    if not shutil.which(arguments.clang):
        parser.error(f"{arguments.clang} was not found, expected clang 19 with the AMDGPU target (Debian: clang-19)")
    if not (arguments.device_libraries / "ocml.bc").exists():
        parser.error("AMD's device libraries were not found, expected ocml.bc (Debian 12: rocm-device-libs, 13: rocm-device-libs-17)")


def parse_arguments():
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("--kernels", type=Path, default=PROJECT / "kernels", help="folder of the .cl files")
    parser.add_argument("--budget", type=Path, default=Path(__file__).with_name("budget.json"))
    parser.add_argument("--update-budget", action="store_true", help="rewrite the budget instead of keeping to it")
    parser.add_argument("--table", action="store_true", help="print the table of docs/amd_registers.md")
    parser.add_argument("--write-table", type=Path, metavar="FILE", help="put the table into a document")
    parser.add_argument("--check-table", type=Path, metavar="FILE", help="refuse a document whose table is out of date")
    parser.add_argument("--clang", default="clang-19")
    parser.add_argument("--device-libraries", type=Path, default=device_libraries(), help="folder of ocml.bc")
    parser.add_argument("--jobs", type=int, default=2, help="compilers at a time")
    parser.add_argument("--few-targets", action="store_true",
                        help="compile for those alone that tests/amd/replay executes, and refuse kernels that have changed since "
                             "the budget was written for all; APSL_TEST_THOROUGH in the environment: all targets after all")
    arguments = parser.parse_args()
    require_compiler(parser, arguments)
    if arguments.few_targets and arguments.update_budget:
        parser.error("--few-targets: a budget is written for all targets, expected no --update-budget with it")
    if os.environ.get("APSL_TEST_THOROUGH"):
        arguments.few_targets = False
    return arguments


def targets_of(arguments):
    return [target for target in TARGETS if target in EXECUTED or not arguments.few_targets]


def compile_all(arguments, refused):
    """{kernel variant: {target: Usage}}; what does not compile goes to `refused`."""
    jobs = [(variant, target) for variant in variants(arguments.kernels) for target in targets_of(arguments)]

    def compiled(job):
        variant, target = job
        try:
            return amd_compiler.compile_kernels(arguments.clang, arguments.device_libraries, variant.source,
                                                variant.defines, target)
        except amd_compiler.CompileError as error:
            return error

    results = {}
    with ThreadPoolExecutor(arguments.jobs) as pool:
        for (variant, target), outcome in zip(jobs, pool.map(compiled, jobs)):
            if isinstance(outcome, amd_compiler.CompileError):
                refused.append(f"{variant.key('*')} {target}: {gate.compile_finding(str(outcome))}")
                continue
            for usage in outcome:
                results.setdefault(variant.key(usage.kernel), {})[str(target)] = usage
    return results


def print_usage(results):
    print(f"{'VGPR':>5}{'SGPR':>5}{'LDS':>7}{'waves/SIMD':>11}  target      kernel")
    for key, targets in results.items():
        for target, u in targets.items():
            print(f"{u.vgprs:5}{u.sgprs:5}{u.local_bytes:7}{u.waves_per_simd:11}  {target:11} {key}")


def judge(results, budget, refused):
    """Lines for all that is wrong with compiled kernels; with a budget of None they need not keep to one."""
    for key, targets in results.items():
        for target, usage in targets.items():
            found = gate.findings(usage, int(target.split("/")[1]))
            if budget is not None:
                found += gate.over_budget(usage, budget.get(key, {}).get(target))
            refused += [f"{key} {target}: {finding}" for finding in found]


def gone_kernels(results, budget):
    return [f"{key}: budget: the kernel is gone, take its budget away with --update-budget"
            for key in budget if key not in results]


def missing_kernels(kernels, results):
    """A kernel that the sources name and no variant has."""
    compiled = {tuple(key.split(" ")[0].split(":")) for key in results}
    names = {kernel for _, kernel in compiled}
    return [f"{source}:{kernel}: coverage: no variant compiles it, expected defines for it in tests/amd/variants.py"
            for source, kernel in kernels_named_in(kernels)
            if ((source, kernel) not in compiled if source.endswith(".cl") else kernel not in names)]


def main():
    arguments = parse_arguments()
    refused = []
    try:
        results = compile_all(arguments, refused)
    except VariantError as error:
        print(f"refused: {error}", file=sys.stderr)
        return 1
    print_usage(results)
    budget = None if arguments.update_budget else gate.read_budget(arguments.budget)
    if not refused:  # a file that does not compile has none of its kernels
        refused += missing_kernels(arguments.kernels, results) + gone_kernels(results, budget or {})
    judge(results, budget, refused)
    if arguments.few_targets and gate.read_sources(arguments.budget) != sources_hash(arguments.kernels):
        refused.append(f"{arguments.budget.name}: sources: written for other kernels, write it anew for all targets with "
                       "check_kernels.py --update-budget --write-table docs/amd_registers.md")
    compiler = amd_compiler.version(arguments.clang)
    table = tuning_table.table(compiler, results, targets_of(arguments)) if not refused else ""
    if table and arguments.check_table and not tuning_table.is_current(arguments.check_table, table):
        refused.append(f"{arguments.check_table.name}: table: out of date, write it anew with "
                       "check_kernels.py --update-budget --write-table docs/amd_registers.md")
    for line in refused:
        print(f"refused: {line}", file=sys.stderr)
    if refused:
        return 1
    if arguments.update_budget:
        gate.write_budget(arguments.budget, compiler, sources_hash(arguments.kernels), results)
    if arguments.write_table:
        tuning_table.write(arguments.write_table, table)
    if arguments.table:
        print(table)
    print(f"passed: {len(results)} kernel variants on {len(targets_of(arguments))} targets")
    return 0


if __name__ == "__main__":
    sys.exit(main())
