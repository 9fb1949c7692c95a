# SPDX-License-Identifier: MIT
"""Whether every kernel was executed, with every setting that host/ may build it with for a GPU."""
import variants

# Of these host/ passes what the meshes and the caller's layout have: only whether there is more than one counts.
_SIZES = {"APSLK_PATCH_VERTICES", "APSLK_WARM_START_SUB_STEPS", "APSLK_POSITION_COMPONENT_STRIDE",
          "APSLK_VELOCITY_COMPONENT_STRIDE"}


# Settings that a file reads and the gate compiles, with which host/ never builds it.
_NOT_BUILT = {("chebyshev_step.cl", ("APSLK_REGULARIZATION_PER_TRIANGLE", 1)),
              ("start_small_steps.cl", ("APSLK_POSITIONS_ONLY", 1)),
              ("warm_start.cl", ("APSLK_WARM_START_SUB_STEPS", 0))}


def _setting(name, value):
    return (name, min(value, 2)) if name in _SIZES else (name, value)


def _settings(defines):
    return frozenset(_setting(name, value) for name, value in defines)


def enough(launches):
    """Of pairs of a launch and the defines that its file reads, some that between them have every kernel with every
    setting that any of them has; of as few files and defines as is easily found, since each is a compilation."""
    offered = {}
    for launch, defines in launches:
        settings = {(launch.source, launch.kernel, setting) for setting in _settings(defines)}
        settings.add((launch.source, launch.kernel))
        offered.setdefault((launch.kernel, launch.source, defines), (launch, settings))
    missing_yet, chosen, compiled = set().union(*(has for _, has in offered.values())), [], set()
    while missing_yet:
        # What is compiled already comes first, then what has most that is missing.
        kernel, source, defines = max(offered, key=lambda key: (
            (key[1:] in compiled) and not missing_yet.isdisjoint(offered[key][1]), len(offered[key][1] & missing_yet)))
        launch, has = offered.pop((kernel, source, defines))
        chosen.append(launch)
        compiled.add((source, defines))
        missing_yet -= has
    return chosen


def missing(kernels, executed):
    """Lines on what was not executed. `executed`: pairs of a recorded launch and the defines that its file reads."""
    lines = []
    launched = {(launch.source, launch.kernel) for launch, _ in executed}
    for source, kernel in variants.kernels_named_in(kernels):
        if (source, kernel) not in launched:
            lines.append(f"{source}:{kernel}: no launch was executed, expected a scenario of "
                         "tests/amd/replay/scenarios.cpp with one")
    seen = {(launch.source, setting) for launch, defines in executed for setting in _settings(defines)}
    wanted = {(variant.source.name, setting) for variant in variants.variants(kernels)
              for setting in _settings(variant.defines)}
    lines += [f"{source}: no launch was executed with {name}={'more' if name in _SIZES and value == 2 else value}"
              for source, (name, value) in sorted(wanted - seen - _NOT_BUILT)]
    return lines


def summary(kernels, executed):
    """How many of the combinations of settings were executed."""
    done = {(launch.source, _settings(defines)) for launch, defines in executed}
    wanted = {(variant.source.name, _settings(variant.defines)) for variant in variants.variants(kernels)}
    return f"{len(wanted & done)} of {len(wanted)} combinations of settings executed"
