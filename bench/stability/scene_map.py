# SPDX-License-Identifier: MIT
"""A map of two axes of the atlas of failure: each point is a scene as `apsl run` takes it, and what is run on it."""

import copy
from dataclasses import dataclass, field
from typing import Callable

import meshes

SIDE = meshes.CELLS + 1  # vertices of the base cloth along each side
SECONDS = 1.0            # simulated at every point
FRAME = 1.0 / 60.0       # s, of a frame, where the time step is not longer

BASE = {
    "mesh": {"grid": {"vertices": [SIDE, SIDE], "size": [1.0, 1.0], "diagonals": "alternating"}},
    "density": 0.2,
    "pins": [{"vertices": [0, SIDE - 1]}],
    "integrator": {"implicit_springs": {"stretch_stiffness": 20.0, "bend_stiffness": 0.01, "damping": 0.5}},
}

# The paper's: consistent matrix, α = 1.2, 10 sub-steps, tolerance 0.1. The printed matrix needs α ≥ 2 when iterated.
PAPER = {"strain_limiting.sub_steps": 10, "strain_limiting.regularization": 1.2, "strain_limiting.tolerance": 0.1,
         "strain_limiting.max_iterations": 50, "strain_limiting.target_area_change": 0,
         "strain_limiting.first_regularization": 0, "strain_limiting.warm_start_sub_steps": 0}
PRINTED = {**PAPER, "strain_limiting.regularization": 2}
OURS = [{"name": "apsl_defaults", "parameters": {}}, {"name": "apsl", "parameters": PAPER},
        {"name": "apsl_printed", "parameters": PRINTED}]
# With the standard settings of bench/methods, most of them 20 iterations: what takes about as long as ours.
BASELINES = [{"name": name, "parameters": {}} for name in (
    "pbd_area_gauss_seidel", "pbd_area_jacobi", "xpbd_area", "strain_based_dynamics_area", "ring_area",
    "hierarchical_constraints", "hierarchical_pbd", "edge_limits_gauss_seidel", "pbd_edges",
    "strain_based_dynamics_strain", "continuum_strain_limiting")]
# As slow as twenty of the others, or nearly the same as one of them: in the single cases alone.
MORE_BASELINES = [{"name": name, "parameters": {}} for name in (
    "pbd_area_colored", "edge_limits_jacobi", "xpbd_edges", "fast_projection", "nonconforming_edge_midpoint")]
WITHOUT = [{"name": "none", "parameters": {}}]
# The matrix as printed has its verdict from the other maps.
WITHOUT_PRINTED = WITHOUT + OURS[:2] + BASELINES


@dataclass
class Axis:
    label: str
    values: list
    change: Callable  # (scene, value): changes the scene


@dataclass
class Map:
    name: str
    title: str
    x: Axis
    y: Axis
    base: dict = field(default_factory=lambda: BASE)
    methods: list = field(default_factory=lambda: WITHOUT + OURS + BASELINES)
    parameter: str = ""  # the x axis is ours alone, this parameter: no scene says it

    def scene(self, x, y):
        scene = with_time_step(copy.deepcopy(self.base), FRAME)
        if not self.parameter:
            self.x.change(scene, x)
        self.y.change(scene, y)
        return scene


def with_time_step(scene, time_step, seconds=SECONDS):
    """As many steps a frame as make it last 1/60 s, and as many frames as make `seconds`."""
    scene["time_step"] = time_step
    scene["steps_per_frame"] = max(1, round(FRAME / time_step))
    scene["frames"] = round(seconds / (time_step * scene["steps_per_frame"]))
    return scene


def set_stiffness(scene, value):
    scene["integrator"]["implicit_springs"]["stretch_stiffness"] = value


def changed(**changes):
    return with_time_step({**copy.deepcopy(BASE), **changes}, FRAME)


def text(value):
    """A value of an axis as it names a point: places have names, all else is a number."""
    return value if isinstance(value, str) else f"{value:g}"


def point_name(x, y):
    return f"{text(x)} {text(y)}"


def driven(scene):
    """Whether something moves by itself or begins loaded: then more energy than at the start is no fault."""
    return any("motion" in pin for pin in scene.get("pins", [])) or "rest_areas" in scene.get("start", {})


def set_shake(scene, speed):
    """The two corners fly off together and stop after half of the time."""
    scene["pins"] = [{"vertices": [0, SIDE - 1], "motion": {"translate": {"velocity": [0, 0, speed]}, "stop": 0.5}}]


SHAKE_SPEED = Axis("speed (m/s)", [0.1, 0.3, 1.0, 3.0, 10.0, 30.0, 100.0], set_shake)
TIME_STEP = Axis("time step (s)", [1 / 1000, 1 / 500, 1 / 240, 1 / 120, 1 / 60, 1 / 30, 1 / 20, 1 / 15], with_time_step)
STIFFNESS = Axis("spring stiffness (N/m)", [0.2, 0.6, 2.0, 6.0, 20.0, 60.0, 200.0, 600.0, 2000.0, 6000.0, 20000.0],
                 set_stiffness)
SOFT_TO_STIFF = Axis(STIFFNESS.label, [2.0, 6.0, 20.0, 60.0, 200.0, 600.0, 2000.0], set_stiffness)
