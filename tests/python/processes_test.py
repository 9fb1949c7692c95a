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
                self.assertRegex(line, 'forked from one that had used OpenCL.*get_context\\("spawn"\\)')
        # What needs no OpenCL works there, and all of it here.
        self.assertEqual(in_a_child("fork", apsl.rest_areas, cloth.positions, cloth.triangles).tobytes(),
                         cloth.rest_areas.tobytes())
        self.assertEqual(made.limit(*cloth.arrays())[0].tobytes(), first)

    def test_a_forked_process_ends(self):
        # Not by multiprocessing: objects are destroyed at its end.
        in_a_context = ("import pyopencl\n"
                        "context = pyopencl.Context(pyopencl.get_platforms()[0].get_devices()[:1])\n"
                        "made = apsl.StrainLimiter(ONE_TRIANGLE, 3, context=context)\n")
        for making in ("made = limiter(ONE_TRIANGLE, 3)\n", in_a_context):
            script = ("import os, sys, apsl\n"
                      "from cloth import ONE_TRIANGLE, limiter\n" + making +
                      "child = os.fork()\n"
                      "if child == 0:\n"
                      "    del made\n"
                      "    sys.exit(7)\n"
                      "sys.exit(os.waitstatus_to_exitcode(os.waitpid(child, 0)[1]))\n")
            ended = subprocess.run([sys.executable, "-c", script], timeout=SECONDS, cwd=os.path.dirname(__file__))
            self.assertEqual(ended.returncode, 7, making)

    def run_script(self, script):
        # What pytools says on Debian 13 of a package that it can do without.
        quiet = dict(os.environ, PYTHONWARNINGS="ignore:Unable to import recommended hash")
        ended = subprocess.run([sys.executable, "-c", script], timeout=SECONDS, cwd=os.path.dirname(__file__),
                               capture_output=True, text=True, env=quiet)
        self.assertEqual((ended.returncode, ended.stderr), (0, ""))
        return ended.stdout

    def test_forked_with_a_context_of_the_caller_s_is_an_error(self):
        # Only pyopencl has used OpenCL in the first process; then a limiter of it goes along into a child, too.
        said = self.run_script(
            "import os, apsl\n"
            "from cloth import CORNER, ONE_TRIANGLE\n"
            "from processes_test import in_a_child, what_it_says\n"
            "import pyopencl, pyopencl.array\n"
            "context = pyopencl.Context(pyopencl.get_platforms()[0].get_devices()[:1])\n"
            "queue = pyopencl.CommandQueue(context)\n"
            "arrays = [pyopencl.array.zeros(queue, shape, 'float32') for shape in ((3, 3), (3, 3), 3, 1)]\n"
            "def make():\n"
            "    return apsl.StrainLimiter(ONE_TRIANGLE, 3, context=context)\n"
            "def enqueue():\n"
            "    return made.enqueue(queue, *arrays)\n"
            "def read_stats():\n"
            "    return made.read_stats(queue)\n"
            "def a_child_of_a_child():\n"
            "    child = os.fork()\n"
            "    if child == 0: os._exit(what_it_says(apsl.devices)[0] != 'unsupported')\n"
            "    assert os.waitpid(child, 0)[1] == 0\n"
            "    make()\n"
            "for call in (make, apsl.devices, a_child_of_a_child):\n"
            "    print(*in_a_child('fork', what_it_says, call))\n"
            "made = make()\n"
            "for call in (enqueue, read_stats):\n"
            "    print(*in_a_child('fork', what_it_says, call))\n"
            "enqueue().wait()\n")
        lines = said.splitlines()
        self.assertEqual(len(lines), 5, said)
        for line in lines:
            self.assertRegex(line, "^unsupported this process was forked from one that had used OpenCL")

    def test_spawned_works(self):
        self.assertEqual(in_a_child("spawn", limited, 1), limited(1))

    def test_forked_before_any_use_works(self):
        # pyopencl that is merely imported is no use of OpenCL.
        self.run_script("import pyopencl\n"
                        "from processes_test import in_a_child, limited\n"
                        "child = in_a_child('fork', limited, 1)\n"
                        "assert child == limited(1)\n")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
