# SPDX-License-Identifier: GPL-3.0-or-later
"""Draws the settings of a skin in the subpanels."""

import bpy

from ..read.measured_geometry import unit_mm
from ..skin_settings import TISSUE_SLIDERS
from ..thickness.thickness_attribute import no_far_side_text
from .wrapped_text import draw_wrapped


def draw_look(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """Mode, strength and the settings of the mode."""
    layout.row().prop(settings, "mode", expand=True)
    layout.use_property_split, layout.use_property_decorate = True, False
    layout.prop(settings, "strength")
    if settings.mode == "PAPER":
        layout.prop(settings, "base")
        if settings.base == "IMAGE":
            layout.template_ID(settings, "base_image", open="image.open")
        _draw_weights(layout, settings)
    if settings.mode == "PHYSICAL" or (settings.mode == "PAPER" and settings.base == "SKIN"):
        layout.prop(settings, "preset")
        column = layout.column(align=True)
        for name in TISSUE_SLIDERS:
            column.prop(settings, name, slider=True)


def _draw_weights(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """Numbers rather than a color swatch: the blood weight exceeds 1, which a swatch shows as white."""
    for name, parts in (("blood_weight", "RGB"), ("attenuation", ("Constant", "Linear", "Quadratic"))):
        column = layout.column(align=True)
        column.label(text=settings.bl_rna.properties[name].name)
        for i, part in enumerate(parts):
            column.prop(settings, name, index=i, text=part)


def draw_lookup(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """The size of the table and the reference point of distances."""
    layout.use_property_split, layout.use_property_decorate = True, False
    column = layout.column(align=True)
    column.prop(settings, "max_thickness_mm", text="Max Thickness (mm)")
    column.prop(settings, "size")
    if settings.mode != "EXISTING":
        layout.prop(settings, "reference")
        if settings.reference == "POINT":
            layout.prop(settings, "reference_point")


def draw_thickness(layout: bpy.types.UILayout, obj: bpy.types.Object, context: bpy.types.Context) -> None:
    """Settings for measuring thickness."""
    layout.use_property_split, layout.use_property_decorate = True, False
    column = layout.column(align=True)
    column.prop(obj.skinglow, "unit_mm", text="Unit (mm)")
    column.prop(obj.skinglow, "rays")
    column.prop(obj.skinglow, "min_openness", slider=True)
    across = max(obj.dimensions) * unit_mm(obj, context.scene)
    layout.label(text=f"{obj.name} is {across:.4g} mm across", icon="DRIVER_DISTANCE")
    if text := no_far_side_text(obj.data):
        draw_wrapped(layout.column(align=True), text, context, icon="ERROR")
    layout.operator("skinglow.bake", icon="DRIVER_DISTANCE")
