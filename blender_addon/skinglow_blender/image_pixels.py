# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender image's pixels in linear Rec.709."""

from functools import lru_cache

import bpy
import numpy as np
from mathutils import Color

from . import working_space
from .errors import SkinError

#: Names of color spaces whose bytes are linear light already, in Blender's own configurations from 3.4 to 5.2.
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
    pixels = pixels.reshape(height, width, image.channels)
    if image.is_float and image.channels > 2 and not image.colorspace_settings.is_data:
        # Blender has made linear ones of them in the file's working space.
        pixels[:, :, :3] = working_space.to_rec709(pixels[:, :, :3])
    return pixels


def colorspace_note(image: bpy.types.Image) -> str:
    """What of an image's color space could not be followed, or ""."""
    name = image.colorspace_settings.name
    return "" if not _is_coded(image) or name == "sRGB" else f"its image's color space '{name}' is taken as sRGB"


def _is_coded(image: bpy.types.Image) -> bool:
    # Bytes come as they are in the file; of floats Blender has made linear ones.
    settings = image.colorspace_settings
    return not image.is_float and not settings.is_data and settings.name not in LINEAR_SPACES


@lru_cache(maxsize=1)
def _linear_of_bytes() -> np.ndarray:
    grays = (Color((i / 255.0,) * 3).from_srgb_to_scene_linear() for i in range(256))
    return np.array([gray.from_scene_linear_to_rec709_linear().g for gray in grays], np.float32)
