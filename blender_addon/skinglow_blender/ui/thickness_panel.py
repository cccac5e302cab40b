# SPDX-License-Identifier: GPL-3.0-or-later
"""The Thickness panel: how thickness is measured, and what was measured."""

import bpy

from ..read.measured_geometry import unit_mm
from ..read.measured_size import scale_since_measured
from ..thickness.thickness_attribute import SUMMARY, no_far_side_text
from .locations import InObjectProperties, InSidebar, ObjectProperties, Sidebar, SkinPanel
from .thickness_preview import histogram_icon
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
    _draw_numbers(layout, obj)
    row = layout.row()
    row.use_property_split = False
    row.prop(context.window_manager, "skinglow_heat_map", toggle=True, icon="SHADING_RENDERED")


def _draw_numbers(layout: bpy.types.UILayout, obj: bpy.types.Object) -> None:
    """Min, median and max as they are now, and the histogram as it was when the thickness was stored."""
    summary = obj.data.get(SUMMARY)
    if summary is None:
        return
    limit, low, median, high, above = tuple(summary)[:5]
    grown = scale_since_measured(obj.data, abs(obj.matrix_world.to_3x3().determinant()) ** (1.0 / 3.0))
    row = layout.row()
    icon = histogram_icon(obj.data)
    if icon:
        row.template_icon(icon_value=icon, scale=3.0)
    column = row.column(align=True)
    for name, value in (("Min", low), ("Median", median), ("Max", high)):
        line = column.row()
        line.label(text=name)
        line.label(text=f"{value * grown:.3g} mm")
    layout.label(text=f"0 to {limit * grown:.3g} mm, {above:.0%} thicker")


class _ThicknessImage(SkinPanel):
    bl_label = "Thickness Image"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        layout = self.layout
        layout.operator_menu_enum("skinglow.bake_thickness", "format", text="Bake to Image", icon="RENDER_STILL")
        settings = context.object.skinglow
        layout.template_ID(settings, "thickness_image", open="image.open")
        layout.operator("skinglow.thickness_from_image", icon="IMPORT")


class SKINGLOW_PT_sidebar_thickness_image(_ThicknessImage, Sidebar, bpy.types.Panel):  # noqa: N801
    """In the sidebar."""

    bl_parent_id = "SKINGLOW_PT_sidebar_thickness"


class SKINGLOW_PT_object_thickness_image(_ThicknessImage, ObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""

    bl_parent_id = "SKINGLOW_PT_object_thickness"


CLASSES = (
    SKINGLOW_PT_sidebar_thickness,
    SKINGLOW_PT_object_thickness,
    SKINGLOW_PT_sidebar_thickness_image,
    SKINGLOW_PT_object_thickness_image,
)
