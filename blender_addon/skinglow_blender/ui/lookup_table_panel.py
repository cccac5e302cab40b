# SPDX-License-Identifier: GPL-3.0-or-later
"""The Lookup Table panel: the size of the table and the point from which distances to lights are measured."""

import bpy

from .locations import InObjectProperties, InSidebar, SkinPanel


class _LookupTable(SkinPanel):
    bl_label = "Lookup Table"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout, settings = self.layout, context.object.skinglow
        layout.use_property_split, layout.use_property_decorate = True, True
        column = layout.column(align=True)
        column.prop(settings, "max_thickness_mm")
        column.prop(settings, "size")
        if settings.mode != "EXISTING":
            layout.prop(settings, "reference")
            if settings.reference == "POINT":
                layout.prop(settings, "reference_point")
            elif settings.reference == "OBJECT":
                layout.prop(settings, "reference_object")
                reference = settings.reference_object
                if reference is not None and reference.type == "ARMATURE":
                    layout.prop_search(settings, "reference_bone", reference.data, "bones")


class SKINGLOW_PT_sidebar_lookup(_LookupTable, InSidebar, bpy.types.Panel):  # noqa: N801  Blender's naming
    """In the sidebar."""


class SKINGLOW_PT_object_lookup(_LookupTable, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


CLASSES = (SKINGLOW_PT_sidebar_lookup, SKINGLOW_PT_object_lookup)
