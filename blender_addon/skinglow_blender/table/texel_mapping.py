# SPDX-License-Identifier: GPL-3.0-or-later
"""The mapping from the thickness attribute to texels, for the node group and for exports."""

import bpy

from ..read.measured_size import scale_since_measured
from ..read.scene_reading import Skin


def texels_per_mm(obj: bpy.types.Object, skin: Skin, texel_mapping: tuple[float, float]) -> float:
    """Entries of the lookup per millimeter of the attribute.

    texel_mapping  as skinglow.BaseLut.texel_mapping: for an image as wide as the table
    An object scaled since it was measured is thicker by the same factor.
    """
    return texel_mapping[0] * skin.base[1] * scale_since_measured(obj.data, skin.world_size)
