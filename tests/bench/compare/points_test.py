#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Of each chart's data in docs/accuracy one small point of ours and one of a baseline, run again: the same error figures.

On the processor and OpenCL device that the data names they must be equal to rounding of what is printed. On another one
floats round differently and the motion is chaotic, so there each figure is only a fair sample of the same motion."""

import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, PROJECT = sys.argv.pop(1), Path(sys.argv.pop(1))
DATA = sorted(path for path in (PROJECT / "docs" / "accuracy").glob("*.json")
              if not path.name.endswith(".converged.json"))
FIGURES = ("max_area_change", "mean_max_area_change", "rms_area_change")
SAME_DEVICE, OTHER_DEVICE = 1e-6, 0.35
TIME_LIMIT = 1800  # s, of a run: how busy a machine is must not decide


def cheapest(runs, ours):
    """Of runs that held, the one whose limiter and triangles cost least."""
    candidates = [run for run in runs if run["status"] == "ok" and run["method"] != "none"
                  and run["method"].startswith("apsl") == ours and run["method"] != "apsl_direct"]
    return min(candidates, key=lambda run: (run["triangles"] * run["frames"],
                                            run["limiter_seconds_per_frame"]["median"]))


def run_again(results, run, folder):
    """`run` once more, and whether on the same machine."""
    scene = next(scene for scene in results["scenes"] if scene["name"] == run["scene"])
    (folder / "scene.json").write_text(json.dumps(scene["document"]))
    study = {"scenes": [{"file": "scene.json", "name": run["scene"]}],
             "methods": [{"name": run["method"], "parameters": run["parameters"]}]}
    (folder / "study.json").write_text(json.dumps(study))
    out = folder / "again.json"
    subprocess.run([PROGRAM, "compare", "--study", str(folder / "study.json"), "--out", str(out),
                    "--run-seconds", str(TIME_LIMIT)], check=True, capture_output=True)
    again = json.loads(out.read_text())
    same = all(again["machine"][key] == results["machine"][key] for key in ("processor", "opencl_device"))
    return again["runs"][0], same


class Points(unittest.TestCase):
    def test_there_is_data_for_every_chart(self):
        studies = {path.stem for path in (PROJECT / "bench" / "studies").glob("*.json")}
        studies.remove("refinement_500k")  # goes into refinement's
        studies.remove("whole_frame_131k")  # goes into whole_frame's
        self.assertEqual({path.stem for path in DATA}, studies)

    def test_points_come_out_the_same(self):
        for path in DATA:
            results = json.loads(path.read_text())
            for ours in (True, False):
                run = cheapest(results["runs"], ours)
                with self.subTest(data=path.name, method=run["method"]), tempfile.TemporaryDirectory() as folder:
                    again, same = run_again(results, run, Path(folder))
                    self.assertEqual(again["parameters"], run["parameters"])
                    self.assertEqual(again["status"], run["status"])
                    for figure in FIGURES:
                        self.assertLessEqual(abs(again[figure] - run[figure]),
                                             (SAME_DEVICE if same else OTHER_DEVICE) * run[figure], figure)


if __name__ == "__main__":
    unittest.main()
