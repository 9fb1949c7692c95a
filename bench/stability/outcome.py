# SPDX-License-Identifier: MIT
"""What became of a run of `apsl compare`, beside the run without a limiter on the same scene."""

import math

SETTLING_FRAMES = 10    # that do not count: a cloth may start far from rest
INACCURATE = 0.10       # greatest area change
DIVERGED = 10.0         # greatest area change
BLOWN_UP = 10.0         # times the kinetic, spring and gravity energy that the unlimited cloth ends with
STRETCH_SLACK = 0.025   # over a stretch ceiling: as nearly as it is met while a cloth swings (docs/settings.md)
ROUNDING = 1e-3         # of area change: no more than this above the unlimited cloth's is not worse
ENERGY_SHARE = 0.10     # of the energy in the scene: corrections that stretch stiff springs load them by less
ENERGY_FLOOR = 1e-4     # J, what lifts the base cloth by 0.05 mm: less is no gain either
CHANCE = 2.0            # times what contact gives to the unlimited cloth: the motions are not the same ones

HELD, STRETCHED, INACCURATE_ALONE, WORSE, GAINED_ENERGY, DIVERGED_RUN, TIMED_OUT = "hsiwgdt"
MEANING = {
    HELD: "held: at most 10 %, and not above the cloth without a limiter",
    STRETCHED: "stretched: areas held, an edge longer than the stretch ceiling and 0.025",
    INACCURATE_ALONE: "inaccurate: above 10 %",
    WORSE: "inaccurate: above the cloth without a limiter",
    GAINED_ENERGY: "gained energy: rose above the start's, by more than contact gives to the cloth without a limiter",
    DIVERGED_RUN: "diverged: not finite, above 1000 %, or energy blown up",
    TIMED_OUT: "not finished in its time",
}


def greatest(run):
    """Greatest area change after the frames of settling, infinite where the run broke down."""
    if run["status"] == "diverged":
        return math.inf
    settled = run["frame_max_area_change"][SETTLING_FRAMES:]
    return max((math.inf if change is None else change for change in settled), default=0.0)


def longest_edge(run):
    """Greatest length over rest length after the frames of settling, infinite where the run broke down."""
    if run["status"] == "diverged":
        return math.inf
    settled = run["frame_max_edge_stretch"][SETTLING_FRAMES:]
    return max((math.inf if stretch is None else stretch for stretch in settled), default=1.0)


def size_of(energy):
    """J, how much there is of it, whatever its sign."""
    return sum(abs(energy[part]) for part in ("kinetic", "gravity", "springs"))


def blown_up(run, without):
    """Whether motion holds far more energy than there is in the scene."""
    if without["status"] == "diverged":
        return False
    kinetic = run["energy"]["kinetic"]
    return kinetic is None or kinetic > BLOWN_UP * size_of(without["energy"]) + 1e-6


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


def outcome(run, without, driven=False):
    """`driven`: something moves by itself, and may bring energy in."""
    if run["status"] == "timed_out":
        return TIMED_OUT
    change = greatest(run)
    if not change <= DIVERGED or blown_up(run, without):
        return DIVERGED_RUN
    if not driven and gained_energy(run, without):
        return GAINED_ENERGY
    if run is not without and change > greatest(without) + ROUNDING:
        return WORSE
    if change > INACCURATE:
        return INACCURATE_ALONE
    ceiling = run.get("parameters", {}).get("strain_limiting.stretch_ceiling")
    return STRETCHED if ceiling and longest_edge(run) > ceiling + STRETCH_SLACK else HELD
