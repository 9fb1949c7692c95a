# SPDX-License-Identifier: MIT
"""Maps of cloth with slivers: triangles that are much lower than long, and the light vertices that a belt of them has."""

import meshes
from scene_map import BASE, SIDE, SOFT_TO_STIFF, WITHOUT_PRINTED, Axis, Map

HEIGHTS = [1 / 5, 1 / 10, 1 / 20, 1 / 50, 1 / 100, 1 / 200, 1 / 500, 1 / 1000]  # of a sliver, of its edge
LABEL = "height of a sliver over its edge"
# Rows of cells of the 16 that a belt lies in front of.
PLACES = {"at the pins": [0], "in the middle": [8], "at the hem": [16], "four belts": [0, 4, 8, 12]}
# Hung by the whole edge, as a garment is: what hangs below pulls evenly at the belt.
HUNG = {**BASE, "pins": [{"vertices": list(range(SIDE))}],
        "integrator": {"implicit_springs": {"stretch_stiffness": 200.0, "bend_stiffness": 0.01, "damping": 0.5}}}


def height_of_belt(places):
    return Axis(LABEL, HEIGHTS, lambda scene, height: scene.update(mesh={"obj": meshes.belts(height, places)}))


def set_place(scene, place):
    """Behind the height, which it keeps."""
    scene["mesh"] = {"obj": meshes.belts(scene.pop("height"), PLACES[place])}


def set_share(scene, share):
    """Behind the height, which it keeps."""
    scene["mesh"] = {"obj": meshes.split(share, scene.pop("height"))}


KEPT_HEIGHT = Axis(LABEL, HEIGHTS, lambda scene, height: scene.update(height=height))

MAPS = [
    Map("slivers_place", "Belts of slivers: their height and place", KEPT_HEIGHT,
        Axis("place", list(PLACES), set_place), base=HUNG, methods=WITHOUT_PRINTED),
    Map("slivers_share", "Slivers here and there: their height and share", KEPT_HEIGHT,
        Axis("share of triangles with a sliver", [0.01, 0.03, 0.1, 0.3, 1.0], set_share), methods=WITHOUT_PRINTED),
    Map("slivers_stiffness", "A belt of slivers at the pins: their height and stiffness",
        height_of_belt(PLACES["at the pins"]), SOFT_TO_STIFF, base=HUNG, methods=WITHOUT_PRINTED),
]
