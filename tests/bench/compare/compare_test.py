#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""apsl compare on tiny scenes: results fit their schema, are made once, and stand whatever comes.

Usage: compare_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import json
import signal
import subprocess
import sys
import tempfile
import time
import unittest
from pathlib import Path

import jsonschema

program, project = Path(sys.argv[1]), Path(sys.argv[2])
SCHEMA = json.loads((project / "docs/compare.schema.json").read_text())
STUDY_SCHEMA = json.loads((project / "docs/study.schema.json").read_text())

FLAG = {"mesh": {"grid": {"vertices": [7, 7]}}, "pins": [{"vertices": [0, 6]}], "frames": 6,
        "integrator": {"implicit_springs": {"stretch_stiffness": 5.0}}, "strain_limiting": {"sub_steps": 4}}
# In free fall nothing limits anything: every limiter leaves the same motion.
FALL = {"mesh": {"grid": {"vertices": [3, 3]}}, "frames": 6, "integrator": {"none": {}}}


class Compare(unittest.TestCase):
    def setUp(self):
        temporary = tempfile.TemporaryDirectory()
        self.addCleanup(temporary.cleanup)
        self.folder = Path(temporary.name)
        self.out = self.folder / "results.json"
        self.flag = self.write("flag.json", FLAG)

    def write(self, name, document):
        file = self.folder / name
        file.write_text(json.dumps(document))
        return file

    def compare(self, *arguments, code=0):
        done = subprocess.run([str(a) for a in (program, "compare", *arguments)], capture_output=True, text=True,
                              timeout=120)
        self.assertEqual(done.returncode, code, done.stderr)
        return done

    def results(self):
        results = json.loads(self.out.read_text())
        jsonschema.validate(results, SCHEMA)
        return results

    def test_all_methods_fit_the_schema(self):
        self.compare(self.flag, "--frames", 2, "--set", "mesh.grid.vertices=[4,4]", "--set", "pins.0.vertices=[0,3]",
                     "--out", self.out)
        runs = self.results()["runs"]
        keys = [json.dumps([run["method"], run["parameters"]], sort_keys=True) for run in runs]
        self.assertEqual(len(keys), len(set(keys)))
        ours = {"none", "springs", "apsl", "apsl_printed", "apsl_adaptive", "apsl_direct", "apsl_small_steps", "apsl_chebyshev",
                "apsl_ceiling", "apsl_stand_alone", "apsl_tethers", "tethers", "pbd_small_steps", "strain_based_dynamics_small_steps",
                "apsl_several_steps"}
        self.assertLess(ours, {run["method"] for run in runs})
        for run in runs:
            self.assertEqual(run["frames"], 2)
            self.assertEqual((run["vertices"], run["triangles"]), (16, 18))
            self.assertGreaterEqual(run["max_area_change"], run["rms_area_change"])
            if run["method"] not in ("none", "springs"):
                self.assertGreater(run["limiter_seconds_per_frame"]["median"], 0.0)

    def test_limiters_limit(self):
        self.compare(self.flag, "--methods", "none,springs,apsl,apsl_direct", "--frames", 20, "--out", self.out)
        change = {}
        for run in self.results()["runs"]:
            change.setdefault(run["method"], []).append(run["max_area_change"])
        none = change["none"][0]
        self.assertEqual(change["springs"][0], none)  # factor 1 is the scene itself
        self.assertLess(min(change["springs"]), 0.5 * none)
        self.assertLess(max(change["apsl"]), 0.9 * none)
        self.assertLess(min(change["apsl"]), 0.01)
        self.assertLess(min(change["apsl_direct"]), 0.01)

    def test_what_settled_frames_hold_is_told_of_every_method(self):
        self.compare(self.flag, "--methods", "none,apsl_ceiling,pbd_edges", "--frames", 16, "--out", self.out)
        stretch = {}
        for run in self.results()["runs"]:
            settled = run["settled"]
            self.assertLessEqual(settled["max_area_change"], run["max_area_change"])
            self.assertLessEqual(settled["max_edge_stretch"], settled["max_principal_stretch"] + 1e-6)
            self.assertLessEqual(settled["max_edge_stretch"], run["edge_stretch"]["max"])
            stretch.setdefault(run["method"], []).append(settled["max_principal_stretch"])
        self.assertGreater(stretch["none"][0], 1.3)
        self.assertLess(max(stretch["apsl_ceiling"]), 1.13)
        self.assertLess(min(stretch["pbd_edges"]), stretch["none"][0])
        # Ten frames are for settling alone.
        self.out.unlink()
        self.compare(self.flag, "--methods", "none", "--frames", 10, "--out", self.out)
        self.assertNotIn("settled", self.results()["runs"][0])

    def test_tethers_are_whole_steps_in_the_integrators_place(self):
        self.compare(self.flag, "--methods", "tethers,none", "--frames", 30, "--out", self.out)
        runs = {run["parameters"].get("small_steps"): run for run in self.results()["runs"]}
        self.assertEqual(set(runs), {None, 5, 10, 20, 40, 80})
        for steps in (20, 40, 80):
            run = runs[steps]
            self.assertEqual((run["status"], run["device"], run["frames"]), ("ok", "this processor", 30))
            self.assertEqual(run["energy"]["springs"], 0.0)
            self.assertLess(run["settled"]["max_principal_stretch"], 1.1)
            self.assertLess(run["settled"]["max_area_change"], 0.1)
            self.assertGreater(run["frame_processor_seconds"]["third_quartile"], 0.0)
        self.assertGreater(runs[None]["settled"]["max_principal_stretch"], 1.2)
        # It falls as the springs let it fall: both swing below their pins.
        self.assertLess(runs[20]["mean_displacement"][1], 0.5 * runs[None]["mean_displacement"][1])

    def test_finished_runs_are_not_made_again(self):
        self.compare(self.flag, "--methods", "none", "--out", self.out)
        first = self.results()["runs"]
        done = self.compare(self.flag, "--methods", "none,apsl_printed", "--out", self.out)
        self.assertIn("16 runs, 1 of them done before", done.stdout)
        self.assertEqual(self.results()["runs"][0], first[0])  # times and all
        before = self.out.read_bytes()
        self.assertIn("16 runs, 16 of them done before",
                      self.compare(self.flag, "--methods", "none,apsl_printed", "--out", self.out).stdout)
        self.assertEqual(self.out.read_bytes(), before)
        # Other settings of a scene are no results of this one.
        done = self.compare(self.flag, "--frames", 3, "--methods", "none", "--out", self.out, code=2)
        self.assertIn("holds a scene flag with other settings", done.stderr)
        self.assertEqual(self.out.read_bytes(), before)

    def test_times_are_medians_over_the_rounds(self):
        arguments = [self.flag, "--methods", "none,apsl", "--frames", 3, "--set", "mesh.grid.vertices=[4,4]",
                     "--set", "pins.0.vertices=[0,3]", "--out", self.out]
        self.compare(*arguments)
        first = self.results()["runs"]
        self.assertNotIn("rounds", first[0])
        done = self.compare(*arguments, "--rounds", 3)
        self.assertIn(f"{3 * len(first)} runs, {len(first)} of them done before", done.stdout)
        for before, after in zip(first, self.results()["runs"], strict=True):
            self.assertEqual(before["parameters"], after["parameters"])
            self.assertEqual(before["max_area_change"], after["max_area_change"])
            self.assertEqual(len(after["rounds"]), 3)
            self.assertEqual(after["rounds"][0], {**before["limiter_seconds_per_frame"], "commit": before["commit"],
                                                  "frame_processor_seconds": before["frame_processor_seconds"]})
            for name, value in after["limiter_seconds_per_frame"].items():
                self.assertEqual(value, sorted(entry[name] for entry in after["rounds"])[1])
            for name, value in after["frame_processor_seconds"].items():
                self.assertEqual(value, sorted(entry["frame_processor_seconds"][name] for entry in after["rounds"])[1])
        self.assertIn(f"{3 * len(first)} of them done before", self.compare(*arguments, "--rounds", 3).stdout)

    def test_an_interruption_keeps_what_is_finished(self):
        study = self.write("study.json", {
            "scenes": [{"file": "flag.json"}, {"file": "flag.json", "name": "endless", "set": {"frames": 1000000}}],
            "methods": ["none"]})
        running = subprocess.Popen([program, "compare", "--study", study, "--out", self.out], text=True,
                                   stdout=subprocess.DEVNULL, stderr=subprocess.PIPE)
        for _ in range(300):
            if self.out.exists():
                break
            time.sleep(0.1)
        time.sleep(0.2)
        running.send_signal(signal.SIGINT)
        errors = running.communicate(timeout=30)[1]
        self.assertEqual(running.returncode, 130, errors)
        self.assertIn("interrupted before run 2 of 2", errors)
        self.assertEqual([run["scene"] for run in self.results()["runs"]], ["flag"])

    def test_an_input_is_never_overwritten(self):
        mesh = self.folder / "one.obj"
        mesh.write_text("v 0 0 0\nv 1 0 0\nv 0 0 1\nf 1 2 3\n")
        scene = self.write("one.json", {"mesh": {"file": "one.obj"}, "frames": 1})
        study = self.write("study.json", {"methods": ["none"]})
        solution = self.write("r.one.converged.json", {"mesh": {"file": "one.obj"}, "frames": 1})
        for input_file, what, out in ((scene, "scene", scene), (mesh, "mesh", mesh), (study, "study", study)):
            with self.subTest(what=what):
                before = input_file.read_bytes()
                done = self.compare(scene, "--study", study, "--out", out, code=2)
                self.assertEqual(done.stderr, f"error: {out}: would overwrite the {what}, {input_file}, "
                                              "expected another place for the output\n")
                self.assertEqual(input_file.read_bytes(), before)
        self.assertIn(f"would overwrite the scene, {solution}",
                      self.compare(scene, solution, "--methods", "none", "--out", self.folder / "r.json", code=2).stderr)

    def test_out_of_time_is_a_result_that_more_time_replaces(self):
        arguments = [self.flag, "--methods", "none", "--frames", 300, "--out", self.out]
        self.compare(*arguments, "--run-seconds", 1e-9)
        run = self.results()["runs"][0]
        self.assertEqual((run["status"], run["frames"], run["stopped"]["frame"]), ("timed_out", 1, 0))
        self.compare(*arguments, "--run-seconds", 50)
        runs = self.results()["runs"]
        self.assertEqual([(run["status"], run["frames"]) for run in runs], [("ok", 300)])

    def test_a_method_that_diverges_is_a_result(self):
        self.compare(self.flag, "--methods", "none", "--set", "gravity=[0,-1e308,0]", "--set", "time_step=100",
                     "--set", "integrator.none={}", "--out", self.out)
        run = self.results()["runs"][0]
        self.assertEqual(run["status"], "diverged")
        self.assertEqual(run["stopped"]["frame"], run["frames"] - 1)

    def test_deviation_is_measured_from_the_converged_solution(self):
        self.write("fall.json", FALL)
        study = self.write("study.json", {"scenes": [{"file": "fall.json"}, {"file": "flag.json"}],
                                          "methods": ["none", {"name": "apsl", "parameters": {}}],
                                          "deviation": {"frames": [0, 5], "step_factor": 1}})
        self.compare("--study", study, "--out", self.out)
        for run in self.results()["runs"]:
            frames = run["deviation"]["frames"]
            self.assertEqual([at["frame"] for at in frames], [0, 5])
            if run["scene"] == "fall":
                self.assertLess(frames[1]["max"], 1e-6)
            elif run["method"] == "none":
                self.assertGreater(frames[1]["max"], 1e-3)
                self.assertGreater(frames[1]["max"], frames[1]["rms"])
        flag = {run["method"]: run["deviation"]["frames"][1]["rms"]
                for run in self.results()["runs"] if run["scene"] == "flag"}
        self.assertLess(flag["apsl"], 0.5 * flag["none"])
        # The converged solution is kept, and made anew for other settings.
        cache = self.folder / "results.flag.converged.json"
        stamp = cache.stat().st_mtime_ns
        other = json.loads(study.read_text()) | {"methods": ["springs"]}
        self.compare("--study", self.write("other.json", other), "--out", self.out)
        self.assertEqual(cache.stat().st_mtime_ns, stamp)
        other["deviation"]["step_factor"] = 2
        self.compare("--study", self.write("other.json", other), "--out", self.out)
        self.assertNotEqual(cache.stat().st_mtime_ns, stamp)

    def test_device_time_is_asked_for(self):
        study = self.write("study.json", {"scenes": [{"file": "flag.json"}], "methods": [
            "none", {"name": "apsl", "parameters": {"strain_limiting.sub_steps": 3}}]})
        self.compare("--study", study, "--out", self.out)
        self.assertEqual([run["device_seconds_per_frame"] for run in self.results()["runs"]], [None, None])
        self.compare("--study", study, "--profile", "--out", self.out)
        none, ours = self.results()["runs"]
        self.assertIsNone(none["device_seconds_per_frame"])
        self.assertGreater(ours["device_seconds_per_frame"], 0.0)

    def test_the_study_schema_knows_what_the_program_takes(self):
        full = {"scenes": [{"file": "flag.json", "name": "a", "set": {"density": 0.3}}],
                "methods": ["none", {"name": "springs", "parameters": {"stretch_stiffness_factor": [1, 2]}}],
                "deviation": {"frames": [1], "step_factor": 1, "sub_steps": 5, "regularization": 1.1,
                              "tolerance": 0.01, "target_area_change": 0.01}, "run_seconds": 60, "rounds": 2}
        jsonschema.validate(full, STUDY_SCHEMA)
        self.compare("--study", self.write("study.json", full), "--out", self.out)
        for path in ((), ("scenes", 0), ("methods", 1), ("deviation",)):
            wrong = json.loads(json.dumps(full))
            place = wrong
            for key in path:
                place = place[key]
            place["zebra"] = 1
            with self.assertRaises(jsonschema.ValidationError):
                jsonschema.validate(wrong, STUDY_SCHEMA)
            self.assertIn("zebra", self.compare("--study", self.write("study.json", wrong), "--out", self.out,
                                                code=2).stderr)

    def test_wrong_input_is_one_line(self):
        self.write("taken.json", {"my": "file"})
        for arguments, what in (
                ((), "no scene"), ((self.folder / "absent.json",), "no such scene file"),
                ((self.flag, "--methods", "wishing"), 'unknown method "wishing"'),
                ((self.flag, "--set", "density=-1"), "density: expected a number > 0"),
                ((self.flag, "--set", "strain_limiting.tolerance=2"), "tolerance"),
                ((self.flag, self.flag), "two scenes are named flag"),
                ((self.flag, "--deviation-frames", "99"), "deviation at frame 99, expected one from 0 to 5"),
                ((self.flag, "--methods", "none", "--out", self.folder / "taken.json"), "holds no results"),
                ((self.flag, "--methods", "none", "--out", self.folder / "none/r.json"), "no such folder"),
                ((self.flag, "--run-seconds", "-1"), "run-seconds"), ((self.flag, "--nonsense"), "nonsense")):
            with self.subTest(arguments=arguments):
                out = () if "--out" in arguments else ("--out", self.out)
                errors = self.compare(*arguments, *out, code=2).stderr
                self.assertIn(what, errors)
                self.assertEqual(errors.count("\n"), 1, errors)
        self.assertFalse(self.out.exists())
        self.assertEqual((self.folder / "taken.json").read_text(), json.dumps({"my": "file"}))


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
