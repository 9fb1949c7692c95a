# SPDX-License-Identifier: MIT
"""Maps and single cases of cloth that starts, or is suddenly put, far from rest."""

from scene_map import FRAME, SIDE, SOFT_TO_STIFF, WITHOUT_PRINTED, Axis, Map, changed

SCALES = [-1.0, -0.3, 0.0, 0.1, 0.3, 0.7, 1.0, 1.5, 2.0]
JUMP = 0.25  # s, when pins jump


def set_scale(axis):
    def change(scene, scale):
        scene.setdefault("start", {"scale": [1.0, 1.0, 1.0]})["scale"][axis] = scale

    return change


def jumping_pins(distance):
    """Both pins are elsewhere after one step of 1/60 s: to the side, and up."""
    way = distance / FRAME / 2.0**0.5
    return [{"vertices": [0, SIDE - 1],
             "motion": {"translate": {"velocity": [way, way, 0.0]}, "start": JUMP, "stop": JUMP + FRAME}}]


def cases():
    return [
        ("start: scaled to 0.3", changed(start={"scale": [0.3, 0.3, 0.3]})),
        ("start: random, 0.2 m", changed(start={"random": 0.2})),
        ("start: crumpled, scaled to 0.3 and random, 0.1 m", changed(start={"scale": [0.3, 0.3, 0.3], "random": 0.1})),
        ("start: folded back from the pins, scale −0.3", changed(start={"scale": [1.0, 1.0, -0.3]})),
        ("start: collapsed to a point, no pins", changed(pins=[], start={"scale": [0, 0, 0]})),
        ("start: rest areas of half the size", changed(start={"rest_areas": 0.5})),
        ("start: rest areas of twice the size", changed(start={"rest_areas": 2.0})),
        ("pins that jump by 0.5 m", changed(pins=jumping_pins(0.5))),
    ]


MAPS = [
    Map("start_scales", "A start that is scaled along two axes: 0 collapses, below 0 turns over",
        Axis("scale along x", SCALES, set_scale(0)), Axis("scale along z", SCALES, set_scale(2)),
        methods=WITHOUT_PRINTED),
    Map("start_noise", "A noisy start",
        Axis("noise (m)", [0.003, 0.01, 0.03, 0.1, 0.2, 0.5, 1.0],
             lambda scene, value: scene.update(start={"random": value})), SOFT_TO_STIFF, methods=WITHOUT_PRINTED),
    Map("start_rest_areas", "Rest areas that are suddenly others",
        Axis("rest area over the mesh's", [0.5, 0.7, 0.9, 1.1, 1.4, 2.0],
             lambda scene, value: scene.update(start={"rest_areas": value})), SOFT_TO_STIFF, methods=WITHOUT_PRINTED),
    Map("pins_jump", "Corner pins that jump",
        Axis("distance (m)", [0.01, 0.03, 0.1, 0.3, 0.5, 1.0],
             lambda scene, value: scene.update(pins=jumping_pins(value))), SOFT_TO_STIFF, methods=WITHOUT_PRINTED),
]
