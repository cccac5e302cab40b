# SPDX-License-Identifier: GPL-3.0-or-later
"""The menu of skins: the core's presets, and the user's own, which + and - add and remove as everywhere in Blender."""

import bpy
from bl_operators.presets import AddPresetBase
from bpy.props import EnumProperty

from ..errors import SkinError
from ..tissue_presets import PRESETS, TISSUE_SLIDERS
from .locations import is_skin
from .operators import check_kept


class SKINGLOW_OT_apply_preset(bpy.types.Operator):  # noqa: N801  Blender's naming
    """Sets the sliders of the active skin to those of a preset."""

    bl_idname = "skinglow.apply_preset"
    bl_label = "Apply Skin Preset"
    bl_description = "Set the skin to this preset"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    preset: EnumProperty(name="Preset", items=PRESETS[1:])

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return is_skin(context.object)

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            check_kept([context.object])
        except SkinError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        context.object.skinglow.preset = self.preset
        return {"FINISHED"}


class SKINGLOW_MT_skin_presets(bpy.types.Menu):  # noqa: N801
    """The presets of the core, then those that the user saved."""

    bl_idname = "SKINGLOW_MT_skin_presets"
    bl_label = "Skin Presets"
    preset_subdir = "skinglow/skin"
    preset_operator = "script.execute_preset"

    def draw(self, context: bpy.types.Context) -> None:
        for name, label, _description in PRESETS[1:]:
            self.layout.operator(SKINGLOW_OT_apply_preset.bl_idname, text=label).preset = name
        self.layout.separator()
        bpy.types.Menu.draw_preset(self, context)


class SKINGLOW_OT_add_skin_preset(AddPresetBase, bpy.types.Operator):  # noqa: N801
    """Saves the sliders as a preset of the user, or removes one."""

    bl_idname = "skinglow.add_skin_preset"
    bl_label = "Add Skin Preset"
    bl_description = "Save this skin as a preset, or remove the saved preset that the menu names"
    preset_menu = SKINGLOW_MT_skin_presets.bl_idname
    preset_subdir = SKINGLOW_MT_skin_presets.preset_subdir
    preset_defines = ("skin = bpy.context.object.skinglow",)
    preset_values = tuple(f"skin.{slider}" for slider in TISSUE_SLIDERS)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return is_skin(context.object)

    def execute(self, context: bpy.types.Context) -> set[str]:
        # Blender removes the saved one that was chosen last, whatever the menu names now.
        if self.remove_active and (label := _core_preset(context.object.skinglow)):
            self.report({"ERROR"}, f"'{label}' comes with Skinglow and cannot be removed")
            return {"CANCELLED"}
        return super().execute(context)


def _core_preset(settings: bpy.types.PropertyGroup) -> str:
    """The name of the core's preset that the sliders show, or ""."""
    number = settings.bl_rna.properties["preset"].enum_items.find(settings.preset)
    return PRESETS[number][1] if settings.preset != "CUSTOM" else ""


def draw_presets(layout: bpy.types.UILayout, settings: bpy.types.PropertyGroup) -> None:
    """The menu, named after the preset that the sliders show, and + and -."""
    row = layout.row(align=True)
    of_core = _core_preset(settings)
    row.menu(SKINGLOW_MT_skin_presets.bl_idname, text=of_core or SKINGLOW_MT_skin_presets.bl_label)
    row.operator(SKINGLOW_OT_add_skin_preset.bl_idname, text="", icon="ADD")
    remove = row.row(align=True)
    remove.enabled = not of_core
    remove.operator(SKINGLOW_OT_add_skin_preset.bl_idname, text="", icon="REMOVE").remove_active = True


CLASSES = (SKINGLOW_OT_apply_preset, SKINGLOW_MT_skin_presets, SKINGLOW_OT_add_skin_preset)


def register() -> None:
    """Adds the menu and its operators."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Removes them; saved presets stay in the user's folder."""
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
