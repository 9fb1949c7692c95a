# SPDX-License-Identifier: MIT
"""What is compiled: every kernels/*.cl, with the combinations of the defines it reads, for every target.

This is the one place to edit when a kernel file gains a define or a GPU is to be added. Files and the defines each of
them reads are found in the sources, so a new kernel file needs no entry, and a new define without one is an error.
"""
import hashlib
import itertools
import re
from dataclasses import dataclass
from pathlib import Path

# The defines that host/ may pass. A file is compiled with every combination of one setting from each axis; defines that
# stand in one setting vary together. 256 is AMD's default limit of a work-group.
AXES = [
    [{"APSLK_WORK_GROUP_SIZE": 64}, {"APSLK_WORK_GROUP_SIZE": 256}],
    [{"APSLK_MATRIX": 0}, {"APSLK_MATRIX": 1}],
    # xyz, xyzw with the inverse mass in the positions' w, a structure of arrays, xyzw positions alone.
    [{"APSLK_POSITION_STRIDE": stride, "APSLK_VELOCITY_STRIDE": stride, "APSLK_POSITION_COMPONENT_STRIDE": component,
      "APSLK_VELOCITY_COMPONENT_STRIDE": component, "APSLK_INVERSE_MASS_STRIDE": mass, "APSLK_POSITIONS_ONLY": positions}
     for stride, component, mass, positions in [(3, 1, 1, 0), (4, 1, 4, 0), (1, 65536, 1, 0), (4, 1, 4, 1)]],
    # A Chebyshev solve takes one α for all, a stretch ceiling a Chebyshev solve, and bending a stretch ceiling.
    [{"APSLK_REGULARIZATION_PER_TRIANGLE": alpha, "APSLK_CHEBYSHEV": chebyshev, "APSLK_LIMITS_STRETCH": stretch,
      "APSLK_BENDS": bends}
     for alpha, chebyshev, stretch, bends in [(0, 0, 0, 0), (1, 0, 0, 0), (0, 1, 0, 0), (0, 1, 1, 0), (0, 1, 1, 1)]],
    [{"APSLK_STRETCH_CEILING_PER_TRIANGLE": 0}, {"APSLK_STRETCH_CEILING_PER_TRIANGLE": 1}],
    # An acceleration for each vertex is of whole steps.
    [{"APSLK_INTEGRATES": 0, "APSLK_ACCELERATION_PER_VERTEX": 0}, {"APSLK_INTEGRATES": 1, "APSLK_ACCELERATION_PER_VERTEX": 0},
     {"APSLK_INTEGRATES": 1, "APSLK_ACCELERATION_PER_VERTEX": 1}],
    [{"APSLK_KEEPS_CONTACTS": 0}, {"APSLK_KEEPS_CONTACTS": 1}],
    # Tethers are of whole steps too; two a vertex read as many do.
    [{"APSLK_TETHERS": 0}, {"APSLK_TETHERS": 2}],
    [{"APSLK_WARM_START_SUB_STEPS": 0}, {"APSLK_WARM_START_SUB_STEPS": 8}],
    # What the patches of 512 triangles of most meshes have; host/ passes the number of the meshes at hand.
    [{"APSLK_PATCH_VERTICES": 400}],
]

# What contacts add reads no layout of the caller's arrays: one is enough.
_CONTACTS_APART = ({"APSLK_KEEPS_CONTACTS": 1, "APSLK_POSITION_STRIDE": 1},
                   {"APSLK_KEEPS_CONTACTS": 1, "APSLK_POSITION_STRIDE": 4})
# The same of accelerations, which predict_positions alone reads as the caller has them.
_ACCELERATIONS_APART = ({"APSLK_ACCELERATION_PER_VERTEX": 1, "APSLK_POSITION_STRIDE": 1},
                        {"APSLK_ACCELERATION_PER_VERTEX": 1, "APSLK_POSITION_STRIDE": 4})

# Anchors are read as the caller has them, in every layout, but by no other option's code.
_TETHERS_APART = ({"APSLK_TETHERS": 2, "APSLK_INTEGRATES": 0}, {"APSLK_TETHERS": 2, "APSLK_ACCELERATION_PER_VERTEX": 1},
                  {"APSLK_TETHERS": 2, "APSLK_CHEBYSHEV": 1, "APSLK_LIMITS_STRETCH": 0})

# What has neither bending nor tethers in it, though it includes what has.
_WITHOUT_FORCES = ({"APSLK_BENDS": 1}, {"APSLK_TETHERS": 2})

