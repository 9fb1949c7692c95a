#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""The library's defaults on every shipped scene, and where cloth lives: in contact. Stand-alone scenes run as shipped,
for their ceiling is what holds them together. Each beside the cloth without a limiter: areas are held, edges are not
much longer, nothing is faster than it can be, and energy does not come from nowhere.

Usage: defaults_test.py APSL_PROGRAM PROJECT_FOLDER CASE [unittest's arguments]
"""
import json
import sys
import unittest

from acceptance_case import Case, project

sys.path.insert(0, str(project / "bench/stability"))

import outcome
import scene_map

FIRST_FRAMES = 10      # for settling
LONGER_EDGES = 2.0     # times the unlimited cloth's longest


def greatest(report, field, first=0):
    return max(frame[field] for frame in report["frames"][first:])


def run_of(report):
    """As bench/stability/outcome.py takes the runs of `apsl compare`."""
    return {"status": report["summary"]["status"], "start_energy": report["start_energy"],
            "greatest_energy": max(frame["energy"]["total"] for frame in report["frames"]),
            "energy": report["frames"][-1]["energy"]}


class Defaults(Case):
    """`SCENES`: by name the scene, as a document or a file in scenes/."""

    SCENES = {}
    FRAMES = 60
    AREA_CHANGE = {}  # the greatest after the first frames, by name of the scene
    FASTER = {}       # times the unlimited cloth's greatest speed, by name of the scene; 2 for the others

    @classmethod
    def document_of(cls, name):
        scene = cls.SCENES[name]
        return scene if isinstance(scene, dict) else json.loads((project / "scenes" / scene).read_text())

    @classmethod
    def run_scenes(cls):
        cls.reports = {}
        for name in cls.SCENES:
            document = cls.document_of(name)
            path = cls.folder(f"{name}.scene.json")
            path.write_text(json.dumps(document))
            limited, unlimited = ["strain_limiting={}"], ["strain_limiting=null"]
            if "stand_alone" in document.get("integrator", {}):
                # A stand-alone step is the limiter's own and needs its ceiling. Without it bending is what is left.
                limited, unlimited = [], [*unlimited, 'integrator={"bending_springs": {}}']
            cls.reports[name] = [
                cls.run_scene(f"{name}_{kind}", path, "--frames", str(cls.FRAMES),
                              *(argument for setting in settings for argument in ("--set", setting)))
                for kind, settings in (("limited", limited), ("unlimited", unlimited))]

    def judge(self, judge):
        """`judge(name, limited, unlimited)` of every scene, each by itself."""
        for name, reports in self.reports.items():
            with self.subTest(scene=name):
                judge(name, *reports)

    def test_areas_are_held(self):
        def judge(name, limited, unlimited):
            self.assertEqual(len(limited["frames"]), self.FRAMES)
            change = greatest(limited, "max_area_change", FIRST_FRAMES)
            self.assertLessEqual(change, self.AREA_CHANGE[name])
            self.assertLess(change, greatest(unlimited, "max_area_change", FIRST_FRAMES))

        self.judge(judge)

    def test_edges_are_not_much_longer_than_without_a_limiter(self):
        self.judge(lambda _, limited, unlimited: self.assertLessEqual(
            greatest(limited, "max_edge_stretch"), LONGER_EDGES * greatest(unlimited, "max_edge_stretch")))

    def test_nothing_is_much_faster_than_without_a_limiter(self):
        self.judge(lambda name, limited, unlimited: self.assertLessEqual(
            greatest(limited, "max_speed"), self.FASTER.get(name, 2) * greatest(unlimited, "max_speed")))

    def test_motion_and_height_never_hold_more_energy_than_there_was(self):
        def judge(name, limited, _):
            if not scene_map.driven(self.document_of(name)):
                highest = max(frame["energy"]["kinetic"] + frame["energy"]["gravity"] for frame in limited["frames"])
                self.assertLessEqual(highest, limited["start_energy"]["total"] + outcome.ENERGY_FLOOR)

        self.judge(judge)

    def test_no_energy_is_gained(self):
        def judge(name, limited, unlimited):
            if not scene_map.driven(self.document_of(name)):
                runs = run_of(limited), run_of(unlimited)
                self.assertFalse(outcome.gained_energy(*runs), runs)

        self.judge(judge)


class ShippedScenes(Defaults):
    """Every scenes/*.json, whatever settings it names."""

    SCENES = {path.stem: path.name for path in sorted((project / "scenes").glob("*.json"))
              if path.stem != "curtain_unfiltered"}  # scenes/curtain.json without its limiter
    FRAMES = 40
    AREA_CHANGE = {name: 0.01 for name in SCENES} | {"sphere_drape": 0.02}
    # The free corners of a cloth that does not stretch whip through its lowest point.
    FASTER = {"paper_fig6": 3, "stand_alone_curtain": 3, "pushed_curtain": 3}


def sheet(vertices, **more):
    return {"mesh": {"grid": {"vertices": [vertices, vertices]}},
            "integrator": {"implicit_springs": {"stretch_stiffness": 50}}, **more}


def sphere(x, y, z, radius, friction=0.3):
    return {"sphere": {"center": [x, y, z], "radius": radius, "friction": friction}}


class Contact(Defaults):
    SCENES = {
        "sheet_on_a_ball": sheet(33, colliders=[sphere(0, -0.3, 0, 0.3, friction=0)]),
        "tube_on_a_capsule": {**sheet(33), "mesh": {"tube": {"radius": [0.15, 0.3], "height": 0.6, "segments": [48, 24]}},
                              "colliders": [{"capsule": {"a": [0, -1.5, 0], "b": [0, 0.05, 0], "radius": 0.2,
                                                         "friction": 0.3}}]},
        "curtain_swings_onto_a_ball": sheet(33, pins=[{"vertices": [0, 32]}], colliders=[sphere(0, -0.45, -0.5, 0.25)]),
        "sheet_on_two_balls_and_a_floor": sheet(49, colliders=[
            sphere(-0.25, -0.25, 0, 0.2), sphere(0.25, -0.25, 0, 0.2),
            {"plane": {"point": [0, -0.45, 0], "friction": 0.3}}]),
    }
    AREA_CHANGE = {name: 0.02 for name in SCENES} | {"sheet_on_a_ball": 0.01}

    def test_a_ball_without_friction_does_not_tear_the_sheet(self):
        self.assertLessEqual(greatest(self.reports["sheet_on_a_ball"][0], "max_edge_stretch"), 1.3)


if __name__ == "__main__":
    unittest.main(argv=[sys.argv[0], *sys.argv[4:]], defaultTest=sys.argv[3])
