# SPDX-License-Identifier: MIT
"""Maps of the stretch ceiling: how low it may be, on soft and stiff cloth, at long steps and under sudden load."""

from scene_map import SHAKE_SPEED, STIFFNESS, TIME_STEP, WITHOUT, Axis, Map

CEILING = "strain_limiting.stretch_ceiling"
CEILINGS = Axis("stretch ceiling", [1.01, 1.02, 1.05, 1.1, 1.2, 1.5, 2.0], None)
METHODS = WITHOUT + [{"name": "apsl_ceiling", "parameters": {}}]

MAPS = [Map(f"ceiling_{name}", f"Stretch ceiling and {title}", CEILINGS, axis, methods=METHODS, parameter=CEILING)
        for name, title, axis in (("stiffness", "stiffness", STIFFNESS), ("time_step", "time step", TIME_STEP),
                                  ("shake", "corner pins that fly off and stop", SHAKE_SPEED))]
