# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender image as the base lookup: brightness by thickness, thin skin at its left."""

from functools import lru_cache
from typing import Any

import bpy
import numpy as np
from mathutils import Color

from . import working_space
from .errors import SkinError, core

#: Rec.709 luminance (ITU-R BT.709-6, item 3.2 of part 1).
LUMINANCE = np.array((0.2126, 0.7152, 0.0722))


def brightness(colors: np.ndarray) -> np.ndarray:
    """Luminance of linear Rec.709 colours (n, 3), not below 0, (n,)."""
    return np.maximum(colors @ LUMINANCE, 0.0)


@lru_cache(maxsize=16)
def base_of_image(key: tuple) -> Any:  # noqa: ANN401  a skinglow.BaseLut
    """Each column's mean brightness in linear light. `base_of_image.cache_clear()` after an image was painted."""
    _kind, _width, max_thickness_mm, name, _colorspace = key
    image = bpy.data.images.get(name)
    if image is None:
        raise SkinError("The base lookup is set to an image, but none is chosen: choose one, or 'Built-in'")
    if not image.has_data:
        # Reading the pixels loads them, where the file is there.
        len(image.pixels)
    width, height = image.size
    if width == 0 or height == 0 or not image.has_data:
        raise SkinError(f"The base lookup '{image.name}' has no pixels: is its file '{image.filepath}' still there?")
    channels = image.channels
    pixels = np.empty(width * height * channels, np.float32)
    image.pixels.foreach_get(pixels)
    pixels = pixels.reshape(height, width, channels)
    colors = np.repeat(pixels[:, :, :1], 3, axis=2) if channels < 3 else pixels[:, :, :3]
    if not image.is_float and not image.colorspace_settings.is_data:
        # Bytes as they are in the file; of floats Blender has made linear ones, in the file's working space.
        colors = _linear_of_bytes()[np.rint(colors * 255.0).astype(np.intp)]
    elif not image.colorspace_settings.is_data:
        colors = working_space.to_rec709(colors)
    return core().BaseLut(brightness(colors.astype(np.float64).mean(axis=0)), max_thickness_mm)


@lru_cache(maxsize=1)
def _linear_of_bytes() -> np.ndarray:
    values = [
        Color((i / 255.0,) * 3).from_srgb_to_scene_linear().from_scene_linear_to_rec709_linear().g for i in range(256)
    ]
    return np.array(values)
