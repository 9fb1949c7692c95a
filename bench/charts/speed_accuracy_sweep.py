#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the program `apsl` on one scene over regularizations and sub-step counts, for both matrices, and writes one JSON
summary that speed_accuracy.py draws."""

import json
import subprocess
import sys
import tempfile
from pathlib import Path

from chart_tools import ChartError, OneLineParser, exit_code_of, read_json, write_whole

SUMMARY_FIELDS = ("max_area_change", "mean_max_area_change", "rms_area_change", "cg_iterations_per_solve",
                  "filter_seconds_per_frame", "step_seconds_per_frame")


def numbers(text, kind, least, name):
    try:
        values = [kind(part) for part in text.split(",") if part]
    except ValueError:
        values = []
    if (not values and text) or any(not value >= least for value in values):
        raise ChartError(f"{name} {text}: expected numbers from {least} up, as in 1,2,5")
    return values


def commit_of(folder):
    """The commit that `folder` stands at, "-dirty" behind it where files differ; "unknown" outside git."""
    def git(*arguments):
        return subprocess.run(["git", "-C", str(folder), *arguments], capture_output=True, text=True)
    try:
        head = git("rev-parse", "--short=12", "HEAD")
        if head.returncode != 0:
            return "unknown"
        return head.stdout.strip() + ("-dirty" if git("diff", "--quiet", "HEAD").returncode != 0 else "")
    except OSError:
        return "unknown"


def build_type_of(program):
    """CMAKE_BUILD_TYPE of the build folder that the program lies in; "unknown" where it lies in none."""
    for folder in Path(program).resolve().parents:
        cache = folder / "CMakeCache.txt"
        if cache.is_file():
            for line in cache.read_text(errors="replace").splitlines():
                if line.startswith("CMAKE_BUILD_TYPE:"):
                    return line.partition("=")[2] or "unknown"
    return "unknown"


def run_program(options, folder, assignments):
    """The report of one run. A run that breaks down (exit code 1) has one as well."""
    report = Path(folder) / "report.json"
    report.unlink(missing_ok=True)
    command = [options.program, "run", options.scene, "--backend", options.backend, "--frames", str(options.frames),
               "--report", str(report)]
    for assignment in [*options.set, *assignments]:
        command += ["--set", assignment]
    try:
        done = subprocess.run(command, capture_output=True, text=True, timeout=options.timeout)
    except OSError as error:
        raise ChartError(f"{options.program}: cannot be run ({error.strerror})") from None
    except subprocess.TimeoutExpired:
        raise ChartError(f"{' '.join(command)}: no end after {options.timeout} s; see --timeout") from None
    if done.returncode not in (0, 1) or not report.is_file():
        said = (done.stderr.strip().splitlines() or ["nothing on stderr"])[-1]
        raise ChartError(f"{' '.join(command)}: exit code {done.returncode}: {said}")
    return read_json(report)


def entry(report):
    """What a chart needs of a report."""
    summary = report.get("summary", {})
    return {**{field: summary.get(field) for field in SUMMARY_FIELDS}, "status": summary.get("status", "unknown")}


def sweep(options):
    """The summary: facts of the machine, the run without the filter, and one entry a setting."""
    settings = [("consistent", alpha, count) for alpha in options.consistent for count in options.sub_steps]
    settings += [("printed", alpha, count) for alpha in options.printed for count in options.sub_steps]
    runs, facts = [], {}
    with tempfile.TemporaryDirectory() as folder:
        without = entry(run_program(options, folder, ["strain_limiting=null"]))
        for place, (matrix, alpha, count) in enumerate(settings, start=1):
            report = run_program(options, folder, [
                f"strain_limiting.matrix={matrix}", f"strain_limiting.regularization={alpha}",
                f"strain_limiting.sub_steps={count}"])
            facts = facts or {name: report.get(name) for name in ("backend", "device", "vertices", "triangles")}
            runs.append({"matrix": matrix, "regularization": alpha, "sub_steps": count, **entry(report)})
            change = runs[-1]["max_area_change"]
            print(f"{place}/{len(settings)} {matrix} α={alpha:g} sub_steps={count}: "
                  f"greatest area change {'none' if change is None else format(change, '.3%')}, {runs[-1]['status']}",
                  flush=True)
    return {"commit": commit_of(Path(__file__).parent), "build_type": build_type_of(options.program),
            "scene": Path(options.scene).name, "frames": options.frames, "set": options.set, **facts,
            "without_filter": without, "runs": runs}


def run(arguments):
    parser = OneLineParser(description=__doc__)
    parser.add_argument("program", metavar="PROGRAM", help="the program apsl")
    parser.add_argument("--scene", default=str(Path(__file__).resolve().parents[2] / "scenes" / "curtain.json"))
    parser.add_argument("--frames", type=int, default=60)
    parser.add_argument("--backend", default="opencl", choices=("opencl", "reference"))
    parser.add_argument("--sub-steps", default="1,2,5,10,20", metavar="LIST")
    parser.add_argument("--consistent", default="1.05,1.2,1.5,2", metavar="LIST", help="α for the consistent matrix")
    parser.add_argument("--printed", default="2,3", metavar="LIST", help="α for the printed matrix; empty for none")
    parser.add_argument("--set", action="append", default=[], metavar="PATH=VALUE", help="for every run, as in apsl")
    parser.add_argument("--timeout", type=float, default=600.0, help="s, for one run")
    parser.add_argument("--out", required=True, metavar="FILE.json")
    options = parser.parse_args(arguments)
    options.sub_steps = numbers(options.sub_steps, int, 1, "--sub-steps")
    options.consistent = numbers(options.consistent, float, 1.0, "--consistent")
    options.printed = numbers(options.printed, float, 1.0, "--printed")
    if not options.sub_steps or not (options.consistent or options.printed):
        raise ChartError("nothing to run: --sub-steps and one of --consistent, --printed must name something")
    if options.frames < 1:
        raise ChartError(f"--frames {options.frames}: expected 1 or more")
    write_whole(options.out, (json.dumps(sweep(options), indent=1, ensure_ascii=False) + "\n").encode())
    print(options.out)


if __name__ == "__main__":
    sys.exit(exit_code_of(run))
