#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""apsl tune on tiny scenes: the tuned scene meets its target and keeps all else.

Usage: tune_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

program = Path(sys.argv[1])

FLAG = {"mesh": {"grid": {"vertices": [7, 7]}}, "pins": [{"vertices": [0, 6]}], "time_step": 0.02, "frames": 32,
        "strain_limiting": {"target_area_change": 0.0, "sub_steps": 1},
        "integrator": {"implicit_springs": {"stretch_stiffness": 5.0}}}
# The ten frames of settling and a few.
SHORT = {**FLAG, "frames": 14}
FAR_AWAY = [{"sphere": {"center": [0, -40, 0], "radius": 0.1}}]


class Tune(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.scene = self.write("flag.json", FLAG)
        self.out = self.folder / "tuned.json"

    def write(self, name, document):
        file = self.folder / name
        file.write_text(json.dumps(document))
        return file

    def apsl(self, *arguments, code=0):
        done = subprocess.run([str(a) for a in (program, *arguments)], capture_output=True, text=True, timeout=100)
        self.assertEqual(done.returncode, code, done.stdout + done.stderr)
        return done

    def summary(self, scene):
        report = self.folder / "report.json"
        self.apsl("run", scene, "--report", report)
        return json.loads(report.read_text())["summary"]

    def test_the_tuned_scene_meets_the_target_and_keeps_the_rest(self):
        self.assertGreater(self.summary(self.scene)["max_area_change"], 0.01)
        done = self.apsl("tune", self.scene, "--target", 0.01, "--out", self.out)
        self.assertIn("meets the target", done.stdout)
        self.assertNotIn("could go: strain_limiting", done.stdout)
        self.assertEqual(done.stderr, "")
        self.assertLessEqual(self.summary(self.out)["max_area_change"], 0.01)
        tuned = json.loads(self.out.read_text())
        self.assertEqual([key for key in tuned if key != "steps_per_frame"], list(FLAG))
        frame = tuned["time_step"] * tuned.get("steps_per_frame", 1)
        self.assertAlmostEqual(frame, FLAG["time_step"])
        for key in ("mesh", "pins", "frames", "integrator"):
            self.assertEqual(tuned[key], FLAG[key])
        self.assertEqual(list(tuned["strain_limiting"])[:2], list(FLAG["strain_limiting"]))

    def settled_stretch(self, scene):
        report = self.folder / "report.json"
        self.apsl("run", scene, "--report", report)
        return max(frame["max_principal_stretch"] for frame in json.loads(report.read_text())["frames"][10:])

    def test_a_target_of_two_numbers_holds_both(self):
        scene = self.write("short.json", SHORT)
        self.assertGreater(self.settled_stretch(scene), 1.2)
        done = self.apsl("tune", scene, "--target", 0.02, "--target-stretch", 1.1, "--out", self.out)
        self.assertIn("meets the target", done.stdout)
        self.assertIn("misses the stretch", done.stdout)
        tuned = json.loads(self.out.read_text())["strain_limiting"]
        self.assertIn(tuned["stretch_ceiling"], (1.095, 1.075))
        self.assertLessEqual(self.settled_stretch(self.out), 1.1)
        self.assertLessEqual(self.summary(self.out)["max_area_change"], 0.02)

    def test_a_scene_with_a_ceiling_is_tuned_for_it(self):
        scene = self.write("ceiling.json", {**SHORT, "strain_limiting": {"stretch_ceiling": 1.1, "sub_steps": 2}})
        self.apsl("tune", scene, "--target", 0.05, "--out", self.out)
        self.assertEqual(json.loads(self.out.read_text())["strain_limiting"]["stretch_ceiling"], 1.1)
        self.assertLessEqual(self.settled_stretch(self.out), 1.125)
        # What no limiter is asked for the springs do not do: areas of 90 % are nearly free, the stretch is not.
        done = self.apsl("tune", scene, "--target", 0.9, "--out", self.out)
        self.assertIn("misses the stretch", done.stdout.splitlines()[1])
        self.assertNotIn("could go: strain_limiting", done.stdout)

    def test_the_scene_goes_to_standard_output_alone(self):
        done = self.apsl("tune", self.scene, "--target", 0.2, "--frames", 2, "--set", "density=0.3")
        self.assertEqual(json.loads(done.stdout)["density"], 0.3)
        self.assertIn("sub-steps  stepping     first α  last α", done.stderr)

    def test_stages_that_could_go_are_named(self):
        scene = self.write("easy.json", {**FLAG, "colliders": FAR_AWAY, "frames": 4})
        done = self.apsl("tune", scene, "--target", 0.9, "--out", self.out)
        self.assertIn("could go: strain_limiting", done.stdout)
        self.assertIn("could go: bending", done.stdout)
        self.assertIn("could go: colliders", done.stdout)
        near = [{"plane": {"point": [0, -0.001, 0]}}]
        scene = self.write("near.json", {**FLAG, "colliders": near, "frames": 4})
        self.assertNotIn("colliders", self.apsl("tune", scene, "--target", 0.9, "--out", self.out).stdout)

    def test_a_limiter_without_springs_could_not_go(self):
        free = {"mesh": FLAG["mesh"], "frames": 2, "strain_limiting": {"stretch_ceiling": 1.1, "sub_steps": 2}}
        for integrator in ({"stand_alone": {}}, {"none": {}}):
            with self.subTest(integrator=integrator):
                scene = self.write("free.json", {**free, "integrator": integrator})
                done = self.apsl("tune", scene, "--target", 0.9, "--out", self.out)
                # Gravity alone meets the target too: nothing holds the cloth.
                self.assertIn("meets the target", done.stdout.splitlines()[1])
                self.assertNotIn("could go: strain_limiting", done.stdout)

    def test_what_cannot_be_met_is_said_and_the_best_written(self):
        done = self.apsl("tune", self.scene, "--target", 1e-9, "--budget-ms", 1e-6, "--frames", 3, "--out", self.out,
                         code=1)
        self.assertIn("no settings tried meet", done.stderr)
        self.assertIn("within the budget", done.stderr)
        self.assertIn("sub_steps", json.loads(self.out.read_text())["strain_limiting"])

    def test_a_mesh_file_is_found_from_where_the_tuned_scene_lies(self):
        (self.folder / "one.obj").write_text("v 0 0 0\nv 1 0 0\nv 1 0 1\nv 0 0 1\nf 1 2 3 4\n")
        scene = self.write("file.json", {"mesh": {"file": "one.obj"}, "frames": 1})
        (self.folder / "sub").mkdir()
        out = self.folder / "sub/tuned.json"
        self.apsl("tune", scene, "--target", 0.5, "--out", out)
        self.assertEqual(json.loads(out.read_text())["mesh"], {"file": "../one.obj"})
        self.apsl("validate", out)

    def test_wrong_input_is_one_line(self):
        for arguments, what in (
                ((self.scene,), "--target"), ((self.scene, "--target", "0"), "target"),
                ((self.scene, "--target", "0.1", "--target-stretch", "1"), "target-stretch"),
                ((self.scene, "--target", "nan"), "--target: is nan, expected a finite number > 0"),
                ((self.scene, "--target", "0.1", "--target-stretch", "nan"),
                 "--target-stretch: is nan, expected a finite number >= 1.01"),
                ((self.scene, "--target", "0.1", "--budget-ms", "inf"),
                 "--budget-ms: is inf, expected a finite number > 0"),
                ((self.scene, "--target", "0.1", "--budget-ms", "-1"), "budget-ms"),
                ((self.folder / "absent.json", "--target", "0.1"), "no such scene file"),
                ((self.scene, "--target", "0.1", "--set", "density=-1"), "density"),
                ((self.scene, "--target", "0.1", "--out", self.folder / "none/t.json"), "no such folder")):
            with self.subTest(arguments=arguments):
                errors = self.apsl("tune", *arguments, code=2).stderr
                self.assertIn(what, errors)
                self.assertEqual(errors.count("\n"), 1, errors)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
