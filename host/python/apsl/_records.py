# SPDX-License-Identifier: MIT
"""What goes in and comes out besides arrays. The C++ structs of the same names say more (include/apsl)."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal, Sequence, TypedDict, Union

import numpy.typing as npt

if TYPE_CHECKING:
    from ._opencl import DeviceArray


class Options(TypedDict, total=False):
    """What is compiled in, once for a limiter. Defaults: StrainLimiter.options."""

    matrix: Literal["consistent", "printed"]
    apply: Literal["assembled_csr", "matrix_free"]
    execution: Literal["automatic", "many_groups", "one_group"]
    work_group_size: int  # a power of two; 0 takes what suits the device
    regularization_per_triangle: bool  # `regularization` is then an array [T] in every call
    warm_start_sub_steps: int  # sub-steps whose pressures the next call's solves start from
    # chebyshev: a fixed polynomial with the reach of α; automatic: that with limits_stretch, CG otherwise
    solver: Literal["conjugate_gradient", "chebyshev", "automatic"]
    bound_interval: int  # by Chebyshev, ≥ 1: sub-steps from one bound of the matrix to the next
    limits_stretch: bool  # `rest_shapes` are then given in every call, and `stretch_ceiling` counts
    stretch_ceiling_per_triangle: bool  # `stretch_ceiling` is then an array [T] in every call
    integrates: bool  # a call is a whole time step: it returns positions too
    keeps_contacts: bool  # `contacts` are then given in every call
    bends: bool  # hinges resist bending: `rest_hinges` are then given in every call, and `bending` counts
    acceleration_per_vertex: bool  # `accelerations` are then given in every call
    tethers_per_vertex: int  # 0 to 4: above 0 `tether_anchors` and `tether_lengths` are given in every call


class DeviceOptions(Options, total=False):
    """Options of a limiter in a context of yours: also where the numbers lie in its buffers."""

    position_stride: int  # floats, from one position to the next
    velocity_stride: int
    position_component_stride: int  # floats, from x to y and from y to z
    velocity_component_stride: int
    inverse_mass_stride: int  # floats
    positions_only: bool  # no velocities: positions are those at the end of the step, corrected in place


class Parameters(TypedDict, total=False):
    """What may change from call to call. Defaults: StrainLimiter.default_parameters(). Where an array is taken, one on
    the device is for enqueue()."""

    time_step: float  # s, > 0
    regularization: Union[float, npt.ArrayLike, DeviceArray]  # α ≥ 1; an array [T] with regularization_per_triangle
    sub_steps: int  # from 0 to 10000
    most_sub_steps: int  # ≥ sub_steps: more are taken where stretch asks for them; 0: automatic
    target_area_change: float  # ≥ 0, no further sub-step once every triangle is at or below it
    tolerance: float  # in [0, 1), of a solve's residual
    max_iterations: int  # from 1 to 10000, CG iterations of a solve
    adaptive_threshold: int  # 0: α stays as given; else more iterations than this raise it
    first_regularization: float  # 0: one α for all sub-steps; else > 1, that of the first
    # 0, or ≥ 1.01: no principal stretch above this multiple of the rest shape; an array [T] with
    # stretch_ceiling_per_triangle
    stretch_ceiling: Union[float, npt.ArrayLike, DeviceArray]
    rest_shapes: Union[npt.ArrayLike, DeviceArray]  # 1/m, [T, 4], with limits_stretch: see rest_shapes()
    # [V, 8], with keeps_contacts: outward unit normal n (zeros: none), offset d, m (kept at n·x ≥ d), velocity of the
    # body there, m/s, coefficient of friction
    contacts: Union[npt.ArrayLike, DeviceArray]
    acceleration: Sequence[float]  # m/s², three, with integrates
    accelerations: Union[npt.ArrayLike, DeviceArray]  # m/s², [V, 3], with acceleration_per_vertex, beside acceleration
    # [V, tethers_per_vertex], with that: pinned vertices, and how far from each a vertex may be, m, 0: no tether; see
    # tethers_to_pins(). Anchors on the device are uint32
    tether_anchors: Union[npt.ArrayLike, DeviceArray]
    tether_lengths: Union[npt.ArrayLike, DeviceArray]
    damping: float  # 1/s, ≥ 0, with integrates
    rest_hinges: Union[npt.ArrayLike, DeviceArray]  # [H, 2], with bends: see rest_hinges()
    bending: float  # N·m, ≥ 0, with bends: the cloth's rigidity
    bending_iterations: int  # ≥ 1, with bends: evaluations a small step
    stepping: Literal["automatic", "whole_step", "small_steps"]  # automatic: small from 20 sub-steps up
    enabled: bool  # False: the velocities come back as they were, with status "off"


@dataclass(frozen=True)
class Stats:
    """What one call did."""

    sub_steps: int  # solves done
    iterations: int  # over all solves: of CG, or products with the matrix by Chebyshev
    residual: float  # greatest relative residual at the end of a solve; 0 by Chebyshev
    max_area_change: float  # max |A − A⁰| / A⁰ of the state that stands
    rms_area_change: float  # weighted with A⁰
    initial_max_area_change: float  # both at x + Δt v
    initial_rms_area_change: float
    status: Literal["ok", "not_converged", "worsened", "diverged", "off"]
    offender: Literal["none", "vertex", "triangle"]  # other than none only where status is diverged or worsened
    offender_index: int  # the first one
    raised_vertices: int  # that weighed more than given in the last sub-step
    greatest_mass_ratio: float  # their greatest mass over the one given; 1 where none was raised
    max_stretch: float  # greatest principal stretch; this and the next five are 0 without limits_stretch
    max_stretch_excess: float  # greatest max(0, principal stretch − ceiling)
    rms_stretch_excess: float  # weighted with A⁰
    initial_max_stretch_excess: float  # both at x + Δt v
    initial_rms_stretch_excess: float
    stretch_rows: int  # triangles that the ceiling held in the last sub-step
    # the share of the cloth's kinetic energy, against what drives it, that the bound on energy left; 1 where it took
    # none, and without integrates
    energy_kept: float


@dataclass(frozen=True)
class Device:
    """An OpenCL device."""

    number: int  # its place in devices(), as in the program's `apsl devices`
    name: str
    platform: str
    driver: str
    is_gpu: bool
    compute_units: int
    memory: int  # bytes


class Error(RuntimeError):
    """Everything that goes wrong: one line that names what, where, and what was expected.

    code: "invalid_argument", "invalid_mesh", "opencl", "kernel_build" or "unsupported".
    opencl_code: the failed call's status, 0 where none was involved.
    build_log: the compiler's output, empty unless code is "kernel_build".
    """

    def __init__(self, message: str, code: str = "invalid_argument", opencl_code: int = 0, build_log: str = "") -> None:
        super().__init__(message)
        self.code = code
        self.opencl_code = opencl_code
        self.build_log = build_log
