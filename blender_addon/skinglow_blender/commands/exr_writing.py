# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes float images by Blender's own writer."""

from pathlib import Path

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError


def write_exr(path: Path, pixels: np.ndarray) -> None:
    """Writes pixels (height, width, 3 or 4), bottom row first, as a float32 EXR, exactly.

    Raises SkinError naming the file.
    """
    height, width, channels = pixels.shape
    image = bpy.data.images.new(".Skinglow file", width, height, alpha=channels == 4, float_buffer=True)
    try:
        # Before the pixels: setting it clears them.
        image.colorspace_settings.name = blender_version.data_color_space(image)
        image.alpha_mode = "CHANNEL_PACKED" if channels == 4 else "NONE"
        rgba = np.ones((height, width, 4), np.float32)
        rgba[:, :, :channels] = pixels
        image.pixels.foreach_set(rgba.ravel())
        image.file_format = "OPEN_EXR"
        image.filepath_raw = str(path)
        try:
            image.save()
        except RuntimeError as error:
            raise SkinError(f"Cannot write {path}: {error}") from error
    finally:
        bpy.data.images.remove(image)
