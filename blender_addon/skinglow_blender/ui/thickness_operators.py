# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons that bake thickness to an image, and take it from one."""

import bpy
from bpy.props import EnumProperty, FloatProperty, IntProperty

from ..commands.thickness_map import EVERY_TEXEL, bake_thickness, thickness_from_image
from ..errors import SkinError
from .locations import is_skin
from .operators import may_act

ITEMS = (
    ("EXR", "Float EXR", "Thickness in mm"),
    ("PNG_16", "16-Bit PNG", "Fractions of the thickness of white"),
    ("PNG_8", "8-Bit PNG", "Fractions of the thickness of white"),
)


class _OnSkin:
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return may_act(cls, context, found=is_skin(context.object))


class SKINGLOW_OT_bake_thickness(_OnSkin, bpy.types.Operator):  # noqa: N801  Blender's naming
    """Bakes the thickness of the active skin."""

    bl_idname = "skinglow.bake_thickness"
    bl_label = "Bake Thickness to Image"
    bl_description = "Write the thickness of the active skin to an image in its UV map, next to the file"

    format: EnumProperty(name="Format", items=ITEMS, default="EXR")
    size: IntProperty(
        name="Size", default=1024, min=16, max=EVERY_TEXEL, subtype="PIXEL", description="Width and height of the image"
    )
    white_mm: FloatProperty(
        name="White",
        subtype="DISTANCE_CAMERA",
        default=0.0,
        min=0.0,
        soft_max=100.0,
        description="Thickness of white in PNG files, mm; 0 uses the thickness at the end of the lookup",
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.object
        try:
            baked = bake_thickness(obj, None, self.size, self.format, self.white_mm or None)
        except (SkinError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        obj.skinglow.thickness_image = baked.image
        white = "values are mm" if self.format == "EXR" else f"white is {baked.white_mm:.4g} mm"
        self.report({"INFO"}, f"{baked.file}: {white}, {baked.covered_fraction:.0%} of the image is covered")
        return {"FINISHED"}


class SKINGLOW_OT_thickness_from_image(_OnSkin, bpy.types.Operator):  # noqa: N801
    """Takes the thickness of the active skin from an image."""

    bl_idname = "skinglow.thickness_from_image"
    bl_label = "Thickness from Image"
    bl_description = "Take the thickness of the active skin from the chosen image, at each vertex"

    white_mm: FloatProperty(
        name="White",
        subtype="DISTANCE_CAMERA",
        default=0.0,
        min=0.0,
        soft_max=100.0,
        description="Thickness of the value 1 in the image, mm; 0 uses what it was baked with, or 1, as values are mm",
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if not super().poll(context):
            return False
        if context.object.skinglow.thickness_image is None:
            cls.poll_message_set("Choose an image first")
            return False
        return True

    def execute(self, context: bpy.types.Context) -> set[str]:
        obj = context.object
        try:
            thickness_from_image(obj, obj.skinglow.thickness_image, self.white_mm or None)
        except (SkinError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        self.report({"INFO"}, f"{obj.name}: thickness from '{obj.skinglow.thickness_image.name}'")
        return {"FINISHED"}


CLASSES = (SKINGLOW_OT_bake_thickness, SKINGLOW_OT_thickness_from_image)


def register() -> None:
    """Adds the operators."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Removes the operators."""
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
