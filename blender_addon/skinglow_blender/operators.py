# SPDX-License-Identifier: GPL-3.0-or-later
"""What the panel's buttons do; each can be undone, and says in words what went wrong."""

from collections.abc import Callable

import bpy
from bpy.props import BoolProperty, StringProperty

from . import povray_export, skin, thickness_attribute
from .base_image import base_of_image
from .errors import SkinError
from .live_update import STATE


def _skins(context: bpy.types.Context) -> list[bpy.types.Object]:
    return [o for o in context.selected_objects if o.type == "MESH" and o.skinglow.enabled]


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


class SKINGLOW_OT_make(_SkinOperator, bpy.types.Operator):  # noqa: N801  Blender's naming
    bl_idname = "skinglow.make"
    bl_label = "Make Skin Glow"
    bl_description = "Measure the selected meshes' thickness and let the light of your lamps through, live"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "OBJECT" and any(o.type == "MESH" for o in context.selected_objects)

    def execute(self, context: bpy.types.Context) -> set[str]:
        meshes = [o for o in context.selected_objects if o.type == "MESH"]

        def make() -> str:
            states = [skin.make_skin(obj) for obj in meshes]
            return "; ".join(f"{s.name}: {s.thickness_mm[0]:.2f} to {s.thickness_mm[1]:.2f} mm thick" for s in states)

        return self.attempt(make)


class SKINGLOW_OT_remove(_SkinOperator, bpy.types.Operator):  # noqa: N801
    bl_idname = "skinglow.remove"
    bl_label = "Remove"
    bl_description = "Take away all that the add-on brought to the selected skins; their materials are as before"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return context.mode == "OBJECT" and bool(_skins(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        def remove() -> str:
            skins = _skins(context)
            for obj in skins:
                skin.remove_skin(obj)
            return f"{len(skins)} skins removed"

        return self.attempt(remove)


class SKINGLOW_OT_reset(_SkinOperator, bpy.types.Operator):  # noqa: N801
    bl_idname = "skinglow.reset"
    bl_label = "Reset"
    bl_description = "Set everything about the selected skins back to the defaults; the measured thickness stays"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return bool(_skins(context))

    def execute(self, context: bpy.types.Context) -> set[str]:
        def reset() -> str:
            for obj in _skins(context):
                skin.reset_settings(obj)
            return "Back to the defaults"

        return self.attempt(reset)


class SKINGLOW_OT_update(_SkinOperator, bpy.types.Operator):  # noqa: N801
    bl_idname = "skinglow.update"
    bl_label = "Update Now"
    bl_description = "Compute every skin afresh, also those that are not live; base lookup images are read again"

    def execute(self, context: bpy.types.Context) -> set[str]:
        def update() -> str:
            base_of_image.cache_clear()
            STATE.forget()
            return f"{len(skin.update(context.evaluated_depsgraph_get()))} skins computed"

        return self.attempt(update)


class SKINGLOW_OT_bake(_SkinOperator, bpy.types.Operator):  # noqa: N801
    bl_idname = "skinglow.bake"
    bl_label = "Measure Thickness"
    bl_description = "Measure the active skin's thickness again, mm; the pointer shows how far it is"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        obj = context.object
        return context.mode == "OBJECT" and obj is not None and obj.type == "MESH" and obj.skinglow.enabled

    def execute(self, context: bpy.types.Context) -> set[str]:
        manager = context.window_manager

        def show(done: float) -> bool:
            manager.progress_update(100.0 * done)
            return True

        def bake() -> str:
            manager.progress_begin(0.0, 100.0)
            try:
                geometry = thickness_attribute.read_geometry(context.object, context.scene)
                measured = thickness_attribute.measure(geometry, show)
                thickness_attribute.store(context.object, measured, geometry.unit_mm)
            finally:
                manager.progress_end()
            return f"{context.object.name}: {len(context.object.data.vertices)} vertices measured"

        return self.attempt(bake)


class SKINGLOW_OT_export_povray(_SkinOperator, bpy.types.Operator):  # noqa: N801
    bl_idname = "skinglow.export_povray"
    bl_label = "Export to POV-Ray"
    bl_description = "Write the scene's skins with camera, lamps and lookup as POV-Ray files into a folder"
    bl_options = {"REGISTER"}

    directory: StringProperty(subtype="DIR_PATH", description="Folder to write into")
    surface: BoolProperty(
        name="Surface", default=True, description="Also the surface; off: only the light coming through"
    )

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, context: bpy.types.Context) -> set[str]:
        def export() -> str:
            graph = context.evaluated_depsgraph_get()
            files = povray_export.export_povray(graph, bpy.path.abspath(self.directory), surface=self.surface)
            return f"{len(files)} files written to {self.directory}"

        return self.attempt(export)


CLASSES = (
    SKINGLOW_OT_make,
    SKINGLOW_OT_remove,
    SKINGLOW_OT_reset,
    SKINGLOW_OT_update,
    SKINGLOW_OT_bake,
    SKINGLOW_OT_export_povray,
)


def register() -> None:
    """Adds the operators."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Takes them away."""
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
