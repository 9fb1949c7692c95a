# SPDX-License-Identifier: MIT
"""Threads: each result as if alone, and other threads run while a call computes."""

import sys
import threading
import time
import unittest
from concurrent.futures import ThreadPoolExecutor

from cloth import Grid, limiter


def limited_bytes(made, cloth):
    return [made.limit(*cloth.arrays(), sub_steps=sub_steps)[0].tobytes() for sub_steps in (1, 5, 10)]


class Threads(unittest.TestCase):
    def setUp(self):
        self.cloths = [Grid(20, seed) for seed in range(4)]
        self.expected = [limited_bytes(limiter(c.triangles, c.vertex_count), c) for c in self.cloths]

    def test_a_limiter_for_each_thread(self):
        with ThreadPoolExecutor(4) as pool:
            results = list(pool.map(lambda c: limited_bytes(limiter(c.triangles, c.vertex_count), c), self.cloths))
        self.assertEqual(results, self.expected)

    def test_one_limiter_shared(self):
        shared = limiter(self.cloths[0].triangles, self.cloths[0].vertex_count)
        with ThreadPoolExecutor(4) as pool:
            results = list(pool.map(lambda c: limited_bytes(shared, c), self.cloths * 5))
        self.assertEqual(results, self.expected * 5)

    def test_others_run_while_a_call_computes(self):
        cloth = Grid(150)
        made = limiter(cloth.triangles, cloth.vertex_count)
        settings = {"tolerance": 1e-6, "max_iterations": 40, "sub_steps": 10}
        made.limit(*cloth.arrays(), **settings)
        ticks, stop = [], threading.Event()

        def tick():
            while not stop.wait(0.001):
                ticks.append(time.monotonic())

        ticker = threading.Thread(target=tick)
        ticker.start()
        try:
            begin = time.monotonic()
            made.limit(*cloth.arrays(), **settings)
            end = time.monotonic()
        finally:
            stop.set()
            ticker.join()
        # Copies at either end hold the interpreter, but only for a hundredth of the call.
        inside = [t for t in ticks if begin + 0.2 * (end - begin) < t < end - 0.2 * (end - begin)]
        self.assertTrue(inside, f"no other thread ran in the middle of a call of {end - begin:.3f} s")


if __name__ == "__main__":
    unittest.main(argv=sys.argv[:1])
