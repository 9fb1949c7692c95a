#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""Charts and summary of comparisons on made-up results: what is on the front, what is drawn, what goes wrong in one
line."""

import contextlib
import importlib
import io
import json
import math
import sys
import tempfile
import unittest
from pathlib import Path

from PIL import Image

CHARTS = Path(__file__).resolve().parents[3] / "bench" / "charts"
sys.path.insert(0, str(CHARTS))
import compare_results  # noqa: E402
import compare_summary  # noqa: E402

PAPER = {"strain_limiting.sub_steps": 10, "strain_limiting.regularization": 1.2, "strain_limiting.tolerance": 0.1}


def made_up_run(scene, method, milliseconds, mean, parameters=None, triangles=8192, status="ok"):
    return {"scene": scene, "method": method, "title": method.replace("_", " "),
            "parameters": {"steps_per_frame": 1, **(parameters or {"iterations": 5})},
            "status": status, "triangles": triangles, "frames": 2, "solves": 20, "iterations_per_solve": 3.5,
            "limiter_seconds_per_frame": {"median": 1e-3 * milliseconds},
            "frame_processor_seconds": {"median": 1e-3 * milliseconds + 5e-3},
            "max_area_change": 2.0 * mean, "mean_max_area_change": mean, "rms_area_change": 0.3 * mean,
            "mean_displacement": [0.0, -mean, 0.0], "frame_max_area_change": [mean, 2.0 * mean, None],
            "settled": {"max_area_change": mean, "max_edge_stretch": 1.0 + 2.0 * mean,
                        "max_principal_stretch": 1.0 + 3.0 * mean},
            "deviation": {"frames": [{"frame": 9, "rms": 0.01 * mean, "max": 0.1 * mean}]}}


def made_up_results(scene="curtain", triangles=8192):
    runs = [made_up_run(scene, "none", 0.0, 0.6, {"steps_per_frame": 1}, triangles)]
    for count in (5, 10, 20):
        parameters = {**PAPER, "strain_limiting.sub_steps": count}
        runs.append(made_up_run(scene, "apsl", 0.2 * count, 0.4 / count, parameters, triangles))
        runs.append(made_up_run(scene, "apsl_rising", 0.2 * count, 0.1 / count,
                                {"strain_limiting.sub_steps": count, "steps_per_frame": 1}, triangles))
    for count in (5, 20, 80):
        runs.append(made_up_run(scene, "pbd_edges", 0.5 * count, 0.8 / count, {"iterations": count}, triangles))
    runs.append(made_up_run(scene, "pbd_area", 1.0, math.nan, status="diverged", triangles=triangles))
    return {"machine": {"processor": "Made-up processor", "cores": 2}, "build_type": "Release",
            "scenes": [{"name": scene, "document": {}}], "runs": runs}


class Charts(unittest.TestCase):
    def setUp(self):
        holder = tempfile.TemporaryDirectory()
        self.addCleanup(holder.cleanup)
        self.folder = Path(holder.name)
        self.results = self.folder / "results.json"
        self.write(made_up_results())

    def write(self, results, name="results.json"):
        # NaN is what no JSON has: the program writes null.
        text = json.dumps(results).replace("NaN", "null")
        (self.folder / name).write_text(text)

    def run_chart(self, script, *arguments):
        module = importlib.import_module(script)
        said, complained = io.StringIO(), io.StringIO()
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(complained):
            code = module.exit_code_of(lambda _: module.run([str(argument) for argument in arguments]))
        return code, said.getvalue(), complained.getvalue()

    def test_front_keeps_what_nothing_beats(self):
        runs = [dict(milliseconds=time, error=error) for time, error in ((1, 9), (2, 10), (3, 4), (3, 5), (4, 4), (9, 1))]
        self.assertEqual([(run["milliseconds"], run["error"]) for run in compare_results.front(runs, "error")],
                         [(1, 9), (3, 4), (9, 1)])

    def test_time_at_an_error_lies_between_points_by_the_logarithms(self):
        runs = [dict(milliseconds=1.0, error=0.1), dict(milliseconds=100.0, error=0.001)]
        self.assertAlmostEqual(compare_results.time_at(runs, "error", 0.01), 10.0)
        self.assertEqual(compare_results.time_at(runs, "error", 0.2), 1.0)
        self.assertIsNone(compare_results.time_at(runs, "error", 0.0005))

    def test_every_chart_is_drawn(self):
        for script, arguments in (("pareto_chart", ("--scene", "curtain")), ("convergence_chart", ("--scene", "curtain")),
                                  ("compare_curves", ("--scene", "curtain")), ("locking_chart", ()),
                                  ("stretch_chart", ("--scene", "curtain", "--ceiling", "1.1")),
                                  ("whole_frame_chart", ()),
                                  ("refinement_chart", ("--target", "0.05")), ("deviation_chart", ())):
            with self.subTest(script=script):
                out = self.folder / f"{script}.png"
                code, _, complained = self.run_chart(script, self.results, *arguments, "--out", out)
                self.assertEqual((code, complained), (0, ""))
                with Image.open(out) as picture:
                    self.assertGreater(min(picture.size), 200)
                    blue = sum(count for count, colour in picture.convert("RGB").getcolors(1 << 24)
                               if colour == (0, 114, 178))
                self.assertGreater(blue, 50, "ours is not in it")

    def test_what_cannot_be_drawn_is_one_line(self):
        (self.folder / "broken.json").write_text("{")
        short = made_up_results()
        for run in short["runs"]:
            del run["settled"]
        self.write(short, "short.json")
        (self.folder / "other.json").write_text('{"runs": [{}], "scenes": []}')
        for script, arguments in (("pareto_chart", (self.results, "--scene", "nowhere")),
                                  ("stretch_chart", (self.folder / "short.json", "--scene", "curtain")),
                                  ("whole_frame_chart", (self.folder / "short.json",)),
                                  ("pareto_chart", (self.folder / "broken.json", "--scene", "curtain")),
                                  ("convergence_chart", (self.folder / "other.json", "--scene", "curtain")),
                                  ("compare_curves", (self.folder / "missing.json", "--scene", "curtain")),
                                  ("refinement_chart", (self.results, "--target", "1e-9"))):
            with self.subTest(script=script, arguments=arguments):
                code, said, complained = self.run_chart(script, *arguments, "--out", self.folder / "no.png")
                self.assertEqual((code, said), (2, ""))
                self.assertRegex(complained, r"\Aerror: [^\n]+\n\Z")
                self.assertFalse((self.folder / "no.png").exists())

    def test_summary_compares_with_the_paper_and_the_best_baseline(self):
        self.write(made_up_results(), "curtain_8k.json")
        self.write(made_up_results(triangles=32768), "curtain_32k.json")
        self.write(made_up_results(), "refinement.json")
        self.write(made_up_results(), "front.json")
        code, said, complained = self.run_chart("compare_summary", self.folder)
        self.assertEqual((code, complained), (0, ""))
        self.assertNotIn("principal stretch", said)  # there is no file of it
        # 10 sub-steps take 2 ms: 4 % with the paper's setting, 1 % with rising α, which has 4 % after 1 ms at most.
        self.assertIn("a third of 4 % | 1 %, 4 times less", said)
        self.assertRegex(said, r"\| curtain \| the paper's: 1\.2, 10 \| 4 % \| .* \| 1\.00 \|")
        # 4 % takes PBD edges 10 ms, ours at most 1 ms.
        runs = compare_results.read_results(self.folder / "curtain_8k.json")["runs"]
        held = [run for run in runs if run["method"] != "none" and compare_results.held(run)]
        level, ours, baseline, title = compare_summary.against_baselines(held)[3]
        self.assertEqual((level, title), (0.05, "pbd edges"))
        self.assertAlmostEqual(ours, 1.0)
        self.assertAlmostEqual(baseline, 2.5 * 4.0 ** (math.log(0.16 / 0.05) / math.log(4.0)))

    def test_summary_says_who_holds_areas_and_stretch(self):
        for name in ("curtain_8k", "refinement", "front"):
            self.write(made_up_results(), f"{name}.json")
        self.write(made_up_results(triangles=32768), "curtain_32k.json")
        results = made_up_results()
        ceiling = {"strain_limiting.stretch_ceiling": 1.1, "strain_limiting.sub_steps": 20}
        results["runs"] += [made_up_run("curtain", "apsl_defaults", 2.0, 0.005, {"steps_per_frame": 1}),
                            made_up_run("curtain", "apsl_ceiling", 6.0, 0.003, ceiling),
                            made_up_run("curtain", "apsl_ceiling", 7.0, 0.004, {**ceiling, "strain_limiting.sub_steps": 30})]
        self.write(results, "stretch.json")
        self.write(made_up_results(), "whole_frame.json")
        code, said, complained = self.run_chart("compare_summary", self.folder)
        self.assertEqual((code, complained), (0, ""))
        self.assertIn("| ceiling 1.1, 20 sub-steps | 1 | 0.3 % | 1.006 | 1.009 | 3.00 | yes |", said)
        self.assertIn("| ceiling 1.1, 30 sub-steps | 1 | 0.4 % | 1.008 | 1.012 | 3.50 | no |", said)
        self.assertIn("| none | 1 | 60 % | 2.200 | 2.800 | – | no |", said)
        self.assertIn("| curtain | apsl, 10, α 1.2 | 4 % | 1.080 | 1.120 | 7 |", said)  # 2 ms in the limiter, 5 for the rest
        for line in said.splitlines():
            self.assertNotRegex(line.removeprefix("| |"), r"\| +\|", line)


if __name__ == "__main__":
    unittest.main()
