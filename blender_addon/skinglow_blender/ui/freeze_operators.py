# SPDX-License-Identifier: GPL-3.0-or-later
"""The buttons that freeze light to images, a frame at a time in a window, and give live light back."""

import bpy
from bpy.props import IntProperty, StringProperty

from ..commands.freezing import FOLDER, Freezing, Frozen, frozen_state, unfreeze
from ..errors import SkinError
from ..session import SESSION
from .light_list import redraw_panels
from .operators import may_act, selected_skins
from .status_text import end_progress, show_status

#: Seconds between two frames: enough for Blender to draw the progress.
INTERVAL = 0.01
#: What ends freezing with a message: the core's exceptions and those of files too.
FAULTS = (SkinError, ValueError, OSError)
#: Of the freezing that runs.
_timers: list[bpy.types.Timer] = []


class SKINGLOW_OT_freeze(bpy.types.Operator):  # noqa: N801  Blender's naming
    """Freezes the selected skins. Until it ends it takes all input: what is written has to be of one scene."""

    bl_idname = "skinglow.freeze"
    bl_label = "Freeze Light to Images"
    bl_description = (
        "Write what the selected skins show in each frame to images next to the file, which renders without Skinglow "
        "from then on: for farms. Esc cancels"
    )
    bl_options = {"REGISTER", "UNDO"}

    first: IntProperty(name="First Frame", options={"SKIP_SAVE"}, description="By default the scene's")
    last: IntProperty(name="Last Frame", options={"SKIP_SAVE"}, description="By default the scene's")
    directory: StringProperty(
        name="Folder", subtype="DIR_PATH", default=FOLDER, description="Where a folder for each skin is made"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        skins = selected_skins(context)
        if SESSION.measuring is not None:
            cls.poll_message_set("Thickness is being measured, Esc cancels")
            return False
        if skins and all(frozen_state(obj) for obj in skins):
            cls.poll_message_set("The selected skins are frozen already")
            return False
        return may_act(cls, context, found=bool(skins))

    def execute(self, context: bpy.types.Context) -> set[str]:
        freezing = None
        try:
            freezing = self._start(context)
            while freezing.step():
                pass
            self._report(freezing.finish())
        except FAULTS as error:
            return self._failed(freezing, error)
        except BaseException:
            # Such as Ctrl-C while a frame waits for its light.
            if freezing is not None:
                freezing.cancel()
            raise
        return {"FINISHED"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        try:
            SESSION.freezing = self._start(context)
        except FAULTS as error:
            return self._failed(None, error)
        _timers.append(context.window_manager.event_timer_add(INTERVAL, window=context.window))
        context.window_manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        freezing = SESSION.freezing
        if freezing is None:
            return {"CANCELLED"}
        try:
            if event.type == "ESC" and event.value == "PRESS":
                _end()
                freezing.cancel()
                self.report({"INFO"}, "Freezing was canceled, nothing was changed")
                return {"CANCELLED"}
            if event.type != "TIMER":
                return {"RUNNING_MODAL"}
            more = freezing.step()
            show_status(context, f"Freezing light: {freezing.done:.0%}      Esc: cancel")
            redraw_panels()
            if more:
                return {"RUNNING_MODAL"}
            frozen = freezing.finish()
        except FAULTS as error:
            _end()
            return self._failed(freezing, error)
        except BaseException:
            _end()
            freezing.cancel()
            raise
        _end()
        self._report(frozen)
        return {"FINISHED"}

    def cancel(self, _context: bpy.types.Context) -> None:
        """Called by Blender when a file is loaded or the window is closed."""
        stop_freezing()

    def _start(self, context: bpy.types.Context) -> Freezing:
        scene = context.scene
        first = self.first if self.properties.is_property_set("first") else scene.frame_start
        last = self.last if self.properties.is_property_set("last") else scene.frame_end
        self.first, self.last = first, last  # as Adjust Last Operation shows them
        skins = [obj for obj in selected_skins(context) if not frozen_state(obj)]
        return Freezing(skins, first, last, self.directory, scene)

    def _failed(self, freezing: Freezing | None, error: Exception) -> set[str]:
        if freezing is not None:
            freezing.cancel()
        self.report({"ERROR"}, str(error))
        return {"CANCELLED"}

    def _report(self, frozen: list[Frozen]) -> None:
        for each in frozen:
            names = ", ".join(each.skins)
            self.report({"INFO"}, f"{names}: frames {each.first} to {each.last} frozen to {each.folder}")


def stop_freezing() -> None:
    """Stops a running freezing, as when Blender quits or the add-on is disabled."""
    if SESSION.freezing is not None:
        SESSION.freezing.clear()
        _end()


def _end() -> None:
    SESSION.freezing = None
    end_progress(_timers)


class SKINGLOW_OT_unfreeze(bpy.types.Operator):  # noqa: N801
    """Makes frozen skins live again."""

    bl_idname = "skinglow.unfreeze"
    bl_label = "Unfreeze Light"
    bl_description = "Make the selected skins follow the lights again; the images are kept"
    bl_options = {"REGISTER", "UNDO"}

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        if context.mode != "OBJECT":
            cls.poll_message_set("Only available in Object Mode")
        elif not any(frozen_state(obj) for obj in selected_skins(context)):
            cls.poll_message_set("Select a frozen skin")
        else:
            return True
        return False

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self.report({"INFO"}, f"Live again: {', '.join(unfreeze(selected_skins(context)))}")
        except SkinError as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return {"FINISHED"}


CLASSES = (SKINGLOW_OT_freeze, SKINGLOW_OT_unfreeze)


def register() -> None:
    """Adds the operators."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Removes the operators."""
    stop_freezing()
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
