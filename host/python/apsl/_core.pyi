# SPDX-License-Identifier: MIT
from typing import Any

import numpy as np
import numpy.typing as npt

from ._records import Device

__version__: str

def devices() -> list[dict[str, Any]]: ...
def rest_areas(positions: npt.ArrayLike, triangles: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
def rest_shapes(positions: npt.ArrayLike, triangles: npt.ArrayLike) -> npt.NDArray[np.float64]: ...
def area_change(
    positions: npt.ArrayLike, triangles: npt.ArrayLike, rest_areas: npt.ArrayLike
) -> npt.NDArray[np.float64]: ...
def default_parameters() -> dict[str, Any]: ...

class Limiter:
    def __init__(
        self, triangles: npt.ArrayLike, vertex_count: int, device: int | Device | None, **options: Any
    ) -> None: ...
    def limit(
        self,
        positions: npt.ArrayLike,
        velocities: npt.ArrayLike,
        inverse_masses: npt.ArrayLike,
        rest_areas: npt.ArrayLike,
        **parameters: Any,
    ) -> tuple[Any, ...]: ...
    @property
    def options(self) -> dict[str, Any]: ...
    @property
    def scratch_bytes(self) -> int: ...
