"""Thickness of a mesh. Embree is loaded by the first call and not before."""

from __future__ import annotations

from collections.abc import Callable
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._numbers import real_number, require_function, whole_number
from skinglow._rays_loader import load_rays
from skinglow._renamed import renamed_keywords

__all__ = ["ThicknessReport", "thickness", "thickness_report"]


class ThicknessReport(NamedTuple):
    """Thickness, and where it was found."""

    thickness_mm: NDArray[np.float64]  #: (n,), as `thickness` gives it
    no_far_side: NDArray[np.bool_]  #: (n,), where no ray found a way out: the mesh is open, doubled or flat there

    @property
    def no_far_side_fraction(self) -> float:
        """Fraction of the vertices that found no far side; 0 for an empty mesh."""
        return float(self.no_far_side.mean()) if len(self.no_far_side) else 0.0


@renamed_keywords(min_openness="min_sky_visibility")
def thickness(
    vertices: ArrayLike,
    triangles: ArrayLike,
    unit_mm: float = 1.0,
    rays: int | None = None,
    *,
    cone_half_angle: float | None = None,
    min_sky_visibility: float = 0.0,
    threads: int = 0,
    progress: Callable[[float], bool] | None = None,
) -> NDArray[np.float64]:
    """How thick a body is at each vertex, (n,) float64, mm.

    The diameter of the ball that touches the surface at the vertex from within, and the far side, by a cone of
    inward rays: a slab's thickness, a sphere's diameter, a shell's wall. A quarter of the rays may be misled by a
    crease. The same on any number of threads.

    vertices            (n, 3), finite, in units of unit_mm
    triangles           (m, 3), whole numbers from 0 to below n, counter-clockwise from outside; a mesh that encloses
                        a negative volume is flipped. At least one, unless n is 0
    unit_mm             length of one unit of the vertices, mm, above 0
    rays                per vertex, 1 to 65536; None: the measured default (docs/accuracy.md)
    cone_half_angle     between axis and rim, radians, 0 to 1.5; None: pi/4
    min_sky_visibility  smallest fraction of a uniform sky's light, 0 to 1, that a far side must receive for a ray to
                        end there; what receives less (mouth, eye sockets) is dark, and passed as if it were flesh.
                        0: every way out counts, also into a closed cavity
    threads             0: one for each processor
    progress            called on this thread with the fraction done, ascending to 1; returns whether to go on. If
                        not, RuntimeError (skinglow._rays.ThicknessCancelled) is raised

    Vertices at one position get one value; triangles without area are ignored. Where no ray finds a
    way out (a plane, an open hem, a vertex without triangles) the value is the bounding box's
    diagonal: thicker than anything in the mesh. Never NaN, infinite or negative.
    Raises ValueError naming the argument, the value and what is allowed.
    """
    return thickness_report(
        vertices,
        triangles,
        unit_mm,
        rays,
        cone_half_angle=cone_half_angle,
        min_sky_visibility=min_sky_visibility,
        threads=threads,
        progress=progress,
    ).thickness_mm


def thickness_report(
    vertices: ArrayLike,
    triangles: ArrayLike,
    unit_mm: float = 1.0,
    rays: int | None = None,
    *,
    cone_half_angle: float | None = None,
    min_sky_visibility: float = 0.0,
    threads: int = 0,
    progress: Callable[[float], bool] | None = None,
) -> ThicknessReport:
    """As `thickness`, and tells at which vertices no far side was found. Parameters and errors as there."""
    require_function("progress", progress)
    module = load_rays()
    cone = module.DEFAULT_CONE_HALF_ANGLE if cone_half_angle is None else cone_half_angle
    values, no_far_side = module.thickness_report(
        vertices,
        triangles,
        real_number("unit_mm", unit_mm),
        module.DEFAULT_RAYS if rays is None else whole_number("rays", rays),
        real_number("cone_half_angle", cone),
        real_number("min_sky_visibility", min_sky_visibility),
        whole_number("threads", threads),
        progress,
    )
    return ThicknessReport(values, no_far_side)
