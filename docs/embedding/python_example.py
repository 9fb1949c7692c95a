#!/usr/bin/env python3
# SPDX-License-Identifier: MIT
"""A sheet of cloth hung by its upper corners on soft springs, without the filter and with it, coloured by area change.

Usage: python_example.py FILE.png
"""
import sys

import matplotlib
import numpy as np

import apsl

matplotlib.use("Agg")
from matplotlib import pyplot  # noqa: E402

SIDE, TIME_STEP, STEPS = 21, 1 / 240, 120
DENSITY, STIFFNESS, DAMPING = 0.2, 4.0, 0.5  # kg/m², N/m, 1/s
RED = 0.5  # area change that is pure red


def make_cloth():
    """Vertices [V, 3] of a hanging sheet of 1 m by 1 m, its triangles [T, 3] and its edges [E, 2]."""
    x, y = np.meshgrid(np.linspace(-0.5, 0.5, SIDE), np.linspace(0, -1, SIDE))
    positions = np.stack([x.ravel(), y.ravel(), np.zeros(SIDE**2)], axis=1)
    corner = (np.arange(SIDE - 1)[:, None] * SIDE + np.arange(SIDE - 1)).ravel()
    right, below, across = corner + 1, corner + SIDE, corner + SIDE + 1
    one_way = np.stack([corner, below, right, right, below, across], axis=1)
    other_way = np.stack([corner, below, across, corner, across, right], axis=1)
    triangles = np.where((corner + corner // SIDE)[:, None] % 2 == 0, one_way, other_way).reshape(-1, 3)
    edges = np.unique(np.sort(triangles[:, [0, 1, 1, 2, 2, 0]].reshape(-1, 2), axis=1), axis=0)
    return positions, triangles, edges


def simulate(limiter):
    """Positions after STEPS steps of explicit springs, each followed by `limiter` where there is one."""
    rest, triangles, edges = make_cloth()
    rest_areas = apsl.rest_areas(rest, triangles)
    masses = np.bincount(triangles.ravel(), np.repeat(DENSITY * rest_areas / 3, 3))
    inverse_masses = 1 / masses
    inverse_masses[[0, 1, 2, SIDE - 3, SIDE - 2, SIDE - 1]] = 0  # the pins
    a, b = edges.T
    rest_lengths = np.linalg.norm(rest[b] - rest[a], axis=1)

    positions, velocities = rest.copy(), np.zeros_like(rest)
    for _ in range(STEPS):
        along = positions[b] - positions[a]
        lengths = np.linalg.norm(along, axis=1)
        pulls = (STIFFNESS * (1 - rest_lengths / lengths))[:, None] * along
        forces = np.zeros_like(rest)
        np.add.at(forces, a, pulls)
        np.add.at(forces, b, -pulls)
        accelerations = forces * inverse_masses[:, None] + np.where(inverse_masses[:, None] > 0, [0, -9.81, 0], 0)
        velocities = (velocities + TIME_STEP * accelerations) * (1 - DAMPING * TIME_STEP)
        if limiter:
            velocities, _ = limiter.limit(positions, velocities, inverse_masses, rest_areas, time_step=TIME_STEP)
        positions = positions + TIME_STEP * velocities
    return positions, triangles, apsl.area_change(positions, triangles, rest_areas)


def draw(axes, title, positions, triangles, change):
    axes.set_title(f"{title}: greatest area change {100 * change.max():.1f} %", fontsize=9)
    axes.set_aspect("equal")
    axes.set_axis_off()
    white_to_red = matplotlib.colors.LinearSegmentedColormap.from_list("white to red", ["white", "red"])
    axes.tripcolor(positions[:, 0], positions[:, 1], triangles, facecolors=change, cmap=white_to_red, vmin=0, vmax=RED,
                   edgecolors="gray", linewidth=0.2)


def main(picture):
    _, triangles, _ = make_cloth()
    results = [simulate(None), simulate(apsl.StrainLimiter(triangles, SIDE**2))]
    figure, axes = pyplot.subplots(1, 2, figsize=(8, 5), dpi=100, sharey=True)
    for half, title, result in zip(axes, ("without", "with the filter"), results):
        draw(half, title, *result)
    figure.tight_layout()
    figure.savefig(picture)
    without, with_filter = (100 * change.max() for *_, change in results)
    print(f"greatest area change: {without:.1f} % without, {with_filter:.1f} % with the filter; {picture}")


if __name__ == "__main__":
    if len(sys.argv) != 2:
        sys.exit("usage: python_example.py FILE.png")
    main(sys.argv[1])
