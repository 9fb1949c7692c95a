# SPDX-License-Identifier: MIT
from __future__ import annotations

from typing import TYPE_CHECKING, Any

import numpy as np
import numpy.typing as npt

from . import _core
from ._records import Device, Error, Options, Parameters, Stats

if TYPE_CHECKING:
    from typing_extensions import Unpack


class StrainLimiter:
    """The filter for one cloth on one device. A mesh of several parts is one cloth.

    Threads may share a limiter: its calls wait for one another. Other threads run Python meanwhile.
    """

    def __init__(self, triangles: npt.ArrayLike, vertex_count: int, device: int | Device | None = None,
                 **options: Unpack[Options]) -> None:
        """Compiles the kernels, which takes up to seconds: make it once.

        triangles: [T, 3], vertex indices, counter-clockwise. device: a number or entry of devices(); None takes the
        first GPU, else device 0. options: see Options.
        Raises Error for triangles that no topology can be built from, options out of range, no such device.
        """
        self._limiter = _core.Limiter(triangles, vertex_count, device, **options)

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
        if self.options["integrates"]:
            raise Error("limit: the limiter was made with integrates=True, expected a call of step()")
        limited, stats = self._limiter.limit(positions, velocities, inverse_masses, rest_areas, **parameters)
        return limited, Stats(**stats)

    def step(self, positions: npt.ArrayLike, velocities: npt.ArrayLike, inverse_masses: npt.ArrayLike,
             rest_areas: npt.ArrayLike, **parameters: Unpack[Parameters],
             ) -> tuple[npt.NDArray[np.float32], npt.NDArray[np.float32], Stats]:
        """A whole time step of a limiter made with integrates=True: positions and velocities at its end, float32 [V, 3]
        in new arrays. `acceleration` and `damping` act in every small step.

        The arguments are those of limit(); velocities are those at the start of the step. Raises Error likewise.
        """
        if not self.options["integrates"]:
            raise Error("step: the limiter was made with integrates=False, expected a call of limit()")
        moved, limited, stats = self._limiter.limit(positions, velocities, inverse_masses, rest_areas, **parameters)
        return moved, limited, Stats(**stats)

    @staticmethod
    def default_parameters() -> dict[str, Any]:
        """What limit() takes where it is given nothing, by name."""
        return _core.default_parameters()

    @property
    def options(self) -> dict[str, Any]:
        """The options as resolved for the device, by name: no zeros and no "automatic" left."""
        return self._limiter.options

    @property
    def scratch_bytes(self) -> int:
        """Device memory that the filter holds; the arrays of a call come on top."""
        return self._limiter.scratch_bytes
