#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Runs the maps and cases of the atlas of failure with `apsl compare`, and keeps of each run its outcome, its greatest
area change and its status: docs/stability/*.json."""

import argparse
import dataclasses
import json
import math
import os
import shutil
import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from pathlib import Path

import maps
import meshes
import outcome


def write_scene(scene, folder, name):
    """The scene file, its mesh beside it."""
    mesh = scene["mesh"].get("obj")
    if mesh is not None:
        (folder / f"{name}.obj").write_text(meshes.obj_text(mesh))
        scene = {**scene, "mesh": {"file": f"{name}.obj"}}
    (folder / f"{name}.scene.json").write_text(json.dumps(scene))
    return {"file": f"{name}.scene.json", "name": name}


def find_map(name, every):
    """With every so many-th value of its axes, the last one among them."""
    chosen = next(entry for entry in maps.MAPS if entry.name == name)
    thin = [dataclasses.replace(axis, values=axis.values[::-1][::every][::-1]) for axis in (chosen.x, chosen.y)]
    return dataclasses.replace(chosen, x=thin[0], y=thin[1])


def columns_of(name, chosen):
    """Parts of a map or of the cases that are run by themselves: [(scenes by name of the point, methods)]."""
    if name == maps.CASES:
        return [([(f"case_{row}", scene)], maps.CASE_METHODS) for row, (_, scene) in enumerate(maps.cases())]
    columns = []
    for x in chosen.x.values:
        methods = chosen.methods
        if chosen.parameter:
            methods = [{**method, "parameters": {**method["parameters"], chosen.parameter: x}}
                       if method["name"] != "none" else method for method in methods]
        columns.append(([(maps.point_name(x, y), chosen.scene(x, y)) for y in chosen.y.values], methods))
    return columns


def steps(scenes):
    return sum(scene["frames"] * scene["steps_per_frame"] for _, scene in scenes)


def run_column(program, folder, scenes, methods, run_seconds):
    """Runs that `folder` holds from before are not made again."""
    folder.mkdir(parents=True, exist_ok=True)
    first = scenes[0][0]
    study = folder / f"{first}.study.json"
    study.write_text(json.dumps({"scenes": [write_scene(scene, folder, name) for name, scene in scenes],
                                 "methods": methods, "keep_frames": True, "run_seconds": run_seconds}))
    results = folder / f"{first}.results.json"
    # Cloths are small and columns run side by side: one thread each, pocl's device without threads where it is pocl.
    environment = {"POCL_DEVICES": "basic", "OMP_NUM_THREADS": "1", **os.environ}
    done = subprocess.run([program, "compare", "--study", study, "--out", results], env=environment,
                          capture_output=True, text=True)
    if done.returncode != 0:
        raise RuntimeError(f"{study}: exit code {done.returncode}: {done.stderr.strip().splitlines()[-1:]}")
    return json.loads(results.read_text())


def rounded(value):
    """Three digits; null for what is not finite."""
    return float(f"{value:.3g}") if math.isfinite(value) else None


def condensed(name, chosen, results):
    """What the documentation keeps. Rows from the first value of y, one letter a point (outcome.py) along x."""
    first = results[0]
    names = list(dict.fromkeys(run["method"] for run in first["runs"]))
    # As maps.py lists them, whichever were run last.
    names.sort(key=lambda name: 0 if name == "none" else 1 if name.startswith("apsl") else 2)
    document = {"map": name, "commit": first["runs"][0]["commit"], "machine": first["machine"],
                "meaning": outcome.MEANING}
    if name == maps.CASES:
        document["cases"] = [case for case, _ in maps.cases()]
        points = [[f"case_{row}"] for row in range(len(document["cases"]))]
    else:
        document["title"] = chosen.title
        document["x"] = {"label": chosen.x.label, "values": chosen.x.values}
        document["y"] = {"label": chosen.y.label, "values": chosen.y.values}
        points = [[maps.point_name(x, y) for x in chosen.x.values] for y in chosen.y.values]
    runs = {(run["scene"], run["method"]): run for part in results for run in part["runs"]}
    driven = {scene["name"]: maps.driven(scene["document"]) for part in results for scene in part["scenes"]}
    document["methods"] = []
    for method in names:
        run = next(run for run in first["runs"] if run["method"] == method)
        own = [[runs[point, method] for point in row] for row in points]
        without = [[runs[point, "none"] for point in row] for row in points]
        document["methods"].append({
            "name": method, "title": run["title"], "citation": run["citation"], "parameters": run["parameters"],
            "outcome": ["".join(outcome.outcome(a, b, driven[a["scene"]]) for a, b in zip(*rows))
                        for rows in zip(own, without)],
            "greatest": [[rounded(outcome.greatest(a)) for a in row] for row in own],
            "edges": [[rounded(outcome.longest_edge(a)) for a in row] for row in own],
            "not_ok": [[column for column, a in enumerate(row) if a["status"] != "ok"] for row in own],
        })
    return document


def text_of(document):
    """One method a line."""
    methods = document.pop("methods")
    head = json.dumps(document, ensure_ascii=False)[:-1]
    return head + ', "methods": [\n' + ",\n".join(json.dumps(m, ensure_ascii=False) for m in methods) + "\n]}\n"


def drop_ours(folder):
    for path in folder.glob("*.results.json"):
        results = json.loads(path.read_text())
        results["runs"] = [run for run in results["runs"] if not run["method"].startswith("apsl")]
        path.write_text(json.dumps(results))


def main():
    known = maps.NAMES
    parser = argparse.ArgumentParser(description=__doc__)
    parser.add_argument("program", type=Path)
    parser.add_argument("maps", nargs="*", metavar="MAP", help="of " + ", ".join(known) + "; all without")
    parser.add_argument("--work", type=Path, required=True, help="folder for scenes and whole results")
    parser.add_argument("--out", type=Path, required=True, help="folder for the outcomes")
    parser.add_argument("--keep", choices=("nothing", "baselines", "all"), default="nothing",
                        help="of the runs that WORK holds from before")
    parser.add_argument("--every", type=int, default=1, help="takes every so many-th value of a map's axes")
    parser.add_argument("--jobs", type=int, default=os.cpu_count())
    parser.add_argument("--run-seconds", type=float, default=60.0, help="no frame of a run begins after so long")
    options = parser.parse_args()
    for name in options.maps:
        if name not in known:
            parser.error(f"{name}: no such map, expected one of {', '.join(known)}")
    options.out.mkdir(parents=True, exist_ok=True)
    chosen = {name: None if name == maps.CASES else find_map(name, options.every) for name in options.maps or known}
    with ThreadPoolExecutor(options.jobs) as pool:
        futures = {}
        for name in chosen:
            folder = options.work / name
            if options.keep == "nothing":
                shutil.rmtree(folder, ignore_errors=True)
            elif options.keep == "baselines":
                drop_ours(folder)
            for number, column in enumerate(columns_of(name, chosen[name])):
                futures[name, number] = (folder, *column, options.run_seconds)
        # Those of most steps first, or the last of them would run alone.
        for key in sorted(futures, key=lambda key: -steps(futures[key][1])):
            futures[key] = pool.submit(run_column, options.program, *futures[key])
        for name in chosen:
            results = [future.result() for (of, _), future in futures.items() if of == name]
            (options.out / f"{name}.json").write_text(text_of(condensed(name, chosen[name], results)))
            print(f"{options.out / name}.json", flush=True)


if __name__ == "__main__":
    try:
        main()
    except RuntimeError as error:
        sys.exit(f"error: {error}")
