# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import TYPE_CHECKING, Any, Sequence, overload

import numpy as np
import numpy.typing as npt

from . import _core, _opencl
from ._opencl import DeviceArray, Handle, OpenClObject
from ._records import Device, DeviceOptions, Error, Options, Parameters, Stats

if TYPE_CHECKING:
    from typing_extensions import Unpack


class StrainLimiter:
    """The filter for one cloth on one device. A mesh of several parts is one cloth.

    Threads may share a limiter: its calls wait for one another. Other threads run Python meanwhile.
    """

    @overload
    def __init__(self, triangles: npt.ArrayLike, vertex_count: int, device: int | Device | None = None, *,
                 context: None = None, **options: Unpack[Options]) -> None: ...
    @overload
    def __init__(self, triangles: npt.ArrayLike, vertex_count: int, device: int | Device | OpenClObject | None = None,
                 *, context: Handle, **options: Unpack[DeviceOptions]) -> None: ...
    def __init__(self, triangles: npt.ArrayLike, vertex_count: int, device: Any = None, *,
                 context: Handle | None = None, **options: Any) -> None:
        """Compiles the kernels, which takes up to seconds: make it once.

        triangles: [T, 3], vertex indices, counter-clockwise. device: a number or entry of devices(); None takes the
        first GPU, else device 0. options: see Options.
        context: yours, a pyopencl.Context or a cl_context as an integer, for enqueue() in place of limit() and step().
        It is kept for as long as the limiter lives. device is then one of its devices, also a pyopencl.Device; None
        takes the only one. options: see DeviceOptions.
        Raises Error for triangles that no topology can be built from, options out of range, no such device.
        """
        self._limiter: _core.Limiter | _core.DeviceLimiter
        if context is None:
            self._limiter = _core.Limiter(triangles, vertex_count, device, **options)
        else:
            if hasattr(device, "int_ptr"):
                _opencl.address(device, "device", "Device")
            self._limiter = _core.DeviceLimiter(triangles, vertex_count,
                                                _opencl.address(context, "context", "Context"), device, **options)
        self._options: dict[str, Any] = self._limiter.options

    def limit(self, positions: npt.ArrayLike, velocities: npt.ArrayLike, inverse_masses: npt.ArrayLike,
              rest_areas: npt.ArrayLike, **parameters: Unpack[Parameters]) -> tuple[npt.NDArray[np.float32], Stats]:
        """The velocities, float32 [V, 3] in a new array, with which triangles stay near their rest areas.

        positions: m, [V, 3], at the start of the step. velocities: m/s, [V, 3], as your integrator proposes them; the
        filter looks at positions + time_step · velocities. inverse_masses: 1/kg, [V], 0 pins a vertex, whose velocity
        comes back as it was. rest_areas: m², [T]; a triangle with rest area ≤ 0 is left alone. parameters: see
        Parameters.
        Raises Error for shapes, types and parameters that do not fit. Input that is not finite is the status
        "diverged", and the velocities come back as they were.
        """
        copying = self._with_copies("limit")
        if self._options["integrates"]:
            raise Error("limit: the limiter was made with integrates=True, expected a call of step()")
        _check_arrays("limit", self._options, {**parameters})
        limited, stats = copying.limit(positions, velocities, inverse_masses, rest_areas, **parameters)
        return limited, Stats(**stats)

    def step(self, positions: npt.ArrayLike, velocities: npt.ArrayLike, inverse_masses: npt.ArrayLike,
             rest_areas: npt.ArrayLike, **parameters: Unpack[Parameters],
             ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], Stats]:
        """A whole time step of a limiter made with integrates=True: positions and velocities at its end, float32 [V, 3]
        in new arrays. `acceleration`, `accelerations` and `damping` act in every small step.

        The arguments are those of limit(); velocities are those at the start of the step. Raises Error likewise.
        """
        copying = self._with_copies("step")
        if not self._options["integrates"]:
            raise Error("step: the limiter was made with integrates=False, expected a call of limit()")
        _check_arrays("step", self._options, {**parameters})
        moved, limited, stats = copying.limit(positions, velocities, inverse_masses, rest_areas, **parameters)
        return moved, limited, Stats(**stats)

    def enqueue(self, queue: Handle, positions: DeviceArray, velocities: DeviceArray | None,
                inverse_masses: DeviceArray, rest_areas: DeviceArray, *, wait_for: Sequence[Handle] | None = None,
                **parameters: Unpack[Parameters]) -> Any:
        """Queues a call of a limiter made with a context, on your queue and in your buffers: nothing is copied or
        waited for. velocities are the limited ones once the event completes; with integrates both they and positions
        are those at the end of the step.

        queue: a pyopencl.CommandQueue of the context and device. Arrays: what limit() takes, 32-bit floats laid out as
        the options say, each a pyopencl.array.Array, a pyopencl.Buffer, or a pair of a buffer and an offset in bytes;
        to be kept until the event completes. So are `rest_shapes`, `contacts`, `rest_hinges`, `accelerations`,
        `tether_lengths` and `tether_anchors`, which are 32-bit unsigned integers, and where there is one for each
        triangle `regularization` and `stretch_ceiling`. velocities: None with positions_only. wait_for: a list of
        events that the call starts after, besides those of the Arrays. In place of any OpenCL object its handle as an
        integer.
        Returns a pyopencl.Event, or where pyopencl is not imported the handle of an event, which the caller releases.
        Raises Error for what does not fit, before anything is queued.
        """
        made = self._without_copies("enqueue")
        options = self._options
        layouts = _layouts(made.vertex_count, made.triangle_count, made.hinge_count, options)
        given: dict[str, Any] = {"positions": positions, "velocities": velocities, "inverse_masses": inverse_masses,
                                 "rest_areas": rest_areas}
        if options["positions_only"] and velocities is None:
            del given["velocities"]
        settings: dict[str, Any] = {**parameters}
        if options["bends"] and made.hinge_count == 0:
            settings.pop("rest_hinges", None)  # of no hinges: there is no buffer of no size
            options = {**options, "bends": False}
        _check_arrays("enqueue", options, settings)
        for name, option in _optional_arrays.items():
            if options[option]:
                given[name] = settings.pop(name)
        places = {name: _opencl.place(array, name, "uint32" if name == "tether_anchors" else "float32", *layouts[name])
                  for name, array in given.items()}
        before = _opencl.addresses(wait_for)
        for array in given.values():
            before += _opencl.events_of(array)
        return _opencl.event(made.enqueue(_opencl.address(queue, "queue", "CommandQueue"), places, before, **settings))

    def read_stats(self, queue: Handle, *, wait_for: Sequence[Handle] | None = None) -> Stats:
        """What the last call of enqueue() did, once it has: waits for it. On an out-of-order queue, or another one than
        the call's, give its event as wait_for. Before the first call all is zero.
        """
        made = self._without_copies("read_stats")
        stats = made.read_stats(_opencl.address(queue, "queue", "CommandQueue"), _opencl.addresses(wait_for))
        return Stats(**stats)

    @staticmethod
    def default_parameters() -> dict[str, Any]:
        """What limit() takes where it is given nothing, by name."""
        return _core.default_parameters()

    @property
    def options(self) -> dict[str, Any]:
        """The options as resolved for the device, by name: no zeros and no "automatic" left."""
        return {**self._options}

    @property
    def scratch_bytes(self) -> int:
        """Device memory that the filter holds; the arrays of a call come on top."""
        return self._limiter.scratch_bytes

    def _with_copies(self, call: str) -> _core.Limiter:
        if isinstance(self._limiter, _core.DeviceLimiter):
            raise Error(f"{call}: the limiter was made with a context, expected a call of enqueue()")
        return self._limiter

    def _without_copies(self, call: str) -> _core.DeviceLimiter:
        if isinstance(self._limiter, _core.Limiter):
            raise Error(f"{call}: the limiter was made without a context, expected StrainLimiter(…, context=…)")
        return self._limiter


