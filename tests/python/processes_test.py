# SPDX-License-Identifier: MIT
"""Processes: those started afresh work; those forked from one that has used OpenCL are told so, and never hang."""

import multiprocessing
import os
import subprocess
import sys
import unittest

import apsl
from cloth import Grid, limiter

SECONDS = 100  # far beyond what any of these takes: what hangs


def limited(seed):
    cloth = Grid(4, seed)
    return limiter(cloth.triangles, cloth.vertex_count).limit(*cloth.arrays(), sub_steps=2)[0].tobytes()


def what_it_says(call, *arguments):
    try:
        call(*arguments)
    except apsl.Error as error:
        return error.code, str(error)
    return "nothing", ""


def reuse():
    cloth = Grid(4)
    return made.limit(*cloth.arrays())


def in_a_child(method, call, *arguments):
    with multiprocessing.get_context(method).Pool(1) as pool:
        return pool.apply_async(call, arguments).get(SECONDS)


class Processes(unittest.TestCase):
    def test_forked_after_use_is_an_error(self):
        global made
        cloth = Grid(4)
        made = limiter(cloth.triangles, cloth.vertex_count)
        first = made.limit(*cloth.arrays())[0].tobytes()
        for call in ([limited, 1], [reuse], [apsl.devices]):
            with self.subTest(call[0].__name__):
                code, line = in_a_child("fork", what_it_says, *call)
                self.assertEqual(code, "unsupported")
                self.assertRegex(line, 'forked from one in which apsl had used OpenCL.*get_context\\("spawn"\\)')
        # What needs no OpenCL works there, and all of it here.
        self.assertEqual(in_a_child("fork", apsl.rest_areas, cloth.positions, cloth.triangles).tobytes(),
                         cloth.rest_areas.tobytes())
        self.assertEqual(made.limit(*cloth.arrays())[0].tobytes(), first)

    def test_a_forked_process_ends(self):
        # Not by multiprocessing: objects are destroyed at its end.
        script = ("import os, sys, apsl\n"
                  "from cloth import ONE_TRIANGLE, limiter\n"
                  "made = limiter(ONE_TRIANGLE, 3)\n"
                  "child = os.fork()\n"
                  "if child == 0:\n"
                  "    del made\n"
                  "    sys.exit(7)\n"
                  "sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n")
        ended = subprocess.run([sys.executable, "-c", script], timeout=SECONDS, cwd=os.path.dirname(__file__))
        self.assertEqual(ended.returncode, 7)

    def test_spawned_works(self):
        self.assertEqual(in_a_child("spawn", limited, 1), limited(1))

    def test_forked_before_any_use_works(self):
        script = ("import multiprocessing\n"
                  "from processes_test import in_a_child, limited\n"
                  "child = in_a_child('fork', limited, 1)\n"
                  "assert child == limited(1)\n")
        subprocess.run([sys.executable, "-c", script], timeout=SECONDS, cwd=os.path.dirname(__file__), check=True)


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
