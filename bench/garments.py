#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""Garments with the defaults, the tables of docs/accuracy.md: the greatest area change after the first ten frames and
the mean over all frames; edges and the greatest principal stretch after the first ten; what simulating a frame takes,
as a median. The meshes are not part of this repository, and nothing is fetched: where one is missing, this says where
it comes from and where to put it.

    bench/garments.py MESHES [--program build/program/apsl] [--stand-alone]

MESHES is the folder of skirt.obj, tshirt.obj and dress.obj. With springs in front of the limiter; about five minutes on
two cores. With --stand-alone the cloth is the limiter's alone, without springs: about two minutes.
"""
import argparse
import hashlib
import json
import statistics
import subprocess
import sys
import tempfile
from pathlib import Path
from typing import NamedTuple

SOURCE = ("https://github.com/omegaiota/DiffCloth, commit 4c3722e6b481ab90518f3b6b04ae751652f62471, "
          "folder src/assets/meshes/remeshed (MIT licence)")
FIRST_FRAMES, FRAMES = 10, 120
LIMITERS = {"off": None, "α = 1.2 × 10": {"regularization": 1.2, "sub_steps": 10, "stepping": "whole_step"},
            "defaults": {}, "defaults, by Chebyshev": {"solver": "chebyshev"}, "ceiling 1.1": {"stretch_ceiling": 1.1}}
RIGIDITIES = (0, 1e-5, 1e-4)  # N·m, of a stand-alone cloth


class Garment(NamedTuple):
    source: str  # the file's name in SOURCE
    sha256: str
    pins: float  # y of the top 3 cm, m, at a height of 1 m


GARMENTS = {
    "skirt.obj": Garment("skirt4925.obj", "ffe790ffbbef343f196edafc9413d5e73c056864a53ab5cbf052ab64d8ca6e2b", 4.575),
    "tshirt.obj": Garment("T-shirt/tshirt1900.obj",
                          "8877a727015b7a5377a0d960016b365992f69eb78902f25e855abc9d6c2507f8", 1.079),
    "dress.obj": Garment("dress-v7k-f14k.obj",
                         "1af2f48723e8d68a19d1e28b2ffcc526d8dd3e9fffbe48ea6a5208bc594c37db", 1.6993)}


def missing(folder):
    """A line for each mesh that is not in the folder, or is another one."""
    for name, garment in GARMENTS.items():
        path = folder / name
        if not path.is_file():
            yield f"{path}: missing; put {garment.source} there"
        elif hashlib.sha256(path.read_bytes()).hexdigest() != garment.sha256:
            yield f"{path}: another mesh; expected {garment.source}"


def with_springs():
    """(name of the springs, of the filter, integrator, limiter) of each row of a garment."""
    for stiffness in (50, 5):
        springs = {"stretch_stiffness": stiffness, "bend_stiffness": 0.05, "damping": 0.5}
        for title, limiter in LIMITERS.items():
            yield f"{stiffness} N/m", title, {"implicit_springs": springs}, limiter


def stand_alone():
    """Likewise, without springs."""
    for rigidity in RIGIDITIES:
        yield "none", f"ceiling 1.1, bending {rigidity:g} N·m", {"stand_alone": {"damping": 0.5, "bending": rigidity}}, \
            {"stretch_ceiling": 1.1}


def scene(mesh, pins, integrator, limiter):
    return {"mesh": {"file": str(mesh), "height": 1.0}, "density": 0.2, "frames": FRAMES,
            "pins": [{"box": {"min": [-9, pins, -9]}}], "integrator": integrator, "strain_limiting": limiter}


def frames(program, document):
    """Of the report."""
    with tempfile.TemporaryDirectory() as folder:
        path = Path(folder) / "scene.json"
        path.write_text(json.dumps(document))
        done = subprocess.run([program, "run", path, "--out", f"{folder}/out"], capture_output=True, text=True)
        if done.returncode != 0:
            sys.exit(done.stderr)
        report = json.loads((Path(folder) / "out/report.json").read_text())
    return report["frames"]


if __name__ == "__main__":
    parser = argparse.ArgumentParser(description=__doc__, formatter_class=argparse.RawDescriptionHelpFormatter)
    parser.add_argument("meshes", type=Path, metavar="MESHES")
    parser.add_argument("--program", type=Path, default=Path("build/program/apsl"))
    parser.add_argument("--stand-alone", action="store_true", help="without springs, bending by rigidity")
    options = parser.parse_args()
    if problems := list(missing(options.meshes)):
        sys.exit("\n".join([*problems, f"The meshes are those of {SOURCE}."]))
    program = options.program.resolve()
    if not program.is_file():
        sys.exit(f"{options.program}: no such program; build it as the README says, or name it with --program")
    print("| garment | springs | filter | greatest (mean) | edges | principal stretch | ms a frame | status |\n"
          "|---|---|---|---|---|---|---|---|")
    for name, garment in GARMENTS.items():
        for springs, title, integrator, limiter in stand_alone() if options.stand_alone else with_springs():
            report = frames(program, scene((options.meshes / name).resolve(), garment.pins, integrator, limiter))
            later = report[FIRST_FRAMES:]

            def greatest(key):
                return max(frame[key] for frame in later)

            mean = sum(frame["max_area_change"] for frame in report) / len(report)
            shortest = min(frame["min_edge_stretch"] for frame in later)
            milliseconds = 1000 * statistics.median(frame["step_seconds"] for frame in report)
            status = ", ".join(sorted({frame["status"] for frame in report}))
            print(f"| {name} | {springs} | {title} | {100 * greatest('max_area_change'):.3g} % ({100 * mean:.3g} %) | "
                  f"{shortest:.3f} to {greatest('max_edge_stretch'):.3f} | {greatest('max_principal_stretch'):.3f} | "
                  f"{milliseconds:.0f} | {status} |", flush=True)
