"""A body under lights."""

from __future__ import annotations

from collections.abc import Callable
from functools import cached_property
from typing import TYPE_CHECKING, Any

import numpy as np
from numpy.typing import ArrayLike, NDArray

from skinglow._core import Tissue
from skinglow._numbers import fixed, require_function

if TYPE_CHECKING:
    from skinglow import _rays

__all__ = ["LitShape"]


class LitShape:
    """A body under lights; made by Shape.light. Its arrays are kept, and read-only: copy what is to be changed."""

    def __init__(self, lit: _rays.LitShape) -> None:
        self._lit = lit

    @cached_property
    def exitance(self) -> NDArray[np.float64]:
        """(n, 3): what leaves the flesh at each point, W/m^2, 0 or more; not what the surface throws back."""
        return fixed(self._lit.exitance)

    @cached_property
    def transmitted(self) -> NDArray[np.float64]:
        """(n, 3): exitance less what a half-space would send out under the same irradiance, at least 0.

        To add to skin that is shaded as lit from its own side.
        """
        return fixed(self._lit.transmitted)

    @cached_property
    def error(self) -> NDArray[np.float64]:
        """(n, 3): how far off the exitance is taken to be, W/m^2, as one standard deviation at each point.

        From how far light has fallen, the medium and the cells; above the errors measured in docs/shape.md, up to three
        times. Surface and medium are taken as they are given.
        """
        return fixed(self._lit.error())

    @cached_property
    def irradiance(self) -> NDArray[np.float64]:
        """(v, 3): at the vertices, of lights and world, shadows included; 0 where it does not matter."""
        return fixed(self._lit.irradiance)

    @cached_property
    def per_light(self) -> NDArray[np.float64]:
        """(k, n, 3): exitance by light alone, W/m^2. Solved when it is first asked for, each light by itself.

        Of a light of negative power it is what that takes from the others: 0 or less. With the world's part all add up
        to `exitance` where that is above 0, for a tissue under more than four lights within some percent.
        """
        return fixed(self._lit.per_light())

    def recolor(
        self, colors: ArrayLike, *, transmitted: bool = False, progress: Callable[[float], bool] | None = None
    ) -> NDArray[np.float64]:
        """(n, 3): the exitance with other colors of the lights; sums alone once this or per_light was asked for.

        colors       (k, 3), linear Rec.709, finite, 0 or more, instead of the lights' own
        transmitted  what comes through instead of the exitance
        progress     as of Shape
        """
        require_function("progress", progress)
        return self._lit.recolor(colors, transmitted, progress)

    def with_tissue(self, tissue: Tissue) -> LitShape:
        """The same light in another skin, in milliseconds and without solving: see Shape.with_tissue."""
        return LitShape(self._lit.with_tissue(tissue))

    @property
    def report(self) -> dict[str, Any]:
        """What was left out, and how far off the light is taken to be.

        left_out  indices of lights that give nothing, or all together less than a thousandth of the light
        error     (3,): RMS of `error` over the exitance, of skin that is lit through: most of its light is transmitted.
                  Each point counts with the light that leaves its area. Of all skin that is solved where none is
        part_errors  (p, 3): the same of each of Shape.parts
        """
        error, part_errors = self._lit.mean_error()
        return {"left_out": self._lit.left_out, "error": error, "part_errors": part_errors}
