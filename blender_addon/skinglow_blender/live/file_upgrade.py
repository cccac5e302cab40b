# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings skins that an earlier version of the add-on saved up to date when their file is opened."""

import bpy

from ..show.frozen import add_frozen_nodes, is_frozen
from ..show.group_nodes import build_nodes, make_whole, nodes_of
from ..show.lut_image import GROUP_PROPERTY, GROUP_VERSION, skin_groups
from ..thickness.thickness_attribute import mark_known

#: The first version that stored where the thickness is known.
FIRST_WITH_KNOWN = 2


def upgrade() -> None:
    """Rebuilds the nodes of older groups, and stores with older thicknesses that they are known.

    What comes from a library stays as it was saved there, nodes and mesh alike.
    """
    old = [group for group in skin_groups() if group.library is None and group[GROUP_PROPERTY] < GROUP_VERSION]
    if not old:
        return
    if any(group[GROUP_PROPERTY] < FIRST_WITH_KNOWN for group in old):
        for mesh in bpy.data.meshes:
            mark_known(mesh)
    for obj in bpy.data.objects:
        if obj.library is None and obj.skinglow.enabled and obj.skinglow.group in old:
            _keep_settings(obj.skinglow)
    for group in old:
        build_nodes(group, nodes_of(group))
        if is_frozen(group):
            add_frozen_nodes(group)
        group[GROUP_PROPERTY] = GROUP_VERSION
        make_whole(group)


def _keep_settings(settings: bpy.types.PropertyGroup) -> None:
    """Stores what an earlier version had by default, or called by a name that there is no longer."""
    if not settings.is_property_set("mode"):
        settings.mode = "PAPER"
    if not settings.weights:  # Automatic, which was Per Pixel on every closed surface
        settings.weights = "SURFACE"
