# SPDX-License-Identifier: GPL-3.0-or-later
"""The Lookup Table panel: the size of the table and the point from which distances to lights are measured."""

import bpy

from .locations import InObjectProperties, InSidebar, SkinPanel


class _LookupTable(SkinPanel):
    bl_label = "Lookup Table"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.object.skinglow
        layout.use_property_split, layout.use_property_decorate = True, False
        column = layout.column(align=True)
        column.prop(settings, "max_thickness_mm", text="Max Thickness (mm)")
        column.prop(settings, "size")
        if settings.mode != "EXISTING":
            layout.prop(settings, "reference")
            if settings.reference == "POINT":
                layout.prop(settings, "reference_point")


class SKINGLOW_PT_sidebar_lookup(_LookupTable, InSidebar, bpy.types.Panel):  # noqa: N801  Blender's naming
    """In the sidebar."""


class SKINGLOW_PT_object_lookup(_LookupTable, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


CLASSES = (SKINGLOW_PT_sidebar_lookup, SKINGLOW_PT_object_lookup)
