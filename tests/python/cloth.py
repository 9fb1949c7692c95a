# SPDX-License-Identifier: MIT
"""Meshes and devices for the tests."""

import os

import numpy as np

import apsl

TIME_STEP = np.float32(1 / 64)  # exact in binary, so that hand values are
ONE_TRIANGLE = np.array([[0, 1, 2]])
CORNER = np.array([[0, 0, 0], [1, 0, 0], [0, 1, 0]], np.float32)  # right angle at vertex 0, area 1/2


def device():
    """The device that APSL_TEST_PLATFORM and APSL_TEST_DEVICE name, as for the C++ tests. None at all is a failure."""
    platform = os.environ.get("APSL_TEST_PLATFORM", "")
    found = [entry for entry in apsl.devices() if platform in entry.platform]
    return found[int(os.environ.get("APSL_TEST_DEVICE", "0"))]


def limiter(triangles, vertex_count, **options):
    return apsl.StrainLimiter(triangles, vertex_count, device(), **options)


class Grid:
    """n × n vertices on the unit square, random velocities, two corners pinned."""

    def __init__(self, n, seed=1, speed=2.0):
        x, y = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n))
        self.positions = np.stack([x.ravel(), y.ravel(), 0.05 * np.sin(7 * x.ravel())], axis=1).astype(np.float32)
        corner = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
        self.triangles = np.concatenate([np.stack([corner, corner + 1, corner + n], axis=1),
                                         np.stack([corner + 1, corner + n + 1, corner + n], axis=1)])
        self.vertex_count = n * n
        self.rest_areas = apsl.rest_areas(self.positions, self.triangles)
        self.velocities = np.random.default_rng(seed).normal(0, speed, self.positions.shape).astype(np.float32)
        self.inverse_masses = np.full(self.vertex_count, self.vertex_count / 0.2, np.float32)
        self.pins = [0, n - 1]
        self.inverse_masses[self.pins] = 0

    def arrays(self):
        return self.positions, self.velocities, self.inverse_masses, self.rest_areas
