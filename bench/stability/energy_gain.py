# SPDX-License-Identifier: MIT
"""Whether a limiter added energy to a scene, from runs with and without it."""

ENERGY_SHARE = 0.10     # of the energy in the scene: corrections that stretch stiff springs load them by less
ENERGY_FLOOR = 1e-4     # J, what lifts a cloth of 0.2 kg by 0.05 mm: less is no gain either
CHANCE = 2.0            # times what contact gives to the unlimited cloth: the motions are not the same ones



def driven(scene):
    """Whether something moves by itself or begins loaded: then more energy than at the start is no fault."""
    return any("motion" in pin for pin in scene.get("pins", [])) or "rest_areas" in scene.get("start", {})


def size_of(energy):
    """J, how much there is of it, whatever its sign."""
    return sum(abs(energy[part]) for part in ("kinetic", "gravity", "springs"))


def gained_energy(run, without):
    """Whether a limiter added energy. Springs alone lose some in every step. Contact adds some where the cloth starts
    inside a body, and where it pushes stiff springs: to the cloth without a limiter too, and that much is no fault."""
    if without["status"] == "diverged" or without["greatest_energy"] is None:
        return False
    if run["greatest_energy"] is None:
        return True
    start = without["start_energy"]
    contact = max(without["greatest_energy"] - start["total"], 0.0)
    allowed = ENERGY_SHARE * (size_of(start) + size_of(without["energy"])) + ENERGY_FLOOR
    return run["greatest_energy"] - start["total"] > CHANCE * contact + allowed
