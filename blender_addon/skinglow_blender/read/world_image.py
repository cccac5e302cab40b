# SPDX-License-Identifier: GPL-3.0-or-later
"""A world's image as nine spherical-harmonic coefficients, reread only when its pixels may have changed."""

import os
from typing import Any

import bpy

from ..errors import SkinError, core
from ..identity import lasting_key_of
from ..session import SESSION
from .image_pixels import image_of, linear_pixels

#: Blender does not report painted pixels: an image that was edited and not saved is reread at each update up to this
#: size (some 10 ms); larger ones only after `forget_edited`.
MAX_EDITED_PIXELS = 1 << 20


def environment_of_image(key: str, projection: str) -> Any:  # noqa: ANN401  a skinglow.Environment
    """The environment of an image (lasting_key_of), not rotated. Raises SkinError if it cannot be used."""
    image = image_of(key)
    if image is None:
        raise SkinError("its image no longer exists")
    source = _source_of(image)
    known = SESSION.world_images.get((key, projection))
    edited = image.is_dirty and image.size[0] * image.size[1] <= MAX_EDITED_PIXELS
    # Reloading leaves an image without data until it is read; not every version reports it.
    if known is None or known[0] != source or edited or not image.has_data:
        known = SESSION.world_images[key, projection] = (source, _compute(image, projection))
    if isinstance(known[1], SkinError):
        raise known[1]
    return known[1]


def forget(key: str) -> None:
    """Rereads an image at the next update."""
    for known in [known for known in SESSION.world_images if known[0] == key]:
        del SESSION.world_images[known]


def forget_edited() -> None:
    """Rereads all images that were edited in Blender and not saved since."""
    for image in bpy.data.images:
        if image.is_dirty:
            forget(lasting_key_of(image))


def is_known(key: str) -> bool:
    """Whether a world uses or used that image."""
    return any(known[0] == key for known in SESSION.world_images)


def _source_of(image: bpy.types.Image) -> tuple:
    """What the pixels depend on, as far as it is known without reading them."""
    path = bpy.path.abspath(image.filepath, library=image.library)
    try:
        written = os.stat(path).st_mtime_ns
    except OSError:
        written = None
    packed = image.packed_file.size if image.packed_file is not None else None
    return image.source, path, written, packed, tuple(image.size), image.colorspace_settings.name


def _compute(image: bpy.types.Image, projection: str) -> Any:  # noqa: ANN401
    if image.source not in ("FILE", "GENERATED"):
        return SkinError(f"its image '{image.name}' is a {image.source.lower()}, which is not supported")
    try:
        return core().Environment.from_image(linear_pixels(image, shown=True), projection=projection, bottom_first=True)
    except (SkinError, ValueError) as error:
        return SkinError(f"its image {error}" if isinstance(error, SkinError) else f"its image '{image.name}': {error}")
