#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Outcomes of made-up runs, the meshes of the atlas, and its picture.

Usage: outcome_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import collections
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
import meshes
import outcome
import summary
from matplotlib import image


def made_up(changes, status="ok", kinetic=1.0, gravity=-2.0):
    """A run whose greatest area change is 5000 % in the frames of settling and then as given."""
    return {"status": status, "frame_max_area_change": [50.0] * outcome.SETTLING_FRAMES + changes,
            "energy": {"kinetic": kinetic, "gravity": gravity, "springs": 0.5}}


def lengths(vertices, triangle):
    return sorted(math.dist(vertices[triangle[k]], vertices[triangle[k - 1]]) for k in range(3))


def area(vertices, triangle):
    a, b, c = lengths(vertices, triangle)
    return 0.25 * math.sqrt(max((a + b + c) * (b + c - a) * (a + c - b) * (a + b - c), 0.0))


class Outcomes(unittest.TestCase):
    def test_outcomes(self):
        without = made_up([0.3, 0.2])
        for run, expected in (
            (made_up([0.05, 0.1]), "h"), (made_up([0.05, 0.11]), "i"), (made_up([0.3009]), "i"),
            (made_up([0.302]), "w"), (made_up([10.1]), "d"), (made_up([0.05, None]), "d"),
            (made_up([0.05], status="diverged"), "d"), (made_up([0.05], status="not_converged"), "h"),
            (made_up([0.05], kinetic=34.9), "h"), (made_up([0.05], kinetic=35.1), "d"),
            (made_up([0.05], kinetic=None), "d"), (made_up([0.05], status="timed_out"), "t")):
            with self.subTest(run=run):
                self.assertEqual(outcome.outcome(run, without), expected)

    def test_without_a_limiter(self):
        stiff = made_up([0.02])
        self.assertEqual(outcome.outcome(stiff, stiff), "h")
        self.assertEqual(outcome.outcome(made_up([0.05]), stiff), "w")
        broken = made_up([0.02], status="diverged")
        self.assertEqual(outcome.outcome(broken, broken), "d")
        self.assertEqual(outcome.outcome(made_up([0.05], kinetic=1e6), broken), "h")


