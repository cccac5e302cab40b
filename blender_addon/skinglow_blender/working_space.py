# SPDX-License-Identifier: GPL-3.0-or-later
"""Between the colors of a file and the core's linear Rec.709.

From 5.0 on a file may work in Rec.2020 or ACEScg; before that, under an OpenColorIO configuration of one's own. Lamp
colors, sockets and images are in that space then, and a Non-Color image's pixels go into shaders as if they were.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from mathutils import Color

#: Roundings of OpenColorIO's own, where both spaces are the same; and of the colors that Blender converts.
SAME = 1e-5
ROUNDED = 1e-4


def working_space() -> tuple[float, float, float]:
    """The file's red in linear Rec.709: tells one space from another, and is told quickly, which the name is not."""
    return Color((1.0, 0.0, 0.0)).from_scene_linear_to_rec709_linear()[:]


def lamp_color(color: Sequence[float]) -> tuple[tuple[float, float, float], str]:
    """A lamp's color in linear Rec.709, and what of it that space cannot hold, in words: it is left out."""
    matrix = _to_rec709(working_space())
    if matrix is None:
        return tuple(color), ""
    red, green, blue = (matrix @ color).tolist()
    outside = min(red, green, blue) < -ROUNDED * max(red, green, blue)
    note = "its color is more saturated than linear Rec.709 can hold, and is cut to that" if outside else ""
    return (max(red, 0.0), max(green, 0.0), max(blue, 0.0)), note


def to_rec709(colors: np.ndarray) -> np.ndarray:
    """Colors of the file (..., 3) in linear Rec.709."""
    matrix = _to_rec709(working_space())
    return colors if matrix is None else (colors @ matrix.T).astype(colors.dtype)


def from_rec709(colors: np.ndarray) -> np.ndarray:
    """Colors (..., 3) of linear Rec.709 in the file's space."""
    matrix = _from_rec709(working_space())
    return colors if matrix is None else (colors @ matrix.T).astype(colors.dtype)


@lru_cache(maxsize=8)
def _to_rec709(_space: tuple) -> np.ndarray | None:
    return _matrix([Color(unit).from_scene_linear_to_rec709_linear() for unit in np.eye(3).tolist()])


@lru_cache(maxsize=8)
def _from_rec709(_space: tuple) -> np.ndarray | None:
    return _matrix([Color(unit).from_rec709_linear_to_scene_linear() for unit in np.eye(3).tolist()])


def _matrix(columns: list[Color]) -> np.ndarray | None:
    """Blender's own conversion as a matrix; None where it changes nothing, so that every digit is kept."""
    matrix = np.array(columns, np.float64).T
    return None if np.allclose(matrix, np.eye(3), rtol=0.0, atol=SAME) else matrix
