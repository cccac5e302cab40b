# SPDX-License-Identifier: GPL-3.0-or-later
"""A Blender image as the base lookup: brightness by thickness, thin skin on the left."""

from typing import Any

import numpy as np

from ..errors import SkinError, core
from ..session import SESSION
from .image_pixels import image_of, linear_pixels


def base_of_image(key: tuple) -> Any:  # noqa: ANN401  a skinglow.BaseLut
    """Mean linear brightness of each column. Read once: forget SESSION.base_images after an image was painted."""
    if key in SESSION.base_images:
        return SESSION.base_images[key]
    _kind, _width, max_thickness_mm, image_key, _colorspace = key
    image = image_of(image_key)
    if image is None:
        raise SkinError(
            "The base lookup is set to Image, but no image is selected: select one, or set Base to Built-in"
        )
    try:
        pixels = linear_pixels(image)
    except SkinError as error:
        raise SkinError(f"The base lookup {error}") from error
    colors = np.repeat(pixels[:, :, :1], 3, axis=2) if pixels.shape[2] < 3 else pixels[:, :, :3]
    base = core().BaseLut(core().luminance(colors.astype(np.float64).mean(axis=0)), max_thickness_mm)
    SESSION.base_images[key] = base
    return base
