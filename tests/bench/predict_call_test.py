#!/usr/bin/python3
# SPDX-License-Identifier: MIT
"""bench/predict_call.py: by hand on a made-up report, on a report of the program, and what it refuses.

    predict_call_test.py APSL_PROGRAM PROJECT_FOLDER
"""
import json
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

PROGRAM, PROJECT = sys.argv.pop(1), Path(sys.argv.pop(1))
SCRIPT = PROJECT / "bench/predict_call.py"
sys.path.insert(0, str(SCRIPT.parent))

import predict_call

TABLE = predict_call.traffic_table(predict_call.TABLE.read_text())


def run(*arguments):
    return subprocess.run([sys.executable, SCRIPT, *map(str, arguments)], capture_output=True, text=True)


class PredictCall(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cls.temporary = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cls.temporary.cleanup)

    def file(self, name, document):
        path = Path(self.temporary.name) / name
        path.write_text(json.dumps(document))
        return path

    def test_by_hand(self):
        # Two calls of 4 sub-steps each, of which 2 are taken, with a second row.
        launches = {"predict_positions": 2, "order_stretch_limits": 2, "begin_solve": 8, "chebyshev_step": 40}
        report = {"vertices": 100, "triangles": 180, "frames": [{"sub_steps": 2}, {"sub_steps": 2}],
                  "kernels": [{"name": name, "launches": count} for name, count in launches.items()]}
        rows = {row[0]: row[1:] for row in predict_call.predict(report, TABLE, 1e9, 2e-6)}
        moved = 8 * 100 + (58 + 40) * 180  # 18.44 µs at 1 GB/s
        launched, bytes_a_launch, seconds = rows["chebyshev_step"]
        self.assertEqual((launched, bytes_a_launch), (20, moved))
        self.assertAlmostEqual(seconds, 10 * moved / 1e9 + 10 * 2e-6)
        self.assertEqual(rows["begin_solve"][1], None)
        self.assertAlmostEqual(rows["begin_solve"][2], 4 * 2e-6)
        self.assertAlmostEqual(rows["predict_positions"][2], 48 * 100 / 1e9)

    def test_of_the_program(self):
        report = Path(self.temporary.name) / "report.json"
        subprocess.run([PROGRAM, "run", PROJECT / "scenes/curtain.json", "--frames", "2", "--profile", "--report", report,
                        "--set", 'strain_limiting={"stretch_ceiling": 1.1}', "--set", "mesh.grid.vertices=[9,9]",
                        "--set", "pins[0].vertices=[0,8]"], check=True, capture_output=True)
        quick, slow = (run(report, "--bandwidth", bandwidth, "--launch", 4) for bandwidth in (1000, 0.1))
        self.assertEqual((quick.returncode, slow.returncode), (0, 0), quick.stderr + slow.stderr)
        total = [float(next(line for line in done.stdout.splitlines() if line.startswith("a call")).split()[-1])
                 for done in (quick, slow)]
        self.assertIn(f"launches alone: {total[0]:.0f} µs", quick.stdout)  # a tiny cloth on a quick device
        self.assertGreater(total[1], 2 * total[0])

    def test_refusals(self):
        for document, options, message in (
                ({"kernels": []}, (500, 4), "no kernels in it"),
                ({"kernels": [{"name": "filter_in_one_group", "launches": 1}]}, (500, 4), "in one group"),
                ({}, (0, 4), "expected numbers above 0")):
            done = run(self.file("bad.json", document), "--bandwidth", options[0], "--launch", options[1])
            self.assertEqual(done.returncode, 2)
            self.assertRegex(done.stderr, f"^error: .*{message}")
        self.assertEqual(run("missing.json", "--bandwidth", 1, "--launch", 1).returncode, 2)


if __name__ == "__main__":
    unittest.main()
