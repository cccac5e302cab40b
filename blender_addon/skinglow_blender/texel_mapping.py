# SPDX-License-Identifier: GPL-3.0-or-later
"""How a thickness attribute finds its texel, for the node group and for exports alike."""

import bpy

from .scene_reading import Skin
from .thickness_attribute import MEASURED_SIZE


def texels_per_mm(obj: bpy.types.Object, skin: Skin, texel_mapping: tuple[float, float]) -> float:
    """Entries of the lookup for a millimetre of the attribute.

    texel_mapping  as skinglow.BaseLut.texel_mapping: for an image as wide as the table
    An object scaled since it was measured has grown thicker by as much.
    """
    measured = obj.data.get(MEASURED_SIZE, skin.world_size)
    grown = skin.world_size / measured if measured > 0.0 else 1.0
    return texel_mapping[0] * skin.base[1] * grown
