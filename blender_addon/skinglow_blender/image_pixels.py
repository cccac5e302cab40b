# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender image's pixels in linear light."""

from functools import lru_cache

import bpy
import numpy as np
from mathutils import Color

from .errors import SkinError

#: Names of colour spaces whose bytes are linear light already, in Blender's own configurations from 3.4 to 5.2.
LINEAR_SPACES = frozenset(("Linear", "Linear Rec.709"))
#: Pixels decoded at a time, so that a large image needs little memory besides its own.
DECODED_AT_ONCE = 1 << 20


def linear_pixels(image: bpy.types.Image) -> np.ndarray:
    """(height, width, channels) float32, the lowest row first. Raises SkinError where the image has none."""
    if not image.has_data:
        # Reading the pixels loads them, where the file is there.
        len(image.pixels)
    width, height = image.size
    if width == 0 or height == 0 or not image.has_data:
        raise SkinError(f"'{image.name}' has no pixels: is its file '{image.filepath}' still there?")
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    if _is_coded(image):
        table = _linear_of_bytes()
        for start in range(0, len(pixels), DECODED_AT_ONCE):
            part = pixels[start : start + DECODED_AT_ONCE]
            np.take(table, np.rint(part * 255.0).astype(np.uint8), out=part)
    return pixels.reshape(height, width, image.channels)


def colorspace_note(image: bpy.types.Image) -> str:
    """What of an image's colour space could not be followed, or ""."""
    name = image.colorspace_settings.name
    return "" if not _is_coded(image) or name == "sRGB" else f"its image's colour space '{name}' is taken as sRGB"


def _is_coded(image: bpy.types.Image) -> bool:
    # Bytes come as they are in the file; of floats Blender has made linear ones.
    settings = image.colorspace_settings
    return not image.is_float and not settings.is_data and settings.name not in LINEAR_SPACES


@lru_cache(maxsize=1)
def _linear_of_bytes() -> np.ndarray:
    return np.array([Color((i / 255.0,) * 3).from_srgb_to_scene_linear().r for i in range(256)], np.float32)
