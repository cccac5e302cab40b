# SPDX-License-Identifier: GPL-3.0-or-later
"""Esc while a render waits for light through the shape of a skin."""

import bpy

from ..session import SESSION

INTERVAL = 0.2


class SKINGLOW_OT_watch_for_escape(bpy.types.Operator):  # noqa: N801
    """Ends what a render waits for when Esc is pressed, by which Blender cancels the render."""

    bl_idname = "skinglow.watch_for_escape"
    bl_label = "Watch for Esc"
    bl_options = {"INTERNAL"}

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        """Watches in the window of the context."""
        windows = context.window_manager
        self._timer = windows.event_timer_add(INTERVAL, window=context.window)
        windows.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        """Passes all events on."""
        if event.type == "ESC" and event.value == "PRESS":
            SESSION.interrupted = True
        if not SESSION.waiting or SESSION.interrupted:
            context.window_manager.event_timer_remove(self._timer)
            return {"FINISHED", "PASS_THROUGH"}
        return {"PASS_THROUGH"}


CLASSES = (SKINGLOW_OT_watch_for_escape,)


def register() -> None:
    """Registers the operator."""
    bpy.utils.register_class(SKINGLOW_OT_watch_for_escape)


def unregister() -> None:
    """Removes it."""
    bpy.utils.unregister_class(SKINGLOW_OT_watch_for_escape)
