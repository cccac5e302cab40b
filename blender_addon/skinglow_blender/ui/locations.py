# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the panels are shown: each is a class in the sidebar of the 3D Viewport and one in the Object properties."""

import bpy


class Sidebar:
    """Attributes of a panel in the sidebar of the 3D Viewport."""

    bl_space_type = "VIEW_3D"
    bl_region_type = "UI"
    bl_category = "Skinglow"


class ObjectProperties:
    """Attributes of a panel in the Object properties."""

    bl_space_type = "PROPERTIES"
    bl_region_type = "WINDOW"
    bl_context = "object"


class InSidebar(Sidebar):
    """Attributes of a subpanel in the sidebar."""

    bl_parent_id = "SKINGLOW_PT_sidebar"


class InObjectProperties(ObjectProperties):
    """Attributes of a subpanel in the Object properties."""

    bl_parent_id = "SKINGLOW_PT_object"


def is_skin(obj: bpy.types.Object | None) -> bool:
    """Whether the object is a skin to show in the panels."""
    return obj is not None and obj.type == "MESH" and obj.skinglow.enabled


class SkinPanel:
    """A subpanel that is shown for skins only."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return is_skin(context.object)
