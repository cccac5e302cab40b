"""Light through the real shape of a body. Embree is loaded by the first Shape and not before."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from typing import TYPE_CHECKING, Any, NamedTuple

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._core import Environment, Light, PreparedRig, Tissue
from skinglow._lit_shape import LitShape
from skinglow._numbers import indices, real_number, require_function, require_type, whole_number
from skinglow._occlusion import Occluders
from skinglow._rays_loader import load_rays

if TYPE_CHECKING:
    from skinglow import _rays

__all__ = ["Shape", "ShapePart"]


DEFAULT_CELL_MM = 0.8


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
    """A body that light is solved in, where a table over thickness takes each point for a plate. docs/shape.md

    vertices            (v, 3), finite, in units of unit_mm
    triangles           (m, 3), whole numbers from 0 to below v, counter-clockwise from outside; at least one
    tissue              skin; None, without coefficients: Tissue()
    absorption, reduced_scattering
                        three numbers each, 1/mm, 0 to 1e5: a medium of three channels instead of a tissue
    refractive_index    of that medium, 1 to 3; outside is air. A tissue has its own
    surface             "rough" (light that crosses it forgets its direction) or "smooth" (Fresnel's reflectance)
    unit_mm             length of one unit of the vertices, mm, above 0
    cell_mm             edge of the cells that light is solved on: 0.8 for work, 0.5 is final quality. None: 0.8, or
                        what `tolerance` asks for
    tolerance           without cell_mm: the largest cells, of 0.3 to 1.6 mm, with which the estimated error of thin
                        flesh that is lit from behind (RMS over mean, all channels) is at most this; e.g. 0.15
    max_thickness_mm    flesh that is thicker has the exitance of a half-space
    points, normals     (n, 3): where exitance is asked, each at the nearest point of the triangles that face along its
                        normal, finite and of any length; of any triangles where it is 0, or without normals. None: at
                        the vertices; an empty array is no points
    threads             0: one for each processor. The result does not depend on it
    progress            called on this thread with the fraction done, ascending to 1; returns whether to go on. If not,
                        RuntimeError (skinglow._rays.ShapeCancelled) is raised; what it raises is raised. All long calls
                        have it; stopped ones can be made again and go on with the parts that are ready

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
        cell_mm: float | None = None,
        tolerance: float | None = None,
        max_thickness_mm: float = 25.0,
        points: ArrayLike | None = None,
        normals: ArrayLike | None = None,
        threads: int = 0,
        progress: Callable[[float], bool] | None = None,
    ) -> None:
        if cell_mm is not None and tolerance is not None:
            raise ValueError(f"tolerance is {tolerance}; allowed: None, as cell_mm is given")
        if tolerance is not None and not real_number("tolerance", tolerance) > 0.0:
            raise ValueError(f"tolerance is {tolerance}; allowed: a number above 0")
        if not isinstance(surface, str):
            raise ValueError(f'surface is {surface!r}; allowed: "rough" or "smooth"')
        require_function("progress", progress)
        self._shape: _rays.Shape = load_rays().Shape(
            vertices,
            triangles,
            tissue,
            absorption,
            reduced_scattering,
            real_number("refractive_index", refractive_index),
            surface,
            real_number("unit_mm", unit_mm),
            DEFAULT_CELL_MM if cell_mm is None else real_number("cell_mm", cell_mm),
            real_number("max_thickness_mm", max_thickness_mm),
            points,
            normals,
            whole_number("threads", threads),
            progress,
            0.0 if tolerance is None else real_number("tolerance", tolerance),
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

    @property
    def report(self) -> dict[str, Any]:
        """What was chosen and left out.

        cell_mm                         edge of the cells, as given or chosen; parts thinner than it have smaller ones
        points, parts, points_in_parts  numbers; points in no part are taken to be thick, with a half-space's exitance
        enclosed                        fraction of the points with flesh behind them: none of an open sheet
        ready_parts, cells, bytes       of the parts that light fell on
        lost_area_fraction              largest of the parts': where it is not small, the cells are too large
        """
        parts = self.parts
        return {
            "cell_mm": self._shape.cell_mm,
            "points": len(self.points),
            "parts": len(parts),
            "points_in_parts": sum(len(part.points) for part in parts),
            "enclosed": self._shape.enclosed_fraction,
            "ready_parts": sum(part.is_ready for part in parts),
            "cells": sum(part.cells for part in parts),
            "bytes": self.bytes,
            "lost_area_fraction": max((part.lost_area_fraction for part in parts), default=0.0),
        }

    def exitance(
        self, irradiance: ArrayLike, *, progress: Callable[[float], bool] | None = None
    ) -> NDArray[np.float64]:
        """What leaves the flesh, (n, 3), W/m^2, 0 or more; without light that enters skin again.

        At a vertex it is the mean about it, weighted by the hat function of its triangles.

        irradiance  (v, 3), or (v,) for all channels alike: at each vertex, W/m^2, up to 1e30; linear on triangles
        """
        require_function("progress", progress)
        return self._shape.exitance(irradiance, progress)

    def exitance_error(
        self, irradiance: ArrayLike, *, progress: Callable[[float], bool] | None = None
    ) -> NDArray[np.float64]:
        """How far off `exitance` of that irradiance is taken to be, (n, 3), W/m^2: see LitShape.error."""
        require_function("progress", progress)
        return self._shape.exitance_error(irradiance, progress)

    def light(
        self,
        lights: Sequence[Light] | PreparedRig,
        environment: Environment | None = None,
        occluders: Occluders | None = None,
        reentries: int = 2,
        *,
        excluded: Sequence[int] = (),
        shadowless: Sequence[int] = (),
        shadow_samples: int = 16,
        solver_tolerance: float = 1e-4,
        previous: LitShape | None = None,
        occluder_frame: ArrayLike | None = None,
        progress: Callable[[float], bool] | None = None,
    ) -> LitShape:
        """The body under lights, whose shadows it casts itself, and other objects.

        lights            in the frame and the unit of the vertices; what they bring is irradiance as everywhere (one
                          unit of length is a meter)
        environment       the world
        occluders         other objects, in the same frame, or that of occluder_frame
        reentries         how often light that leaves skin enters skin again, 0 to 8
        excluded          meshes of the occluders that do not count: the body's own
        shadowless        indices of lights that nothing casts a shadow of, not even the body itself
        shadow_samples    rays to a light that has an extent, 1 to 4096
        solver_tolerance  where the solver stops, of what it began with, 1e-6 to 0.5. 1e-4 leaves 1 % where a thousandth
                          of the light comes through; 1e-2 is for a light that is being moved
        previous          this shape under earlier lights, of which what did not change is taken, see below
        occluder_frame    (4, 4), rotation and translation: from the frame of the vertices to that of the occluders. A
                          body that is carried about keeps its shape; its lights are Light.moved by the inverse

        What `previous` has of lights that shine as they did is taken as it is, where the occluders are the same object
        and it is at least as good (re-entries, samples, tolerance). Another color or power is sums alone, a moved
        light is one solve. The first of them takes its light out of those that were solved at once, and the others are
        solved again, all together; lights that were moved stay by themselves, so the next ones cost no more than what
        moved. The result is that of a call without it, to solver_tolerance.
        """
        require_type("environment", environment, Environment, "a skinglow.Environment")
        require_type("occluders", occluders, Occluders, "a skinglow.Occluders, made of the meshes")
        require_function("progress", progress)
        if not isinstance(previous, LitShape | None):
            raise ValueError(f"previous is {previous!r}; allowed: what light() of this shape returned, or None")
        before = None if previous is None else previous._lit
        return LitShape(
            self._shape.light(
                lights,
                environment,
                None if occluders is None else occluders._scene,
                indices("excluded", excluded),
                indices("shadowless", shadowless),
                whole_number("reentries", reentries),
                whole_number("shadow_samples", shadow_samples),
                real_number("solver_tolerance", solver_tolerance),
                before,
                occluder_frame,
                progress,
            )
        )

    def with_tissue(self, tissue: Tissue) -> Shape:
        """The same body of another skin, at once and with what is prepared, for sliders.

        Light goes on being solved for the flesh of the tissue that the shape was made of, and the other one's spectrum
        is put together from that. How far off it is: docs/shape.md. A shape of coefficients has no tissue: ValueError.
        """
        return self._like(self._shape.with_tissue(tissue))

    @classmethod
    def _like(cls, shape: _rays.Shape) -> Shape:
        result = cls.__new__(cls)
        result._shape = shape
        return result
