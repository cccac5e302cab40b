# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators of the panel; each supports undo and reports errors as messages."""

from collections.abc import Callable, Iterable

import bpy
from bpy.props import StringProperty

from ..commands import skin
from ..commands.health import health, repair
from ..errors import SkinError
from ..identity import key_of
from ..session import SESSION
from ..show.lut_image import skin_groups

#: What a gray button on skins asks for.
SKIN = "Select a skin, or create one with Make Skin Glow"


def selected_meshes(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected meshes, the active one first."""
    meshes = [obj for obj in context.selected_objects if obj.type == "MESH"]
    return sorted(meshes, key=lambda obj: obj != context.object)


def selected_skins(context: bpy.types.Context) -> list[bpy.types.Object]:
    """The selected skins; the active one if none is selected, as after selecting a light in the list."""
    skins = [obj for obj in selected_meshes(context) if obj.skinglow.enabled]
    active = context.object
    if not skins and active is not None and active.type == "MESH" and active.skinglow.enabled:
        return [active]
    return skins


class _SkinOperator:
    """Reports the add-on's exceptions as Blender messages."""

    bl_options = {"REGISTER", "UNDO"}

    def attempt(self, action: Callable[[], str]) -> set[str]:
        try:
            self.report({"INFO"}, action())
        except (SkinError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


def may_act(operator: type, context: bpy.types.Context, *, found: bool, what: str = SKIN) -> bool:
    """The poll of an operator on what is selected: says why its button is gray.

    found, what  whether there is something to act on, and what to do if not
    """
    if SESSION.freezing is not None:
        operator.poll_message_set("Light is being frozen, Esc cancels")
    elif context.mode != "OBJECT":
        operator.poll_message_set("Only available in Object Mode")
    elif not found:
        operator.poll_message_set(what)
    else:
        return True
    return False


class SelectedSkinsOperator(_SkinOperator):
    """Acts on the selected skins."""

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return may_act(cls, context, found=bool(selected_skins(context)))


def check_kept(objects: Iterable[bpy.types.Object]) -> None:
    """Raises SkinError for an object of a library: Blender reads it again with the file, without what was set."""
    for obj in objects:
        if obj.library is not None:
            raise SkinError(
                f"'{obj.name}' belongs to {obj.library.filepath}, and changes here would be lost: change it there, or "
                "override it first (Object > Library Override > Make)"
            )


class _EachSelectedSkin(SelectedSkinsOperator):
    """Does the same to each selected skin."""

    #: What was done, before their names.
    done = ""

    def act(self, obj: bpy.types.Object) -> None:
        """Acts on one skin."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        def act_on_all() -> str:
            skins = selected_skins(context)
            check_kept(skins)
            for obj in skins:
                self.act(obj)
            return f"{self.done} {', '.join(obj.name for obj in skins)}"

        return self.attempt(act_on_all)


class SKINGLOW_OT_remove(_EachSelectedSkin, bpy.types.Operator):  # noqa: N801  Blender's naming
    """Removes skins."""

    bl_idname = "skinglow.remove"
    bl_label = "Remove Skin Glow"
    bl_description = "Remove Skinglow from the selected objects and restore their materials"

    done = "Skin glow removed from"

    def act(self, obj: bpy.types.Object) -> None:
        skin.remove_skin(obj)


class SKINGLOW_OT_repair(SelectedSkinsOperator, bpy.types.Operator):  # noqa: N801
    """Repairs what the panel says is wrong."""

    bl_idname = "skinglow.repair"
    bl_label = "Repair Skin Glow"
    bl_description = "Restore deleted nodes and images, and measure the thickness where it is out of date or not known"

    def execute(self, context: bpy.types.Context) -> set[str]:
        def repair_all() -> str:
            skins = selected_skins(context)
            for obj in skins:
                repair(obj)
            left = [f"'{obj.name}': {fault}" for obj in skins for fault in health(obj) if not fault.is_hint]
            if left:
                raise SkinError("; ".join(left))
            return f"{', '.join(obj.name for obj in skins)}: all is well"

        return self.attempt(repair_all)


class SKINGLOW_OT_reset(_EachSelectedSkin, bpy.types.Operator):  # noqa: N801
    """Resets skins to the defaults."""

    bl_idname = "skinglow.reset"
    bl_label = "Reset Skin Glow"
    bl_description = "Reset the settings of the selected skins to their defaults; the thickness and its unit are kept"

    done = "Reset to defaults:"

    def act(self, obj: bpy.types.Object) -> None:
        skin.reset_settings(obj)


class AnySkinOperator(_SkinOperator):
    """Acts on all skins of the file."""

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        if skin_groups():
            return True
        cls.poll_message_set("This file has no skin yet: select a mesh and use Make Skin Glow")
        return False


class SKINGLOW_OT_update(AnySkinOperator, bpy.types.Operator):  # noqa: N801
    """Recomputes all skins."""

    bl_idname = "skinglow.update"
    bl_label = "Update Skin Glow"
    bl_description = "Recompute all skins, including those that are not live, and reload base lookup images"

    def execute(self, context: bpy.types.Context) -> set[str]:
        def update() -> str:
            SESSION.forget_tables()
            names = [rebuilt.skin for rebuilt in skin.update(context.evaluated_depsgraph_get())]
            return f"Recomputed: {', '.join(names) or 'nothing, as this view layer has no skin'}"

        return self.attempt(update)


class SKINGLOW_OT_select_light(_SkinOperator, bpy.types.Operator):  # noqa: N801
    """Selects the light of a row in the list; the skin stays active, so that the list stays visible."""

    bl_idname = "skinglow.select_light"
    bl_label = "Select Light"
    bl_description = "Select this light in the scene and keep the skin as the active object"
    bl_options = {"REGISTER", "UNDO", "INTERNAL"}

    light: StringProperty(name="Light", description="Name of the light")
    key: StringProperty(name="Key", description="Which object to select; empty: the one of that name")

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode == "OBJECT":
            return True
        cls.poll_message_set("Only available in Object Mode")
        return False

    def _is_meant(self, obj: bpy.types.Object) -> bool:
        return key_of(obj) == self.key if self.key else obj.name == self.light

    def execute(self, context: bpy.types.Context) -> set[str]:
        def select() -> str:
            light = next((obj for obj in context.view_layer.objects if self._is_meant(obj)), None)
            if light is None:
                raise SkinError(f"'{self.light}' is not in this view layer: enable its collection to select it")
            if light.hide_select or not light.visible_get():
                raise SkinError(f"'{light.name}' is hidden or not selectable: enable that in the Outliner first")
            for obj in context.selected_objects:
                obj.select_set(False)
            light.select_set(True)
            return f"{light.name} selected"

        return self.attempt(select)


class SKINGLOW_OT_select_faulty(_SkinOperator, bpy.types.Operator):  # noqa: N801
    """Goes to a skin with which something was wrong in the last update."""

    bl_idname = "skinglow.select_faulty"
    bl_label = "Select Skin with a Fault"
    bl_description = "Make another skin active that could not be updated; its panel says why"

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return may_act(cls, context, found=bool(SESSION.told().keys() - {"*"}), what="No skin has a fault")

    def execute(self, context: bpy.types.Context) -> set[str]:
        def select() -> str:
            others = [obj for obj in context.view_layer.objects if obj != context.object and obj.visible_get()]
            found = next((obj for obj in others if key_of(obj) in SESSION.told()), None)
            if found is None:
                raise SkinError("The skins with faults are hidden, or not in this view layer")
            for obj in context.selected_objects:
                obj.select_set(False)
            found.select_set(True)
            context.view_layer.objects.active = found
            return SESSION.told()[key_of(found)]

        return self.attempt(select)


CLASSES = (
    SKINGLOW_OT_remove,
    SKINGLOW_OT_repair,
    SKINGLOW_OT_reset,
    SKINGLOW_OT_update,
    SKINGLOW_OT_select_light,
    SKINGLOW_OT_select_faulty,
)


def register() -> None:
    """Adds the operators."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Removes the operators."""
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
