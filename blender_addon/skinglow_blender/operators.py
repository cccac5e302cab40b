# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel's buttons do; each can be undone, and says in words what went wrong."""

from collections.abc import Callable

import bpy
from bpy.props import BoolProperty, StringProperty

from . import povray_export, skin
from .base_image import base_of_image
from .errors import SkinError
from .live_update import STATE
from .lut_image import skin_groups


def selected_meshes(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected meshes, the active one first."""
    meshes = [obj for obj in context.selected_objects if obj.type == "MESH"]
    return sorted(meshes, key=lambda obj: obj != context.object)


def selected_skins(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected skins; the active one where none is selected, as after a click on a lamp of the list."""
    skins = [obj for obj in selected_meshes(context) if obj.skinglow.enabled]
    active = context.object
    if not skins and active is not None and active.type == "MESH" and active.skinglow.enabled:
        return [active]
    return skins


class _SkinOperator:
    """Turns what the add-on raises into a message of Blender's."""

    bl_options = {"REGISTER", "UNDO"}

    def attempt(self, action: Callable[[], str]) -> set[str]:
        try:
            self.report({"INFO"}, action())
        except (SkinError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


class _SelectedSkins(_SkinOperator):
    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Leave the mode you are in: works in object mode")
        elif not selected_skins(context):
            cls.poll_message_set("Select a skin, or make one with 'Make Skin Glow'")
        else:
            return True
        return False


class SKINGLOW_OT_remove(_SelectedSkins, bpy.types.Operator):  # noqa: N801  Blender's naming
    """Takes skins away."""

    bl_idname = "skinglow.remove"
    bl_label = "Remove Skin Glow"
    bl_description = "Take away all that the add-on brought to the selected skins; their materials are as before"

    def execute(self, context: bpy.types.Context) -> set[str]:
        def remove() -> str:
            names = [obj.name for obj in selected_skins(context)]
            for obj in selected_skins(context):
                skin.remove_skin(obj)
            return f"Skin glow removed from {', '.join(names)}"

        return self.attempt(remove)


class SKINGLOW_OT_reset(_SelectedSkins, bpy.types.Operator):  # noqa: N801
    """Sets skins back to the defaults."""

    bl_idname = "skinglow.reset"
    bl_label = "Reset Skin Glow"
    bl_description = "Set everything about the selected skins back to the defaults; the measured thickness stays"

    def execute(self, context: bpy.types.Context) -> set[str]:
        def reset() -> str:
            names = [obj.name for obj in selected_skins(context)]
            for obj in selected_skins(context):
                skin.reset_settings(obj)
            return f"{', '.join(names)}: back to the defaults"

        return self.attempt(reset)


class _AnySkin(_SkinOperator):
    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        if skin_groups():
            return True
        cls.poll_message_set("There is no skin in this file yet: select a mesh and press 'Make Skin Glow'")
        return False


class SKINGLOW_OT_update(_AnySkin, bpy.types.Operator):  # noqa: N801
    """Computes every skin afresh."""

    bl_idname = "skinglow.update"
    bl_label = "Update Skin Glow Now"
    bl_description = "Compute every skin afresh, also those that are not live; base lookup images are read again"

    def execute(self, context: bpy.types.Context) -> set[str]:
        def update() -> str:
            base_of_image.cache_clear()
            STATE.forget()
            names = [rebuilt.skin for rebuilt in skin.update(context.evaluated_depsgraph_get())]
            return f"Computed afresh: {', '.join(names) or 'nothing, as this view layer shows no skin'}"

        return self.attempt(update)


class SKINGLOW_OT_export_povray(_AnySkin, bpy.types.Operator):  # noqa: N801
    """Writes POV-Ray scenes. There is nothing to undo: it changes no data of Blender's."""

    bl_idname = "skinglow.export_povray"
    bl_label = "Export Skin Glow to POV-Ray"
    bl_description = "Write the scene's skins with camera, lamps and lookup as POV-Ray 3.7 files into a folder"
    bl_options = {"REGISTER"}

    directory: StringProperty(subtype="DIR_PATH", description="Folder to write into")
    filter_folder: BoolProperty(default=True, options={"HIDDEN"})
    surface: BoolProperty(
        name="Surface", default=True, description="Also the surface; off: only the light coming through"
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        def export() -> str:
            if not self.directory:
                raise SkinError("No folder is given to write the POV-Ray files into: choose one")
            graph = context.evaluated_depsgraph_get()
            files = povray_export.export_povray(graph, bpy.path.abspath(self.directory), surface=self.surface)
            return f"{len(files)} files written to {self.directory}"

        return self.attempt(export)


class SKINGLOW_OT_select_light(_SkinOperator, bpy.types.Operator):  # noqa: N801
    """From a line of the list to the lamp in the scene; the skin stays active, and so the list in sight."""

    bl_idname = "skinglow.select_light"
    bl_label = "Select Light of Skin"
    bl_description = "Select this lamp in the scene; the skin stays the active object, so that this list stays"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    light: StringProperty(name="Light", description="Name of the lamp, or '<lamp> in <what instances it>'")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode == "OBJECT":
            return True
        cls.poll_message_set("Leave the mode you are in: works in object mode")
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        def select() -> str:
            objects = context.view_layer.objects
            # An instanced lamp has no place of its own to be selected at: what instances it has.
            lamp = objects.get(self.light) or objects.get(self.light.rpartition(" in ")[2])
            if lamp is None:
                raise SkinError(f"'{self.light}' is not in this view layer: include its collection to select it")
            if lamp.hide_select or not lamp.visible_get():
                raise SkinError(f"'{lamp.name}' is hidden or cannot be selected: show it in the outliner first")
            for obj in context.selected_objects:
                obj.select_set(False)
            lamp.select_set(True)
            return f"{lamp.name} selected"

        return self.attempt(select)


CLASSES = (
    SKINGLOW_OT_remove,
    SKINGLOW_OT_reset,
    SKINGLOW_OT_update,
    SKINGLOW_OT_export_povray,
    SKINGLOW_OT_select_light,
)


def register() -> None:
    """Adds the operators."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Takes them away."""
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