# Combinations that host/ never builds for a GPU (host/limiter_options.cpp), or that make no other code.
NOT_FOR_GPUS = {"filter_in_one_group.cl": ({"APSLK_WARM_START_SUB_STEPS": 8}, {"APSLK_REGULARIZATION_PER_TRIANGLE": 1},
                                           {"APSLK_CHEBYSHEV": 1}, {"APSLK_LIMITS_STRETCH": 1},
                                           {"APSLK_STRETCH_CEILING_PER_TRIANGLE": 1}, {"APSLK_INTEGRATES": 1},
                                           {"APSLK_KEEPS_CONTACTS": 1}, {"APSLK_TETHERS": 2}),
                "store_step.cl": (*_WITHOUT_FORCES, {"APSLK_INTEGRATES": 0}, {"APSLK_POSITIONS_ONLY": 1}, {"APSLK_LIMITS_STRETCH": 1},
                                  *_CONTACTS_APART, *_ACCELERATIONS_APART),
                "measure_energy.cl": ({"APSLK_INTEGRATES": 0}, {"APSLK_POSITIONS_ONLY": 1}, *_CONTACTS_APART,
                                      *_ACCELERATIONS_APART),
                **{file: ({"APSLK_LIMITS_STRETCH": 1},) for file in ("matrix_free_consistent.cl", "finish_solve.cl")},
                "predict_positions.cl": (*_WITHOUT_FORCES, {"APSLK_LIMITS_STRETCH": 1}, {"APSLK_POSITIONS_ONLY": 1, "APSLK_INTEGRATES": 1},
                                         *_CONTACTS_APART),
                "start_small_steps.cl": ({"APSLK_BENDS": 1}, *_TETHERS_APART, {"APSLK_LIMITS_STRETCH": 1}, {"APSLK_POSITIONS_ONLY": 1, "APSLK_INTEGRATES": 1},
                                         {"APSLK_KEEPS_CONTACTS": 1}, *_ACCELERATIONS_APART),
                "update_velocities.cl": (*_WITHOUT_FORCES, {"APSLK_LIMITS_STRETCH": 1}, {"APSLK_INTEGRATES": 1}, *_CONTACTS_APART),
                "gather_displacements.cl": ({"APSLK_BENDS": 1}, *_TETHERS_APART, {"APSLK_TETHERS": 2, "APSLK_WARM_START_SUB_STEPS": 8},
                                            {"APSLK_TETHERS": 2, "APSLK_REGULARIZATION_PER_TRIANGLE": 1},
                                            *_CONTACTS_APART, *_ACCELERATIONS_APART,
                                            {"APSLK_ACCELERATION_PER_VERTEX": 1, "APSLK_WARM_START_SUB_STEPS": 8},
                                            {"APSLK_ACCELERATION_PER_VERTEX": 1, "APSLK_REGULARIZATION_PER_TRIANGLE": 1},
                                            {"APSLK_KEEPS_CONTACTS": 1, "APSLK_WARM_START_SUB_STEPS": 8},
                                            {"APSLK_KEEPS_CONTACTS": 1, "APSLK_REGULARIZATION_PER_TRIANGLE": 1},
                                            {"APSLK_POSITIONS_ONLY": 1, "APSLK_INTEGRATES": 1},
                                            {"APSLK_WARM_START_SUB_STEPS": 8, "APSLK_CHEBYSHEV": 1},
                                            {"APSLK_POSITION_STRIDE": 1, "APSLK_CHEBYSHEV": 1},
                                            {"APSLK_POSITION_STRIDE": 4, "APSLK_CHEBYSHEV": 1}),
                "rest_areas.cl": (*_WITHOUT_FORCES, {"APSLK_KEEPS_CONTACTS": 1}, {"APSLK_ACCELERATION_PER_VERTEX": 1}),
                # Positions are read as rest_areas.cl reads them.
                "rest_hinges.cl": ({"APSLK_TETHERS": 2}, {"APSLK_BENDS": 0}, {"APSLK_KEEPS_CONTACTS": 1}, {"APSLK_ACCELERATION_PER_VERTEX": 1},
                                   {"APSLK_INTEGRATES": 0}, {"APSLK_LIMITS_STRETCH": 0},
                                   {"APSLK_POSITION_STRIDE": 1}, {"APSLK_POSITION_STRIDE": 4}),
                "bend_hinges.cl": ({"APSLK_INTEGRATES": 0},),
                "solve_control.cl": ({"APSLK_KEEPS_CONTACTS": 1}, {"APSLK_ACCELERATION_PER_VERTEX": 1},
                                     {"APSLK_BENDS": 1, "APSLK_INTEGRATES": 0},
                                     {"APSLK_TETHERS": 2}),  # as with bending
                "order_triangle_values.cl": ({"APSLK_TETHERS": 2}, {"APSLK_CHEBYSHEV": 1, "APSLK_LIMITS_STRETCH": 0}, {"APSLK_POSITIONS_ONLY": 1},
                                             {"APSLK_STRETCH_CEILING_PER_TRIANGLE": 1, "APSLK_LIMITS_STRETCH": 0}),
                "measure_area_change.cl": ({"APSLK_TETHERS": 2}, {"APSLK_CHEBYSHEV": 1, "APSLK_LIMITS_STRETCH": 0},
                                           {"APSLK_REGULARIZATION_PER_TRIANGLE": 1}, {"APSLK_POSITIONS_ONLY": 1},
                                           {"APSLK_STRETCH_CEILING_PER_TRIANGLE": 1}),
                "assemble_gradients.cl": ({"APSLK_TETHERS": 2}, {"APSLK_CHEBYSHEV": 1, "APSLK_POSITIONS_ONLY": 1},
                                          {"APSLK_STRETCH_CEILING_PER_TRIANGLE": 1})}


