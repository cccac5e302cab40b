"""Types of the compiled module with Embree. skinglow.thickness and skinglow.Occluders load it with care."""

from collections.abc import Callable, Iterable, Sequence
from typing import Any, Final

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._core import Environment, Light, PreparedRig, Tissue

DEFAULT_RAYS: Final[int]
DEFAULT_CONE_HALF_ANGLE: Final[float]
"""Radians."""
DEFAULT_SAMPLES: Final[int]

class ThicknessCancelled(RuntimeError):
    """Raised where progress asks to stop."""

def thickness_report(
    vertices: ArrayLike,
    triangles: ArrayLike,
    unit_mm: float,
    rays: int,
    cone_half_angle: float,
    min_sky_visibility: float,
    threads: int,
    progress: Callable[[float], bool] | None,
) -> tuple[NDArray[np.float64], NDArray[np.bool_]]: ...

class Occluders:
    def __init__(self, meshes: Iterable[tuple[ArrayLike, ArrayLike]], origin: ArrayLike | None) -> None: ...
    def __len__(self) -> int: ...
    @property
    def triangles(self) -> int: ...
    def visible_fraction(
        self,
        lights: Sequence[Light],
        points: ArrayLike,
        normals: ArrayLike,
        samples: int,
        excluded: Sequence[int],
        threads: int,
    ) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...

class ShapeCancelled(RuntimeError):
    """Raised where progress asks to stop."""

class Shape:
    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        tissue: Tissue | None,
        absorption: ArrayLike | None,
        reduced_scattering: ArrayLike | None,
        refractive_index: float,
        surface: str,
        unit_mm: float,
        cell_mm: float,
        max_thickness_mm: float,
        points: ArrayLike | None,
        normals: ArrayLike | None,
        threads: int,
        progress: Callable[[float], bool] | None,
        tolerance: float,
    ) -> None: ...
    @property
    def points(self) -> NDArray[np.float64]: ...
    @property
    def bytes(self) -> int: ...
    @property
    def enclosed_fraction(self) -> float: ...
    @property
    def cell_mm(self) -> float: ...
    def parts(self) -> list[dict[str, Any]]: ...
    def exitance(self, irradiance: ArrayLike, progress: Callable[[float], bool] | None) -> NDArray[np.float64]: ...
    def light(
        self,
        lights: Sequence[Light] | PreparedRig,
        environment: Environment | None,
        occluders: Occluders | None,
        excluded: Sequence[int],
        shadowless: Sequence[int],
        reentries: int,
        shadow_samples: int,
        solver_tolerance: float,
        previous: LitShape | None,
        occluder_frame: ArrayLike | None,
        progress: Callable[[float], bool] | None,
    ) -> LitShape: ...
    def exitance_error(
        self, irradiance: ArrayLike, progress: Callable[[float], bool] | None
    ) -> NDArray[np.float64]: ...
    def with_tissue(self, tissue: Tissue) -> Shape: ...

class LitShape:
    @property
    def exitance(self) -> NDArray[np.float64]: ...
    @property
    def transmitted(self) -> NDArray[np.float64]: ...
    @property
    def irradiance(self) -> NDArray[np.float64]: ...
    def error(self) -> NDArray[np.float64]: ...
    def mean_error(self) -> tuple[NDArray[np.float64], NDArray[np.float64]]: ...
    @property
    def left_out(self) -> list[int]: ...
    def per_light(self) -> NDArray[np.float64]: ...
    def recolor(
        self, colors: ArrayLike, transmitted: bool, progress: Callable[[float], bool] | None
    ) -> NDArray[np.float64]: ...
    def with_tissue(self, tissue: Tissue) -> LitShape: ...