_optional_arrays = {"regularization": "regularization_per_triangle", "rest_shapes": "limits_stretch",
                    "stretch_ceiling": "stretch_ceiling_per_triangle", "contacts": "keeps_contacts",
                    "rest_hinges": "bends", "accelerations": "acceleration_per_vertex",
                    "tether_anchors": "tethers_per_vertex", "tether_lengths": "tethers_per_vertex"}


def _check_arrays(call: str, options: dict[str, Any], settings: dict[str, Any]) -> None:
    """Raises where an array is missing that the options ask for, TypeError where it may have been misspelt, or given
    where they do not."""
    numbers = StrainLimiter.default_parameters().keys()
    for name, option in _optional_arrays.items():
        if not options[option] and name in settings.keys() - numbers:
            raise _opencl.refuse(name, type(settings[name]).__name__, f"nothing (limiter made without {option})")
        if options[option] and name not in settings:
            unknown = settings.keys() - numbers - _optional_arrays.keys()
            if unknown:
                raise TypeError(f"{call}() got an unexpected keyword argument '{min(unknown)}', expected {name}")
            raise _opencl.refuse(name, "nothing", f"an array (limiter made with {option})")


def _layouts(vertices: int, triangles: int, hinges: int,
             options: dict[str, Any]) -> dict[str, tuple[tuple[int, ...], tuple[int, ...]]]:
    """Shape and strides in bytes of each array."""
    def vectors(of: str) -> tuple[tuple[int, ...], tuple[int, ...]]:
        return (vertices, 3), (4 * options[f"{of}_stride"], 4 * options[f"{of}_component_stride"])

    numbers = (triangles,), (4,)
    each = options["tethers_per_vertex"]
    tethers = (vertices, each), (4 * each, 4)
    return {"positions": vectors("position"), "velocities": vectors("velocity"),
            "inverse_masses": ((vertices,), (4 * options["inverse_mass_stride"],)), "rest_areas": numbers,
            "regularization": numbers, "rest_shapes": ((triangles, 4), (16, 4)), "stretch_ceiling": numbers,
            "contacts": ((vertices, 8), (32, 4)), "rest_hinges": ((hinges, 2), (8, 4)),
            "accelerations": vectors("position"), "tether_anchors": tethers, "tether_lengths": tethers}