@dataclass(frozen=True)
class Target:
    processor: str
    wave_size: int  # lanes
    isa: str  # device library that says which instructions there are; a near relative where the GPU is newer than it

    def __str__(self):
        return f"{self.processor}/{self.wave_size}"


# AMD's OpenCL may choose either wave size on RDNA (gfx10 and later); CDNA and GCN have 64 lanes only.
TARGETS = [
    Target("gfx906", 64, "906"),  # Vega 20: Radeon VII, MI50
    Target("gfx90a", 64, "90a"),  # CDNA 2: MI200
    Target("gfx942", 64, "940"),  # CDNA 3: MI300
    Target("gfx1030", 32, "1030"),  # RDNA 2: RX 6800, 6900
    Target("gfx1030", 64, "1030"),
    Target("gfx1100", 32, "1036"),  # RDNA 3: RX 7900
    Target("gfx1100", 64, "1036"),
    Target("gfx1201", 32, "1036"),  # RDNA 4: RX 9070
    Target("gfx1201", 64, "1036"),
]

# What tests/amd/replay executes: one of GCN, of RDNA with waves of 32, and of CDNA. Its CMakeLists.txt reads the file too.
_EXECUTED = Path(__file__).with_name("executed_targets.txt").read_text(encoding="utf-8").split()
EXECUTED = [target for target in TARGETS if str(target) in _EXECUTED]


class VariantError(Exception):
    """The kernel sources ask for something the table above does not have."""


@dataclass(frozen=True)
class Variant:
    source: Path
    defines: tuple  # pairs (name, value), sorted

    def key(self, kernel):
        return " ".join([f"{self.source.name}:{kernel}"] + [f"{name}={value}" for name, value in self.defines])


_INCLUDE = re.compile(r'^\s*#\s*include\s+"([^"]+)"', re.MULTILINE)
_DEFAULT = re.compile(r"^\s*#\s*ifndef\s+(\w+)\n\s*#\s*define\s+\1[ \t]+\S.*\n\s*#\s*endif", re.MULTILINE)
_DEFINITION = re.compile(r"^\s*#\s*define\s+(\w+)", re.MULTILINE)
_CONDITION = re.compile(r"^\s*#\s*(?:el)?if(?:n?def)?\b(.*)$", re.MULTILINE)
_COMMENT = re.compile(r"//.*")
_KERNEL = re.compile(r"^(?:APSLK_KERNEL|__kernel|kernel)\b[^;{]*?\bvoid\s+(\w+)\s*\(", re.MULTILINE)


def _text_with_includes(path, seen):
    if path in seen or not path.exists():
        return ""
    seen.add(path)
    text = _COMMENT.sub("", path.read_text(encoding="utf-8"))
    return text + "\n".join(_text_with_includes(path.parent / name, seen) for name in _INCLUDE.findall(text))


def defines_read_by(source):
    """Names that preprocessor conditions of a file and its includes ask for and that nothing there fixes."""
    text = _text_with_includes(source, set())
    fixed = set(_DEFINITION.findall(_DEFAULT.sub("", text)))
    asked = {name for condition in _CONDITION.findall(text) for name in re.findall(r"\bAPSLK_\w+", condition)}
    return sorted(asked - fixed)


def variants(kernels):
    """All variants of the .cl files of a folder."""
    sources = sorted(kernels.glob("*.cl"))
    if not sources:
        raise VariantError(f"{kernels} holds no .cl files")
    found = []
    for source in sources:
        names = defines_read_by(source)
        for name in names:
            if not any(name in setting for axis in AXES for setting in axis):
                raise VariantError(f"{source.name} reads {name}, expected its values in AXES of tests/amd/variants.py")
        # Of each axis what the file reads, every setting once.
        axes = [dict.fromkeys(tuple((n, v) for n, v in setting.items() if n in names) for setting in axis)
                for axis in AXES]
        left_out = NOT_FOR_GPUS.get(source.name, ())
        for settings in itertools.product(*axes):
            defines = tuple(sorted(itertools.chain(*settings)))
            if not any(combination.items() <= set(defines) for combination in left_out):
                found.append(Variant(source, defines))
    return found


def kernels_named_in(kernels):
    """Pairs (file name, kernel) of every kernel defined in a folder, whatever conditions it stands behind."""
    return sorted((path.name, name) for path in kernels.iterdir() if path.suffix in (".cl", ".h")
                  for name in _KERNEL.findall(_COMMENT.sub("", path.read_text(encoding="utf-8"))))


def sources_hash(kernels):
    """A digest of what makes machine code of the folder: all sources without comments and white space, and what they are
    compiled with."""
    digest = hashlib.sha256(repr((AXES, NOT_FOR_GPUS, TARGETS)).encode())
    for path in sorted([*kernels.glob("*.cl"), *kernels.glob("*.h")]):
        text = re.sub(r"/\*.*?\*/|//[^\n]*", " ", path.read_text(encoding="utf-8"), flags=re.DOTALL)
        digest.update(f"{path.name} {' '.join(text.split())}\n".encode())
    return digest.hexdigest()
