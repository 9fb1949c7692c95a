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


def made_up(changes, status="ok", kinetic=1.0, gravity=-2.0, start=0.0, greatest_energy=None, stretches=(1.0,)):
    """A run whose greatest area change is 5000 % in the frames of settling and then as given."""
    return {"status": status, "frame_max_area_change": [50.0] * outcome.SETTLING_FRAMES + changes,
            "frame_max_edge_stretch": [99.0] * outcome.SETTLING_FRAMES + list(stretches),
            "start_energy": {"kinetic": 0.0, "gravity": 0.0, "springs": start, "total": start},
            "greatest_energy": start if greatest_energy is None else greatest_energy,
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

    def test_energy(self):
        # 3.5 J in the scene, a tenth of it is let pass.
        without = made_up([0.3], greatest_energy=-0.1)
        for rises, expected in ((0.34, "h"), (0.36, "g"), (5.0, "g")):
            with self.subTest(rises=rises):
                self.assertEqual(outcome.outcome(made_up([0.05], greatest_energy=rises), without), expected)
        self.assertEqual(outcome.outcome(made_up([0.05], greatest_energy=5.0), without, driven=True), "h")
        self.assertEqual(outcome.outcome(made_up([0.4], greatest_energy=5.0), without), "g")
        self.assertEqual(outcome.outcome(made_up([20.0], greatest_energy=5.0), without), "d")

    def test_energy_far_from_rest_counts_from_the_start(self):
        without = made_up([0.3], start=40.0)
        self.assertEqual(outcome.outcome(made_up([0.05], start=40.0, greatest_energy=44.3), without), "h")
        self.assertEqual(outcome.outcome(made_up([0.05], start=40.0, greatest_energy=44.5), without), "g")

    def test_energy_that_contact_gives_is_no_fault_of_the_limiter(self):
        without = made_up([0.3], greatest_energy=1.0)
        self.assertEqual(outcome.outcome(without, without), "i")
        self.assertEqual(outcome.outcome(made_up([0.05], greatest_energy=2.3), without), "h")
        self.assertEqual(outcome.outcome(made_up([0.05], greatest_energy=2.4), without), "g")

    def test_energy_that_is_not_finite(self):
        run = made_up([0.05])
        run["greatest_energy"] = None
        self.assertEqual(outcome.outcome(run, made_up([0.3])), "g")
        self.assertEqual(outcome.outcome(made_up([0.05], greatest_energy=5.0), run), "h")

    def test_longest_edges(self):
        self.assertEqual(outcome.longest_edge(made_up([0.1], stretches=[1.5, 1.2])), 1.5)
        self.assertEqual(outcome.longest_edge(made_up([0.1], stretches=[None])), math.inf)
        self.assertEqual(outcome.longest_edge(made_up([0.1], status="diverged")), math.inf)

    def test_a_ceiling_is_held_to(self):
        without = made_up([0.3])
        for change, longest, expected in ((0.05, 1.12, "h"), (0.05, 1.13, "s"), (0.2, 1.13, "i"), (0.05, None, "s")):
            run = made_up([change], stretches=[longest]) | {"parameters": {"strain_limiting.stretch_ceiling": 1.1}}
            with self.subTest(change=change, longest=longest):
                self.assertEqual(outcome.outcome(run, without), expected)
        self.assertEqual(outcome.outcome(made_up([0.05], stretches=[9.0]) | {"parameters": {}}, without), "h")

    def test_what_moves_by_itself(self):
        for scene, expected in (({}, False), ({"pins": [{"vertices": [0]}], "start": {"scale": [0, 0, 0]}}, False),
                                ({"pins": [{"vertices": [0]}, {"box": {}, "motion": {"translate": {}}}]}, True),
                                ({"start": {"rest_areas": 2}}, True)):
            self.assertEqual(maps.driven(scene), expected)

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

    def test_belts_have_the_height_and_light_vertices_where_they_are_said_to_be(self):
        for height in (0.1, 0.001):
            for places in ([0], [8], [16], [0, 4, 8, 12]):
                vertices, triangles = meshes.belts(height, places)
                self.assertAlmostEqual(sum(area(vertices, t) for t in triangles), 1.0, places=9)
                edge = 1.0 / meshes.CELLS
                low = [t for t in triangles if area(vertices, t) < 0.5 * edge * edge * min(1.01 * height, 0.5)]
                self.assertEqual(len(low), len(places) * meshes.BELT_ROWS * 2 * meshes.CELLS)
                masses = [0.0] * len(vertices)
                for triangle in triangles:
                    for v in triangle:
                        masses[v] += area(vertices, triangle) / 3.0
                # A vertex of eight triangles weighs 4/3 of the mean.
                light = sum(mass < 1.4 * height * edge * edge for mass in masses)
                at_rims = 17 * sum(place in (0, 16) for place in places)  # a rim of the sheet itself is light too
                self.assertEqual(light, 2 * 17 * len(places) + at_rims)

    def test_split_makes_slivers_of_the_height_and_nothing_else(self):
        for share, count in ((0.01, 5), (0.1, 51), (1.0, 512)):
            vertices, triangles = meshes.split(share, 0.02)
            self.assertEqual(len(triangles), 512 + 2 * count)
            self.assertAlmostEqual(sum(area(vertices, t) for t in triangles), 1.0, places=9)
            heights = [2.0 * area(vertices, t) / lengths(vertices, t)[2] ** 2 for t in triangles]
            self.assertEqual(sum(h < 0.0201 for h in heights), count)
            self.assertAlmostEqual(min(heights), 0.02, places=9)

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

    def test_points_have_names_of_their_own(self):
        for chosen in maps.MAPS:
            names = {maps.point_name(x, y) for x in chosen.x.values for y in chosen.y.values}
            self.assertEqual(len(names), len(chosen.x.values) * len(chosen.y.values))

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
        return {"name": name, "title": name.upper(), "outcome": rows, "greatest": greatest, "not_ok": [[0], []],
                "edges": [[2.0 + 0.5 * (name == "none"), 9.0], [9.0, None]]}

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
                         "| [Made up](stability/made_up.png) | 4 | 1 | 1 | 1 | 0 | – | 2 (PBD) | 1 | 2 | 0 | 2 (2.5) |")

    def test_points(self):
        self.assertEqual(list(summary.held_by_baselines_alone(made_up_map())),
                         ["stiffness 1 N/m, stiffness 2 N/m: ours 20 %, XPBD 4 %, held by 2"])
        self.assertEqual(list(summary.worse_than_none(made_up_map())),
                         ["stiffness 2 N/m, stiffness 1 N/m: ours 75 %, no limiter 70 %",
                          "stiffness 2 N/m, stiffness 2 N/m: ours not finite, no limiter 80 %"])

    def test_a_limiter_that_gains_energy_does_not_hold(self):
        document = made_up_map()
        document["methods"][1]["outcome"] = ["gi", "wd"]
        self.assertTrue(summary.table([document])[2].endswith("| 2 (PBD) | 2 | 2 | 1 | – |"))
        self.assertEqual(list(summary.gaining_energy(document)),
                         ["stiffness 1 N/m, stiffness 1 N/m: areas 1 %"])

    def test_a_map_without_the_printed_matrix(self):
        document = made_up_map()
        document["methods"] = [m for m in document["methods"] if m["name"] != "apsl_printed"]
        self.assertIn("| 1 | 1 | 1 | – | – | 2 (PBD) |", summary.table([document])[2])

    def test_a_map_of_the_ceiling(self):
        document = made_up_map()
        document["methods"] = [document["methods"][0], {**document["methods"][1], "name": "apsl_ceiling"}]
        document["methods"][1]["outcome"] = ["hs", "wd"]
        self.assertIn("| 4 | 1 | – | – | – | 1 | – | 0 | 2 | 0 | 2 (2.5) |", summary.table([document])[2])

    def test_long_lists_are_cut(self):
        title, *points = summary.listed([made_up_map()], lambda _: [str(n) for n in range(20)])
        self.assertTrue(title.startswith("- ") and title.endswith(":"), title)
        self.assertEqual(points, [f"  - {n}" for n in range(11)] + ["  - and 9 more"])
        _, *points = summary.listed([made_up_map()], lambda _: [str(n) for n in range(12)])
        self.assertEqual(points, [f"  - {n}" for n in range(12)])

    def test_names_of_points(self):
        self.assertEqual(summary.named("place", "at the hem"), "place at the hem")
        self.assertEqual(summary.named("time step (s)", 1 / 60), "time step 1/60 s")
        self.assertEqual(summary.named("mass ratio", 1e5), "mass ratio 100 000")
        self.assertEqual(summary.named("speed (m/s)", 0.3), "speed 0.3 m/s")

    def test_nothing_found_is_said(self):
        self.assertEqual(summary.listed([made_up_map()], lambda _: []), ["None."])


class Picture(unittest.TestCase):
    def test_a_map_shows_its_outcomes(self):
        with tempfile.TemporaryDirectory() as folder:
            file, out = Path(folder) / "map.json", Path(folder) / "map.png"
            document = made_up_map()
            document["y"] = {"label": "place", "values": ["at the pins", "at the hem"]}
            document["methods"][-1]["outcome"][1] = "gg"
            file.write_text(json.dumps(document))
            subprocess.run([PROJECT / "bench/charts/stability_map.py", file, "--out", out], check=True,
                           capture_output=True, timeout=60)
            pixels = (image.imread(out)[:, :, :3] * 255.0).round().astype(int)
            seen = collections.Counter(map(tuple, pixels.reshape(-1, 3).tolist()))
        for colour in ((0x56, 0xB4, 0xE9), (0xF0, 0xE4, 0x42), (0xE6, 0x9F, 0x00), (0xAA, 0x44, 0x99), (0x22, 0x22, 0x22)):
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
