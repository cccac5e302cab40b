"""Types of the compiled module with Embree. Call skinglow.thickness, which loads it with care."""

from collections.abc import Callable
from typing import Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

DEFAULT_RAYS: Final[int]
DEFAULT_CONE_HALF_ANGLE: Final[float]
"""Radians."""

class ThicknessCancelled(RuntimeError):
    """Raised where progress asks to stop."""

def thickness(
    vertices: ArrayLike,
    triangles: ArrayLike,
    unit_mm: float,
    rays: int,
    cone_half_angle: float,
    min_openness: float,
    threads: int,
    progress: Callable[[float], bool] | None,
) -> NDArray[np.float64]: ...
