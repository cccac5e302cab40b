"""Light through the real shape of a body. Embree is loaded by the first Shape and not before."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._core import Tissue
from skinglow._rays_loader import load_rays

__all__ = ["Shape", "ShapePart"]


class ShapePart(NamedTuple):
    """A thin part of a body, which is solved by itself."""

    center: NDArray[np.float64]  #: (3,), mean of its points, mm
    points: NDArray[np.int64]  #: indices of the points in it, ascending
    is_ready: bool  #: made ready, by the first light that fell on it; what follows is 0 before
    cell_mm: float  #: edge of its cells
    cells: int
    bytes: int
    lost_area_fraction: float  #: of its surface, where the flesh is too thin for a cell


class Shape:
    """A body that light is solved in, where a table over thickness takes each place for a plate. docs/shape.md

    vertices            (v, 3), finite, in units of unit_mm
    triangles           (m, 3), whole numbers from 0 to below v, counter-clockwise from outside; at least one
    tissue              skin; None, without coefficients: Tissue()
    absorption, reduced_scattering
                        three numbers each, 1/mm, 0 to 1e5: a medium of three channels instead of a tissue
    refractive_index    of that medium, 1 to 3; outside is air. A tissue has its own
    surface             "rough" (light that crosses it forgets its direction) or "smooth" (Fresnel's reflectance)
    unit_mm             length of one unit of the vertices, mm, above 0
    cell_mm             edge of the cells that light is solved on: 0.8 for work, 0.5 is final quality
    max_thickness_mm    flesh that is thicker has the exitance of a half-space
    points, normals     (n, 3): where exitance is asked, each at the nearest place of the triangles that face along its
                        normal. None: at the vertices
    threads             0: one for each processor. The result does not depend on it
    progress            called on this thread with the fraction done, ascending to 1; returns whether to go on. If not,
                        RuntimeError (skinglow._rays.ShapeCancelled) is raised

    Thin parts are found now; each is made ready, in seconds, when light first falls on it. Flesh is where the
    triangles wind about a point more than half a time: open, doubled, overlapping and partly flipped meshes have an
    inside, and walls inside flesh do nothing. Raises ValueError naming the argument, the value and what is allowed.
    """

    def __init__(
        self,
        vertices: ArrayLike,
        triangles: ArrayLike,
        tissue: Tissue | None = None,
        *,
        absorption: ArrayLike | None = None,
        reduced_scattering: ArrayLike | None = None,
        refractive_index: float = 1.4,
        surface: str = "rough",
        unit_mm: float = 1.0,
        cell_mm: float = 0.8,
        max_thickness_mm: float = 25.0,
        points: ArrayLike | None = None,
        normals: ArrayLike | None = None,
        threads: int = 0,
        progress: Callable[[float], bool] | None = None,
    ) -> None:
        self._shape = load_rays().Shape(
            vertices,
            triangles,
            tissue,
            absorption,
            reduced_scattering,
            refractive_index,
            surface,
            unit_mm,
            cell_mm,
            max_thickness_mm,
            points,
            normals,
            threads,
            progress,
        )

    @property
    def points(self) -> NDArray[np.float64]:
        """(n, 3): where exitance is given, mm; the vertices, or the points on the surface."""
        return self._shape.points

    @property
    def parts(self) -> list[ShapePart]:
        """The thin parts; of those that are ready, with what they hold."""
        return [ShapePart(**part) for part in self._shape.parts()]

    @property
    def bytes(self) -> int:
        """Memory of what is prepared."""
        return self._shape.bytes

    def exitance(self, irradiance: ArrayLike) -> NDArray[np.float64]:
        """What leaves the flesh, (n, 3), W/m^2, 0 or more; without light that enters skin again.

        At a vertex it is the mean about it, weighted by the hat function of its triangles.

        irradiance  (v, 3), or (v,) for all channels alike: at each vertex, W/m^2, finite; linear on triangles, diffuse
        """
        return self._shape.exitance(irradiance)
