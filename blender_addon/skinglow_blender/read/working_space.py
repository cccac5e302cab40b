# SPDX-License-Identifier: GPL-3.0-or-later
"""Conversion between a file's working color space and the core's linear Rec.709.

Since Blender 5.0 a file's working space may be Rec.2020 or ACEScg; before that, a custom OpenColorIO configuration can
change it. Light colors, sockets and images are then in that space, and shaders interpret Non-Color images in it too.
"""

from collections.abc import Sequence
from functools import lru_cache

import numpy as np
from mathutils import Color

#: Rounding of OpenColorIO where both spaces are the same, and of the colors that Blender converts.
SAME = 1e-5
ROUNDED = 1e-4


def working_space() -> tuple[float, float, float]:
    """The file's red in linear Rec.709: identifies the space, and is much faster to read than its name."""
    return Color((1.0, 0.0, 0.0)).from_scene_linear_to_rec709_linear()[:]


def light_color(color: Sequence[float]) -> tuple[tuple[float, float, float], str]:
    """A light's color in linear Rec.709, clipped to that gamut, and a note if it was clipped."""
    matrix = _to_rec709(working_space())
    if matrix is None:
        return tuple(color), ""
    red, green, blue = (matrix @ color).tolist()
    outside = min(red, green, blue) < -ROUNDED * max(red, green, blue)
    note = "its color is outside the Rec.709 gamut and is clipped" if outside else ""
    return (max(red, 0.0), max(green, 0.0), max(blue, 0.0)), note


def to_rec709(colors: np.ndarray) -> np.ndarray:
    """Converts colors (..., 3) from the file's working space to linear Rec.709."""
    matrix = _to_rec709(working_space())
    return colors if matrix is None else (colors @ matrix.T).astype(colors.dtype)


def from_rec709(colors: np.ndarray) -> np.ndarray:
    """Converts colors (..., 3) from linear Rec.709 to the file's working space."""
    matrix = _from_rec709(working_space())
    return colors if matrix is None else (colors @ matrix.T).astype(colors.dtype)


@lru_cache(maxsize=8)
def _to_rec709(_space: tuple) -> np.ndarray | None:
    return _matrix([Color(unit).from_scene_linear_to_rec709_linear() for unit in np.eye(3).tolist()])


@lru_cache(maxsize=8)
def _from_rec709(_space: tuple) -> np.ndarray | None:
    return _matrix([Color(unit).from_rec709_linear_to_scene_linear() for unit in np.eye(3).tolist()])


def _matrix(columns: list[Color]) -> np.ndarray | None:
    """Blender's own conversion as a matrix; None for the identity, so that no digit is lost to rounding."""
    matrix = np.array(columns, np.float64).T
    matrix.setflags(write=False)
    return None if np.allclose(matrix, np.eye(3), rtol=0.0, atol=SAME) else matrix
