# SPDX-License-Identifier: GPL-3.0-or-later
"""The Look panel: the skin itself, and below it, closed, the paper's methods for reference."""

import bpy

from ..tissue_presets import TISSUE_SLIDERS
from .locations import InObjectProperties, InSidebar, SkinPanel
from .presets import draw_presets


class _Look(SkinPanel):
    bl_label = "Look"

    def draw(self, context: bpy.types.Context) -> None:
        draw_look(self.layout, context.object.skinglow)


class SKINGLOW_PT_sidebar_look(_Look, InSidebar, bpy.types.Panel):  # noqa: N801  Blender's naming
    """In the sidebar."""


class SKINGLOW_PT_object_look(_Look, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""


class _ReferenceMethods(SkinPanel):
    bl_label = "Reference Methods"
    bl_options = {"DEFAULT_CLOSED"}

    def draw(self, context: bpy.types.Context) -> None:
        draw_reference_methods(self.layout, context.object.skinglow)


class SKINGLOW_PT_sidebar_reference(_ReferenceMethods, InSidebar, bpy.types.Panel):  # noqa: N801
    """In the sidebar."""

    bl_parent_id = "SKINGLOW_PT_sidebar_look"


class SKINGLOW_PT_object_reference(_ReferenceMethods, InObjectProperties, bpy.types.Panel):  # noqa: N801
    """In the Object properties."""

    bl_parent_id = "SKINGLOW_PT_object_look"


def draw_look(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """Mode, strength and the skin of the mode."""
    layout.use_property_split, layout.use_property_decorate = True, True
    layout.prop(settings, "mode")
    layout.prop(settings, "strength")
    if settings.mode == "PHYSICAL" or (settings.mode == "PAPER" and settings.base == "SKIN"):
        draw_presets(layout, settings)
        column = layout.column(align=True)
        for name in TISSUE_SLIDERS:
            column.prop(settings, name)


def draw_reference_methods(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """The two methods that Physical is compared with, and the settings of Tinted."""
    row = layout.row(align=True)
    row.prop_enum(settings, "mode", "EXISTING")
    row.prop_enum(settings, "mode", "PAPER")
    if settings.mode != "PAPER":
        return
    layout.use_property_split, layout.use_property_decorate = True, True
    layout.prop(settings, "base")
    if settings.base == "IMAGE":
        layout.template_ID(settings, "base_image", open="image.open")
    # Numbers rather than a color swatch: the blood weight exceeds 1, which a swatch shows as white.
    for name, parts in (("blood_weight", "RGB"), ("attenuation", ("Constant", "Linear", "Quadratic"))):
        column = layout.column(align=True)
        for i, part in enumerate(parts):
            label = f"{settings.bl_rna.properties[name].name} {part}" if i == 0 else part
            column.prop(settings, name, index=i, text=label)


CLASSES = (
    SKINGLOW_PT_sidebar_look,
    SKINGLOW_PT_object_look,
    SKINGLOW_PT_sidebar_reference,
    SKINGLOW_PT_object_reference,
)
