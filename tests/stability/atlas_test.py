#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Of each map in docs/stability a point of ours that held and one that did not, run again: the same outcome. All single
cases on both back ends: they end, and nothing is not finite.

Usage: atlas_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import copy
import json
import math
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, PROJECT = Path(sys.argv.pop(1)), Path(sys.argv.pop(1))
sys.path.insert(0, str(PROJECT / "bench/stability"))

import maps
import measure
import outcome
import summary

DATA = PROJECT / "docs/stability"
CASE_FRAMES = 15
MOST_BYTES = 200_000


def read(name):
    return json.loads((DATA / f"{name}.json").read_text())


def inner_points(rows, letters):
    """Points (row, column) whose neighbours all have their letter, which is one of `letters`: rounding that differs
    between devices moves borders, not what lies inside."""
    for y, row in enumerate(rows):
        for x, letter in enumerate(row):
            around = {rows[v][u] for v in range(max(y - 1, 0), min(y + 2, len(rows)))
                      for u in range(max(x - 1, 0), min(x + 2, len(row)))}
            if letter in letters and around == {letter}:
                yield y, x


def cost(scene):
    vertices = scene["mesh"].get("grid", {}).get("vertices", [maps.SIDE, maps.SIDE])
    return scene["frames"] * scene["steps_per_frame"] * vertices[0] * vertices[1]


def numbers(value):
    """All numbers in a document, null where one was not finite."""
    if isinstance(value, dict):
        for entry in value.values():
            yield from numbers(entry)
    elif isinstance(value, list):
        for entry in value:
            yield from numbers(entry)
    elif value is None or (isinstance(value, (int, float)) and not isinstance(value, bool)):
        yield value


class Atlas(unittest.TestCase):
    def test_there_is_one_outcome_for_every_point(self):
        others = {"long_run"}  # tests/stability/long_run.sh
        self.assertEqual({path.stem for path in DATA.glob("*.json")} - others,
                         set(maps.NAMES))
        for chosen in maps.MAPS:
            document = read(chosen.name)
            self.assertLessEqual(len((DATA / f"{chosen.name}.json").read_bytes()), MOST_BYTES)
            self.assertEqual([m["name"] for m in document["methods"]], [m["name"] for m in chosen.methods])
            self.assertLessEqual(set(document["x"]["values"]), set(chosen.x.values))
            self.assertLessEqual(set(document["y"]["values"]), set(chosen.y.values))
            for method in document["methods"]:
                with self.subTest(map=chosen.name, method=method["name"]):
                    self.assertEqual([len(row) for row in method["outcome"]],
                                     len(document["y"]["values"]) * [len(document["x"]["values"])])
                    self.assertLessEqual(set("".join(method["outcome"])), set(outcome.MEANING))
        cases = read(maps.CASES)
        self.assertEqual(cases["cases"], [name for name, _ in maps.cases()])
        for method in cases["methods"]:
            self.assertEqual(len(method["outcome"]), len(cases["cases"]))

    def test_the_documentation_says_what_the_data_say(self):
        self.assertIn(summary.summary(DATA), (PROJECT / "docs/stability.md").read_text())
        for name in maps.NAMES:
            self.assertLessEqual((DATA / f"{name}.png").stat().st_size, 300_000)

    def run_again(self, chosen, method, x, y, folder):
        parameters = next(m["parameters"] for m in chosen.methods if m["name"] == method)
        if chosen.parameter:
            parameters = {**parameters, chosen.parameter: x}
        methods = maps.WITHOUT + [{"name": method, "parameters": parameters}]
        scene = chosen.scene(x, y)
        without, again = measure.run_column(PROGRAM, folder, [("point", scene)], methods, 300.0)["runs"]
        return outcome.outcome(again, without, maps.driven(scene))

    def test_points_of_ours_come_out_the_same(self):
        tried = 0
        for chosen in maps.MAPS:
            document = read(chosen.name)
            method = summary.judged(document)
            for letters in (outcome.HELD, set(outcome.MEANING) - {outcome.HELD, outcome.TIMED_OUT}):
                points = [(document["x"]["values"][x], document["y"]["values"][y], method["outcome"][y][x])
                          for y, x in inner_points(method["outcome"], letters)]
                if not points:
                    continue
                x, y, letter = min(points, key=lambda point: cost(chosen.scene(*point[:2])))
                with self.subTest(map=chosen.name, x=x, y=y), tempfile.TemporaryDirectory() as folder:
                    self.assertEqual(self.run_again(chosen, method["name"], x, y, Path(folder)), letter)
                    tried += 1
        self.assertGreaterEqual(tried, len(maps.MAPS))

    def test_single_cases_end_and_stay_finite_on_both_back_ends(self):
        for row, (name, scene) in enumerate(maps.cases()):
            scene = copy.deepcopy(scene)
            scene["strain_limiting"] = {}
            scene["frames"] = CASE_FRAMES
            for backend in ("reference", "opencl"):
                with self.subTest(case=name, backend=backend), tempfile.TemporaryDirectory() as folder:
                    folder = Path(folder)
                    file = measure.write_scene(scene, folder, f"case_{row}")["file"]
                    run = subprocess.run([PROGRAM, "run", folder / file, "--backend", backend, "--report",
                                          folder / "report.json"], capture_output=True, text=True, timeout=120)
                    self.assertEqual(run.returncode, 0, run.stderr)
                    report = json.loads((folder / "report.json").read_text())
                    self.assertEqual(len(report["frames"]), CASE_FRAMES)
                    for frame in report["frames"]:
                        self.assertNotEqual(frame["status"], "diverged")
                        for number in numbers(frame):
                            self.assertTrue(number is not None and math.isfinite(number), frame)


if __name__ == "__main__":
    unittest.main()
