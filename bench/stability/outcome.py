# SPDX-License-Identifier: MIT
"""What became of a run of `apsl compare`, beside the run without a limiter on the same scene."""

import math

SETTLING_FRAMES = 10    # that do not count: a cloth may start far from rest
INACCURATE = 0.10       # greatest area change
DIVERGED = 10.0         # greatest area change
BLOWN_UP = 10.0         # times the kinetic, spring and gravity energy that the unlimited cloth ends with
ROUNDING = 1e-3         # of area change: no more than this above the unlimited cloth's is not worse

HELD, INACCURATE_ALONE, WORSE, DIVERGED_RUN, TIMED_OUT = "hiwdt"
MEANING = {
    HELD: "held: at most 10 %, and not above the cloth without a limiter",
    INACCURATE_ALONE: "inaccurate: above 10 %",
    WORSE: "inaccurate: above the cloth without a limiter",
    DIVERGED_RUN: "diverged: not finite, above 1000 %, or energy blown up",
    TIMED_OUT: "not finished in its time",
}


def greatest(run):
    """Greatest area change after the frames of settling, infinite where the run broke down."""
    if run["status"] == "diverged":
        return math.inf
    settled = run["frame_max_area_change"][SETTLING_FRAMES:]
    return max((math.inf if change is None else change for change in settled), default=0.0)


def blown_up(run, without):
    """Whether motion holds far more energy than there is in the scene."""
    if without["status"] == "diverged":
        return False
    scene = sum(abs(without["energy"][kind]) for kind in ("kinetic", "gravity", "springs"))
    kinetic = run["energy"]["kinetic"]
    return kinetic is None or kinetic > BLOWN_UP * scene + 1e-6


def outcome(run, without):
    if run["status"] == "timed_out":
        return TIMED_OUT
    change = greatest(run)
    if not change <= DIVERGED or blown_up(run, without):
        return DIVERGED_RUN
    if run is not without and change > greatest(without) + ROUNDING:
        return WORSE
    return INACCURATE_ALONE if change > INACCURATE else HELD
