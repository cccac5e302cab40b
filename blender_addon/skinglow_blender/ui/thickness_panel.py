# SPDX-License-Identifier: GPL-3.0-or-later
"""The Thickness panel: how thickness is measured, and what was measured."""

import bpy

from ..read.measured_geometry import unit_mm
from ..thickness.thickness_attribute import no_far_side_text
from .locations import InObjectProperties, InSidebar, SkinPanel
from .wrapped_text import draw_wrapped


class _Thickness(SkinPanel):
    bl_label = "Thickness"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        draw_thickness(self.layout, context.object, context)


class SKINGLOW_PT_sidebar_thickness(_Thickness, InSidebar, bpy.types.Panel):  # noqa: N801  Blender's naming
    """In the sidebar."""


class SKINGLOW_PT_object_thickness(_Thickness, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


def draw_thickness(layout: bpy.types.UILayout, obj: bpy.types.Object, context: bpy.types.Context) -> None:
    """Settings for measuring thickness."""
    layout.use_property_split, layout.use_property_decorate = True, False
    column = layout.column(align=True)
    column.prop(obj.skinglow, "unit_mm", text="Unit")
    column.prop(obj.skinglow, "rays")
    column.prop(obj.skinglow, "min_openness", slider=True)
    across = max(obj.dimensions) * unit_mm(obj, context.scene)
    layout.label(text=f"{obj.name} is {across:.4g} mm across", icon="DRIVER_DISTANCE")
    if text := no_far_side_text(obj.data):
        draw_wrapped(layout.column(align=True), text, context, icon="ERROR")
    layout.operator("skinglow.measure_thickness", icon="DRIVER_DISTANCE")


CLASSES = (SKINGLOW_PT_sidebar_thickness, SKINGLOW_PT_object_thickness)
