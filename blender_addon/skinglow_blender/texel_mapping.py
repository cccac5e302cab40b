# SPDX-License-Identifier: GPL-3.0-or-later
"""How a thickness attribute finds its texel, for the node group and for exports alike."""

import bpy

from .scene_reading import Skin, grown


def texels_per_mm(obj: bpy.types.Object, skin: Skin, texel_mapping: tuple[float, float]) -> float:
    """Entries of the lookup for a millimeter of the attribute.

    texel_mapping  as skinglow.BaseLut.texel_mapping: for an image as wide as the table
    An object scaled since it was measured has grown thicker by as much.
    """
    return texel_mapping[0] * skin.base[1] * grown(obj.data, skin.world_size)
