# SPDX-License-Identifier: MIT
"""The annotations: against the module itself (stubtest), and as a user's type checker sees them.

Usage: types_test.py PROJECT_FOLDER
"""
import dataclasses
import subprocess
import sys
import tempfile
import unittest
from pathlib import Path

import apsl
from cloth import CORNER, ONE_TRIANGLE, limiter

RIGHT = """\
import apsl, numpy as np
limiter = apsl.StrainLimiter(np.zeros((1, 3), int), 3, device=0, warm_start_sub_steps=2, matrix="printed")
velocities, stats = limiter.limit(np.zeros((3, 3)), [[0, 0, 0]] * 3, [1, 1, 1], [1.0], time_step=1 / 60, sub_steps=3)
velocities.astype(np.float64)
on_device = apsl.StrainLimiter([[0, 1, 2]], 3, context=1, position_stride=4)
array = (2, 64)
on_device.enqueue(3, array, 4, array, array, wait_for=[5], time_step=1 / 60, rest_shapes=array)
anchors, lengths = apsl.tethers_to_pins(np.zeros((3, 3)), [[0, 1, 2]], [0], apsl.pinned_piece_count([[0, 1, 2]], 3, [0]))
hanging = apsl.StrainLimiter([[0, 1, 2]], 3, integrates=True, tethers_per_vertex=anchors.shape[1])
hanging.step([], [], [], [], tether_anchors=anchors, tether_lengths=2 * lengths)
residual: float = on_device.read_stats(3).residual
best: float = min(stats.max_area_change, apsl.area_change(velocities, [[0, 1, 2]], [1.0]).max())
"""
WRONG = {
    'apsl.StrainLimiter([[0, 1, 2]], "3")': "call-overload",
    'apsl.StrainLimiter([[0, 1, 2]], 3, matrix="dense")': "call-overload",
    "apsl.StrainLimiter([[0, 1, 2]], 3, strides=4)": "call-overload",
    'limiter.limit([], [], [], [], sub_steps="ten")': "arg-type",
    "limiter.limit([], [], [], [], sub_step=10)": "call-arg",
    "apsl.StrainLimiter([[0, 1, 2]], 3, position_stride=4)": "call-overload",
    'on_device.enqueue("queue", 2, 4, 5, 6)': "arg-type",
    "on_device.enqueue(3, np.zeros((3, 3)), 4, 5, 6)": "arg-type",
    "stats.maximum": "attr-defined",
    "apsl.StrainLimiter([[0, 1, 2]], 3, tethers_per_vertex=[1])": "call-overload",
    'apsl.tethers_to_pins([], [], [], 1, stretch="1")': "arg-type",
}


def mypy(*arguments):
    return subprocess.run([sys.executable, "-m", *arguments], capture_output=True, text=True, timeout=100)


class Types(unittest.TestCase):
    @classmethod
    def setUpClass(cls):
        cache = tempfile.TemporaryDirectory()
        cls.addClassCleanup(cache.cleanup)
        cls.cache = f"--cache-dir={cache.name}"  # reading numpy's types is most of a run

    def test_stubs_are_the_module_s(self):
        with tempfile.TemporaryDirectory() as folder:
            allowed = Path(folder) / "allowed"
            # Their metaclass is pybind11's own, which has no stub.
            allowed.write_text("apsl\\._core\\.(Device)?Limiter\n")
            result = mypy("mypy.stubtest", "apsl", "--allowlist", str(allowed))
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_the_package_is_sound(self):
        result = mypy("mypy", "--strict", self.cache, "-p", "apsl")
        self.assertEqual(result.returncode, 0, result.stdout + result.stderr)

    def test_a_users_program(self):
        wrong_lines = "".join(line + "\n" for line in WRONG)
        with tempfile.TemporaryDirectory() as folder:
            program = Path(folder) / "program.py"
            program.write_text(RIGHT + wrong_lines)
            result = mypy("mypy", "--strict", self.cache, str(program))
        found = {int(line.split(":")[1]): line for line in result.stdout.splitlines() if ": error:" in line}
        first = RIGHT.count("\n") + 1
        self.assertEqual(sorted(found), list(range(first, first + len(WRONG))), result.stdout + result.stderr)
        for place, kind in enumerate(WRONG.values(), first):
            self.assertIn(f"[{kind}]", found[place])

    def test_stats_are_of_the_types_they_say(self):
        _, stats = limiter(ONE_TRIANGLE, 3).limit(CORNER, 0 * CORNER, [1, 1, 1], [0.5])
        types = {"int": int, "float": float}
        for field in dataclasses.fields(apsl.Stats):
            self.assertIsInstance(getattr(stats, field.name), types.get(field.type, str), field.name)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
