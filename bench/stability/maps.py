# SPDX-License-Identifier: MIT
"""What the atlas of failure runs: all its maps, and single cases."""

import copy

import ceilings
import contact
import meshes
import slivers
import starts
from scene_map import (BASE, FRAME, MORE_BASELINES, OURS, PAPER, BASELINES, SECONDS, SHAKE_SPEED, SIDE, STIFFNESS, TIME_STEP,
                       WITHOUT, Axis, Map, changed, driven, point_name, set_stiffness, text, with_time_step)

# scenes/skirt.json, coarser: where long columns of cloth hang from a pinned waist.
SKIRT = {
    "mesh": {"tube": {"radius": [0.14, 0.38], "height": 0.55, "segments": [48, 24], "diagonals": "random",
                      "jitter": 0.6}},
    "density": 0.2,
    "pins": [{"box": {"min": [-1.0, 0.27, -1.0]}}],
    "integrator": {"implicit_springs": {"stretch_stiffness": 5.0, "bend_stiffness": 0.01, "damping": 0.5}},
}


def set_neighbours(scene, ratio):
    scene["masses"] = [{"vertices": list(range(1, SIDE * SIDE, 2)), "factor": ratio}]


def set_one_heavy(scene, ratio):
    scene["masses"] = [{"vertices": [SIDE * SIDE // 2], "factor": ratio}]


def set_half(scene, ratio):
    scene["masses"] = [{"box": {"min": [-1.0, -1.0, 0.01]}, "factor": ratio}]


def set_needles(scene, aspect):
    scene["mesh"] = {"obj": meshes.needles(aspect)}


def set_vertices(scene, count):
    scene["mesh"]["grid"]["vertices"] = [count, count]
    scene["pins"] = [{"vertices": [0, count - 1]}]


def set_pull(scene, speed):
    """Two opposite edges, pinned whole, part: strain grows without limit."""
    scene["pins"] = [{"box": {"max": [-0.49, 1.0, 1.0]}, "motion": {"translate": {"velocity": [-speed, 0, 0]}}},
                     {"box": {"min": [0.49, -1.0, -1.0]}, "motion": {"translate": {"velocity": [speed, 0, 0]}}}]


def set_twist(scene, turns):
    """One edge turns about the cloth's middle line, the opposite one stands."""
    scene["pins"] = [{"box": {"max": [-0.49, 1.0, 1.0]}},
                     {"box": {"min": [0.49, -1.0, -1.0]},
                      "motion": {"rotate": {"axis": [1, 0, 0], "degrees_per_second": 360.0 * turns}}}]


RATIOS = [1.0, 10.0, 100.0, 1000.0, 10000.0, 100000.0]

MAPS = [
    Map("time_step_stiffness", "Time step and stiffness", TIME_STEP, STIFFNESS),
    Map("alpha_stiffness", "α and stiffness",
        Axis("regularization α", [1.0, 1.001, 1.01, 1.05, 1.2, 1.5, 2.0, 3.0, 5.0, 10.0], None), STIFFNESS,
        parameter="strain_limiting.regularization",
        methods=WITHOUT + [{"name": "apsl", "parameters": PAPER}, {"name": "apsl_printed", "parameters": PAPER}]),
    Map("mass_neighbours", "Every second vertex heavier", TIME_STEP, Axis("mass ratio", RATIOS, set_neighbours)),
    Map("mass_one", "One heavy vertex in the middle", TIME_STEP, Axis("mass ratio", RATIOS, set_one_heavy)),
    Map("mass_halves", "One half heavier: the one away from the pins", TIME_STEP, Axis("mass ratio", RATIOS, set_half)),
    Map("weight_stiffness", "Weight and stiffness",
        Axis("density (kg/m²)", [0.01, 0.02, 0.05, 0.1, 0.2, 0.5, 1.0, 2.0],
             lambda scene, value: scene.update(density=value)), STIFFNESS),
    Map("needles", "Needles in every second column", TIME_STEP,
        Axis("aspect", [1.0, 3.0, 10.0, 30.0, 100.0, 300.0, 1000.0, 10000.0], set_needles)),
    Map("skirt", "A skirt: time step and stiffness",
        Axis("time step (s)", [1 / 480, 1 / 240, 1 / 120, 1 / 60, 1 / 30, 1 / 15], with_time_step),
        Axis(STIFFNESS.label, [0.5, 1.0, 2.0, 5.0, 10.0, 20.0, 50.0, 200.0], set_stiffness), base=SKIRT),
    Map("refinement_stiffness", "Refinement and stiffness",
        Axis("vertices along a side", [3, 5, 9, 17, 25, 33, 49, 65], set_vertices), STIFFNESS),
    Map("pull_stiffness", "Opposite edges pulled apart",
        Axis("speed of each (m/s)", [0.01, 0.03, 0.1, 0.3, 1.0, 3.0, 10.0], set_pull), STIFFNESS),
    Map("shake_stiffness", "Corner pins that fly off and stop",
        SHAKE_SPEED, STIFFNESS),
    Map("twist_stiffness", "One edge turning against the other",
        Axis("turns a second", [0.1, 0.25, 0.5, 1.0, 2.0, 5.0, 10.0], set_twist), STIFFNESS),
    *ceilings.MAPS, *contact.MAPS, *slivers.MAPS, *starts.MAPS,
]


def all_pinned():
    """The first three rows held whole: their triangles have no free corner."""
    return changed(pins=[{"box": {"max": [1.0, 1.0, -0.37]}}])


def folding(degrees):
    """One edge is carried over the cloth in a second, onto the other where it is 180 degrees."""
    return changed(pins=[{"box": {"max": [-0.49, 1.0, 1.0]}},
                         {"box": {"min": [0.49, -1.0, -1.0]},
                          "motion": {"rotate": {"axis": [0, 0, 1], "degrees_per_second": degrees, "center": [0, 0, 0]},
                                     "stop": 1.0}}])


def from_mesh(mesh, **changes):
    return changed(mesh={"obj": mesh}, **changes)


def light_and_long():
    scene = with_time_step(copy.deepcopy(BASE), 1 / 15)
    scene["density"] = 0.01
    return scene


def cases():
    """Single cases: name, scene."""
    distances = [(f"{d // 1000} km from the origin", from_mesh(meshes.far_away(float(d)))) for d in (1000, 10000)]
    return [
        ("base", changed()),
        ("no pins", changed(pins=[])),
        ("two pins pulled apart, 1 m/s", changed(pins=[
            {"vertices": [0], "motion": {"translate": {"velocity": [-1, 0, 0]}}},
            {"vertices": [SIDE - 1], "motion": {"translate": {"velocity": [1, 0, 0]}}}])),
        ("triangles all pinned", all_pinned()),
        ("triangles all pinned, sheared by pins", changed(pins=[
            {"box": {"max": [1.0, 1.0, -0.43]}},
            {"box": {"min": [-1.0, -1.0, -0.44], "max": [1.0, 1.0, -0.37]},
             "motion": {"translate": {"velocity": [0.1, 0, 0]}}}])),
        ("every vertex pinned", changed(pins=[{"box": {}}])),
        ("fold by 90°", folding(90)), ("fold by 180°", folding(180)), ("flip by 360°", folding(360)),
        ("flip by 3600°", folding(3600)),
        ("start: collapsed to a line", changed(start={"scale": [1, 0, 0]})),
        ("start: collapsed to a point", changed(start={"scale": [0, 0, 0]})),
        ("start: turned inside out", changed(start={"scale": [1, 1, -1]})),
        ("start: twice as large", changed(start={"scale": [2, 2, 2]})),
        ("start: random, 1 cm", changed(start={"random": 0.01})),
        ("start: random, 10 cm", changed(start={"random": 0.1})),
        ("start: random, 1 m", changed(start={"random": 1.0})),
        *distances,
        ("needles of aspect 10⁶", from_mesh(meshes.needles(1e6))),
        ("1000 patches, each hung by a corner", from_mesh(meshes.components(1000),
                                                          pins=[{"vertices": [9 * k for k in range(1000)]}])),
        ("fins: four triangles at an edge", from_mesh(meshes.fins())),
        ("0.01 kg/m² at 1/15 s", light_and_long()),
        ("gravity × 100", changed(gravity=[0, -981.0, 0])),
        ("no springs at all", changed(integrator={"none": {}})),
        *starts.cases(), *contact.cases(),
    ]


CASE_METHODS = WITHOUT + OURS + BASELINES + MORE_BASELINES

CASES = "cases"  # the name under which they are stored together
NAMES = [entry.name for entry in MAPS] + [CASES]
