"""What stands between lights and a skin. Embree is loaded by the first Occluders and not before."""

from __future__ import annotations

import warnings
from collections.abc import Iterable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._core import Light
from skinglow._numbers import indices, whole_number
from skinglow._rays_loader import load_rays
from skinglow._renamed import renamed_keywords

if TYPE_CHECKING:
    from skinglow import _rays

__all__ = ["Occluders", "VisibleFraction"]


class VisibleFraction(NamedTuple):
    """Fraction of each light that arrives, 0 to 1."""

    mean: NDArray[np.float64]
    """(n_lights,): over the points, each weighted by the irradiance of the unoccluded light there; the factor on its
    part of the weight of a whole object. 1 where the light contributes nothing at any point."""
    at_points: NDArray[np.float64]
    """(n_points, n_lights); 1 where the light contributes nothing anyway (below the horizon, outside the cone, off)."""


class Occluders:
    """Meshes that may stand between lights and a skin, prepared for rays once.

    meshes  pairs (vertices, triangles): (n, 3) finite, world, scene unit; (m, 3) whole numbers from 0 to below n. Both
            sides stop light, whatever the winding; triangles without area stop nothing. None: nothing is in the way
    origin  (3,), near the points that will ask: what is seen from there is seen to about 1e-7 of its distance, however
            large the scene (single precision). None: the center of all meshes

    len(...) is the number of meshes. Raises ValueError naming the mesh and its entry.
    """

    def __init__(self, meshes: Iterable[tuple[ArrayLike, ArrayLike]], origin: ArrayLike | None = None) -> None:
        if not isinstance(meshes, Iterable):
            raise ValueError(f"meshes is {meshes!r}; allowed: pairs (vertices, triangles)")
        self._scene: _rays.Occluders = load_rays().Occluders(meshes, origin)

    def __len__(self) -> int:
        return len(self._scene)

    @property
    def triangles(self) -> int:
        """Triangles with area, of all meshes."""
        return self._scene.triangles

    @renamed_keywords(without="excluded")
    def visible_fraction(
        self,
        lights: Sequence[Light],
        points: ArrayLike,
        normals: ArrayLike,
        *,
        samples: int | None = None,
        excluded: Sequence[int] = (),
        threads: int = 0,
    ) -> VisibleFraction:
        """Fraction of each light that is visible from points that face along normals: (mean, at_points).

        For skin the points are those of its far side: `skinglow.far_side`. Rays go to points that cover the light
        (disk, ball, rectangle, ellipse, the sun's disk), each weighted by the irradiance it contributes; one ray goes
        to a light without extent. Surfaces that the point or the light lies on do not count.

        points, normals  (n, 3), finite, world, scene unit; normals of any length, (0, 0, 0) receives nothing
        samples          rays from a point to a light with an extent, 1 to 4096; None: 16 (error: docs/accuracy.md)
        excluded         indices of meshes that do not count: the skin's own
        threads          0: one for each processor; the result does not depend on it
        Raises ValueError naming the entry.
        """
        count = load_rays().DEFAULT_SAMPLES if samples is None else whole_number("samples", samples)
        found = self._scene.visible_fraction(
            lights, points, normals, count, indices("excluded", excluded), whole_number("threads", threads)
        )
        return VisibleFraction(*found)

    def visible_share(self, *arguments: Any, **keywords: Any) -> VisibleFraction:  # noqa: ANN401
        """The former name of visible_fraction."""
        warnings.warn("Occluders.visible_share is now visible_fraction", DeprecationWarning, stacklevel=2)
        return self.visible_fraction(*arguments, **keywords)