class Meshes(unittest.TestCase):
    def test_needles_have_the_aspect_and_fill_the_square(self):
        for aspect in (1.0, 10.0, 1e4):
            vertices, triangles = meshes.needles(aspect)
            self.assertAlmostEqual(sum(area(vertices, t) for t in triangles), 1.0, places=4)
            sides = [lengths(vertices, triangle) for triangle in triangles]
            narrowest = min(side[0] for side in sides)
            # A pair of columns, 1 and 1/aspect wide, shares the width of two even ones.
            self.assertAlmostEqual(narrowest, 2.0 / meshes.CELLS / (1.0 + aspect), delta=1e-9)

    def test_fins_make_edges_of_four_triangles(self):
        _, triangles = meshes.fins()
        edges = collections.Counter(tuple(sorted((t[k], t[k - 1]))) for t in triangles for k in range(3))
        self.assertEqual(collections.Counter(edges.values())[4], 7 * meshes.CELLS)
        self.assertEqual(max(edges.values()), 4)

    def test_components_are_apart(self):
        vertices, triangles = meshes.components(10)
        self.assertEqual((len(vertices), len(triangles)), (90, 80))
        for triangle in triangles:
            self.assertEqual(len({v // 9 for v in triangle}), 1)

    def test_far_away_is_the_grid(self):
        near, far = meshes.grid()[0], meshes.far_away(1000.0)[0]
        for a, b in zip(far, near):
            self.assertLess(max(abs(a[k] - 1000.0 - b[k]) for k in range(3)), 1e-9)

    def test_the_program_takes_the_scenes(self):
        for chosen in maps.MAPS:
            scene = chosen.scene(chosen.x.values[-1], chosen.y.values[-1])
            seconds = scene["frames"] * scene["steps_per_frame"] * scene["time_step"]
            self.assertAlmostEqual(seconds, maps.SECONDS, delta=0.05)
            with self.subTest(map=chosen.name), tempfile.TemporaryDirectory() as folder:
                file = measure.write_scene(scene, Path(folder), "point")["file"]
                run = subprocess.run([PROGRAM, "validate", Path(folder) / file], capture_output=True, text=True,
                                     timeout=60)
                self.assertEqual(run.returncode, 0, run.stderr)


def made_up_map():
    axis = {"label": "stiffness (N/m)", "values": [1, 2]}

    def method(name, rows, greatest):
        return {"name": name, "title": name.upper(), "outcome": rows, "greatest": greatest, "not_ok": [[0], []]}

    return {"map": "made_up", "title": "Made up", "x": axis, "y": axis, "methods": [
        method("none", ["hi", "ii"], [[0.02, 0.5], [0.7, 0.8]]),
        method("apsl_defaults", ["hi", "wd"], [[0.01, 0.2], [0.75, None]]),
        method("apsl", ["hi", "wd"], [[0.01, 0.2], [0.75, None]]),
        method("apsl_printed", ["ii", "ii"], [[0.2, 0.2], [0.3, 0.4]]),
        method("pbd", ["hh", "ii"], [[0.03, 0.05], [0.3, 0.4]]),
        method("xpbd", ["ih", "ii"], [[0.3, 0.04], [0.3, 0.4]])]}


class Summary(unittest.TestCase):
    def test_table(self):
        self.assertEqual(summary.table([made_up_map()])[2],
                         "| [Made up](stability/made_up.png) | 4 | 1 | 1 | 1 | 0 | 2 (PBD) | 1 | 2 |")

    def test_points(self):
        self.assertEqual(list(summary.held_by_rivals_alone(made_up_map())),
                         ["stiffness 1 N/m, stiffness 2 N/m: ours 20 %, XPBD 4 %, held by 2"])
        self.assertEqual(list(summary.worse_than_none(made_up_map())),
                         ["stiffness 2 N/m, stiffness 1 N/m: ours 75 %, no limiter 70 %",
                          "stiffness 2 N/m, stiffness 2 N/m: ours not finite, no limiter 80 %"])

    def test_names_of_points(self):
        self.assertEqual(summary.named("time step (s)", 1 / 60), "time step 1/60 s")
        self.assertEqual(summary.named("mass ratio", 1e5), "mass ratio 100 000")
        self.assertEqual(summary.named("speed (m/s)", 0.3), "speed 0.3 m/s")

    def test_nothing_found_is_said(self):
        self.assertEqual(summary.listed([made_up_map()], lambda _: []), ["None."])


class Picture(unittest.TestCase):
    def test_a_map_shows_its_outcomes(self):
        with tempfile.TemporaryDirectory() as folder:
            file, out = Path(folder) / "map.json", Path(folder) / "map.png"
            file.write_text(json.dumps(made_up_map()))
            subprocess.run([PROJECT / "bench/charts/stability_map.py", file, "--out", out], check=True,
                           capture_output=True, timeout=60)
            pixels = (image.imread(out)[:, :, :3] * 255.0).round().astype(int)
            seen = collections.Counter(map(tuple, pixels.reshape(-1, 3).tolist()))
        for colour in ((0x56, 0xB4, 0xE9), (0xF0, 0xE4, 0x42), (0xE6, 0x9F, 0x00), (0x22, 0x22, 0x22)):
            self.assertGreater(seen[colour], 1000, colour)

    def test_what_is_no_map_is_one_line(self):
        with tempfile.TemporaryDirectory() as folder:
            file = Path(folder) / "map.json"
            file.write_text("{}")
            run = subprocess.run([PROJECT / "bench/charts/stability_map.py", file, "--out", Path(folder) / "map.png"],
                                 capture_output=True, text=True, timeout=60)
        self.assertEqual(run.returncode, 2)
        self.assertRegex(run.stderr, r"^error: .*map\.json: no map .*\n$")


if __name__ == "__main__":
    unittest.main()
