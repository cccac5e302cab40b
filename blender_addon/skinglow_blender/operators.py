# SPDX-License-Identifier: GPL-3.0-or-later
"""What the buttons do: the functions of skin.py and povray_export.py, with undo, progress and errors in words."""

from collections.abc import Callable
from typing import Any

import bpy

from . import povray_export, skin
from .errors import SkinError

UNDOABLE = {"REGISTER", "UNDO"}


def _in_words(operator: bpy.types.Operator, work: Callable[[], Any]) -> set[str]:
    """Runs the work; what a user can mend is said in the status bar, and nothing was changed."""
    try:
        work()
    except (SkinError, ValueError) as error:
        operator.report({"ERROR"}, str(error))
        return {"CANCELLED"}
    return {"FINISHED"}


class SkinOperator(bpy.types.Operator):
    """Base of those that work on the active object."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.object is not None and context.object.type == "MESH" and context.object.skinglow.enabled


class SKINGLOW_OT_make_skin(bpy.types.Operator):
    bl_idname = "skinglow.make_skin"
    bl_label = "Make It Glow"
    bl_description = "Measure the thickness of the selected meshes and add the light coming through to their materials"
    bl_options = UNDOABLE

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return any(obj.type == "MESH" for obj in context.selected_objects)

    def execute(self, context: bpy.types.Context) -> set[str]:
        manager = context.window_manager
        meshes = [obj for obj in context.selected_objects if obj.type == "MESH"]
        manager.progress_begin(0, len(meshes))
        try:
            for done, obj in enumerate(meshes):
                manager.progress_update(done)
                if _in_words(self, lambda obj=obj: skin.make_skin(obj)) == {"CANCELLED"}:
                    return {"CANCELLED"}
        finally:
            manager.progress_end()
        return {"FINISHED"}


class SKINGLOW_OT_update(SkinOperator):
    bl_idname = "skinglow.update"
    bl_label = "Update Now"
    bl_description = (
        "Measure the mesh if it changed and compute the lookup for the lights as they are now, also where Live is off"
    )

    def execute(self, context: bpy.types.Context) -> set[str]:
        return _in_words(self, lambda: skin.make_skin(context.object))


class SKINGLOW_OT_remove(SkinOperator):
    bl_idname = "skinglow.remove"
    bl_label = "Remove"
    bl_description = "Take the glow, its node, its images and the thickness away again"
    bl_options = UNDOABLE

    def execute(self, context: bpy.types.Context) -> set[str]:
        return _in_words(self, lambda: skin.remove_skin(context.object))


class SKINGLOW_OT_export_povray(SkinOperator):
    bl_idname = "skinglow.export_povray"
    bl_label = "Export to POV-Ray"
    bl_description = "Write the skin, its lights and its lookup as a POV-Ray 3.7 scene into a folder"

    directory: bpy.props.StringProperty(subtype="DIR_PATH", description="Folder to write to")

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        depsgraph = context.evaluated_depsgraph_get()
        folder = bpy.path.abspath(self.directory)
        return _in_words(self, lambda: povray_export.export_povray(depsgraph, folder, context.object))


CLASSES = (
    SKINGLOW_OT_make_skin,
    SKINGLOW_OT_update,
    SKINGLOW_OT_remove,
    SKINGLOW_OT_export_povray,
)


def register() -> None:
    for cls in CLASSES:
        bpy.utils.register_class(cls)


def unregister() -> None:
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
