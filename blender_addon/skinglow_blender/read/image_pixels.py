# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender image's pixels in linear Rec.709."""

from functools import lru_cache

import bpy
import numpy as np
from mathutils import Color

from ..errors import SkinError
from . import working_space

#: Names of color spaces whose bytes are linear already, in Blender's own configurations from 3.4 to 5.2.
LINEAR_SPACES = frozenset(("Linear", "Linear Rec.709"))
#: Pixels decoded at a time, to bound the temporary memory for large images.
DECODE_BLOCK = 1 << 20


def image_of(key: str) -> bpy.types.Image | None:
    """The image of that identity.lasting_key_of, if there is one."""
    name, _, library = key.partition("\n")
    return bpy.data.images.get((name, library or None))


def linear_pixels(image: bpy.types.Image, *, shown: bool = False) -> np.ndarray:
    """(height, width, channels) float32, bottom row first. Raises SkinError if the image has none.

    shown  whether bytes are multiplied by alpha, as textures do whose Color alone is linked; floats always are
    """
    if not image.has_data:
        # Reading the pixels loads them, if the file exists.
        len(image.pixels)
    width, height = image.size
    if width == 0 or height == 0 or not image.has_data:
        raise SkinError(f"'{image.name}' has no pixels: check that its file '{image.filepath}' exists")
    pixels = np.empty(width * height * image.channels, np.float32)
    image.pixels.foreach_get(pixels)
    if shown and _is_multiplied(image):
        # Before they are decoded, and cut to whole bytes, as OpenImageIO does it.
        whole = np.floor(pixels.reshape(-1, 4)[:, :3] * pixels[3::4, None] * 255.0 + 1e-3)
        pixels.reshape(-1, 4)[:, :3] = whole / 255.0
    if _is_coded(image):
        table = _linear_of_bytes()
        for start in range(0, len(pixels), DECODE_BLOCK):
            part = pixels[start : start + DECODE_BLOCK]
            np.take(table, np.rint(part * 255.0).astype(np.uint8), out=part)
    pixels = pixels.reshape(height, width, image.channels)
    if image.is_float and image.channels > 2 and not image.colorspace_settings.is_data:
        # Blender has converted them to the file's linear working space.
        pixels[:, :, :3] = working_space.to_rec709(pixels[:, :, :3])
    return pixels


def colorspace_note(image: bpy.types.Image) -> str:
    """What of an image's color space is not supported, or ""."""
    name = image.colorspace_settings.name
    return "" if not _is_coded(image) or name == "sRGB" else f"its image's color space '{name}' is treated as sRGB"


def _is_multiplied(image: bpy.types.Image) -> bool:
    settings = image.colorspace_settings
    coverage = image.channels == 4 and image.alpha_mode in ("STRAIGHT", "PREMUL")
    return coverage and not image.is_float and not settings.is_data


def _is_coded(image: bpy.types.Image) -> bool:
    # Blender returns bytes as they are in the file, and floats converted to linear.
    settings = image.colorspace_settings
    return not image.is_float and not settings.is_data and settings.name not in LINEAR_SPACES


@lru_cache(maxsize=1)
def _linear_of_bytes() -> np.ndarray:
    grays = (Color((i / 255.0,) * 3).from_srgb_to_scene_linear() for i in range(256))
    table = np.array([gray.from_scene_linear_to_rec709_linear().g for gray in grays], np.float32)
    table.setflags(write=False)
    return table
