# SPDX-License-Identifier: MIT
"""Maps and single cases of cloth that touches something: balls, a capsule, a floor."""

import meshes
from scene_map import BASE, SIDE, SOFT_TO_STIFF, WITHOUT_PRINTED, Axis, Map, changed, with_time_step

SHEET = {**BASE, "pins": []}  # falls freely


def ball(radius, top, x=0.0, z=0.0, friction=0.3):
    return {"sphere": {"center": [x, top - radius, z], "radius": radius, "friction": friction}}


def capsule(radius, top, friction=0.3):
    """Along x, longer than half of the sheet."""
    return {"capsule": {"a": [-0.3, top - radius, 0.0], "b": [0.3, top - radius, 0.0], "radius": radius,
                        "friction": friction}}


def floor(height, friction=0.3):
    return {"plane": {"point": [0.0, height, 0.0], "normal": [0.0, 1.0, 0.0], "friction": friction}}


def set_friction(scene, friction):
    scene["colliders"] = [ball(0.3, 0.0, friction=friction)]


def set_drop(scene, height):
    """The bodies stand lower: all that counts is the speed that the sheet arrives with."""
    scene["colliders"] = [ball(0.2, -height, x=-0.25), ball(0.2, -height, x=0.25), floor(-height - 0.4)]


def set_ball_in_the_way(scene, radius):
    """In front of where the curtain would come to hang, below its two pins."""
    scene["colliders"] = [ball(radius, -0.6 + radius, z=-0.5)]


def set_depth(scene, depth):
    scene["colliders"] = [ball(0.3, depth)]


def over_a_ball(speed, way=0.2):
    """Two opposite edges, pinned whole, are pulled down over a ball."""
    motion = {"translate": {"velocity": [0.0, -speed, 0.0]}, "stop": way / speed}
    return changed(pins=[{"box": {"max": [-0.49, 1.0, 1.0]}, "motion": motion},
                         {"box": {"min": [0.49, -1.0, -1.0]}, "motion": motion}], colliders=[ball(0.3, 0.0)])


def hung_over_a_capsule():
    """The two edges along the capsule are held lower than its top, so that the sheet starts inside it and is pressed."""
    return changed(pins=[{"box": {"max": [1.0, 1.0, -0.49]}}, {"box": {"min": [-1.0, -1.0, 0.49]}}],
                   colliders=[capsule(0.15, 0.05)])


def sleeve():
    """A tube that narrows upwards slides down a standing capsule until it fits."""
    return changed(mesh={"tube": {"radius": [0.15, 0.3], "height": 0.6, "segments": [24, 12],
                                  "diagonals": "alternating"}}, pins=[],
                   colliders=[{"capsule": {"a": [0.0, -1.5, 0.0], "b": [0.0, 0.05, 0.0], "radius": 0.2,
                                           "friction": 0.3}}])


def heavy_middle():
    return changed(pins=[], masses=[{"vertices": [SIDE * SIDE // 2], "factor": 100.0}], colliders=[ball(0.3, 0.0)])


def with_bodies(*bodies, **changes):
    return changed(**{"pins": [], **changes}, colliders=list(bodies))


def cases():
    wedge = [{"plane": {"point": [0.0, -0.3, 0.0], "normal": [side, 1.0, 0.0], "friction": 0.3}} for side in (-1, 1)]
    return [
        ("contact: at rest on the floor", with_bodies(floor(0.0))),
        ("contact: dropped flat on the floor", with_bodies(floor(-0.5))),
        ("contact: into a wedge of two planes", with_bodies(*wedge)),
        ("contact: over a ball as large as an edge", with_bodies(ball(1.0 / meshes.CELLS, 0.0))),
        ("contact: pulled down over a ball, 1 m/s", over_a_ball(1.0)),
        ("contact: pressed on a capsule by its pins", hung_over_a_capsule()),
        ("contact: weighed down on a ball, 5 kg/m²", with_bodies(ball(0.3, 0.0), density=5.0)),
        ("contact: heavy vertex on a ball", heavy_middle()),
        ("contact: sleeve on a capsule", sleeve()),
        ("contact: starts half inside a ball", with_bodies(ball(0.3, 0.3))),
        ("contact: starts under the floor", with_bodies(floor(0.05))),
    ]


DRAPED = {**SHEET, "colliders": [capsule(0.15, 0.0), floor(-0.4)]}

MAPS = [
    Map("contact_friction", "A sheet on a ball: friction and stiffness",
        Axis("friction", [0.0, 0.1, 0.2, 0.4, 0.7, 1.0], set_friction), SOFT_TO_STIFF, base=SHEET, methods=WITHOUT_PRINTED),
    Map("contact_time_step", "A sheet over a capsule and a floor: time step and stiffness",
        Axis("time step (s)", [1 / 480, 1 / 240, 1 / 120, 1 / 60, 1 / 30, 1 / 15], with_time_step), SOFT_TO_STIFF,
        base=DRAPED, methods=WITHOUT_PRINTED),
    Map("contact_drop", "A sheet dropped on two balls and a floor",
        Axis("height (m)", [0.0, 0.03, 0.1, 0.3, 1.0, 3.0], set_drop), SOFT_TO_STIFF, base=SHEET, methods=WITHOUT_PRINTED),
    Map("contact_swing", "A curtain that swings onto a ball",
        Axis("radius of the ball (m)", [0.05, 0.1, 0.15, 0.2, 0.3, 0.4], set_ball_in_the_way), SOFT_TO_STIFF,
        methods=WITHOUT_PRINTED),
    Map("contact_inside", "A sheet that starts inside a ball",
        Axis("depth (m)", [0.001, 0.003, 0.01, 0.03, 0.1, 0.2], set_depth), SOFT_TO_STIFF, base=SHEET,
        methods=WITHOUT_PRINTED),
]
