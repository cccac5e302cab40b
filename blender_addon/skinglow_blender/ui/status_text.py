# SPDX-License-Identifier: GPL-3.0-or-later
"""What the status bar says while something runs. Blender keeps it by workspace, and users go to another meanwhile."""

import bpy

from .light_list import redraw_panels

#: Names of the workspaces that show it.
_shown_in: set[str] = set()


def show_status(context: bpy.types.Context, text: str) -> None:
    """Shows a text in the workspace of the context alone."""
    if context.workspace is None:
        return
    here = context.workspace.name
    for name in _shown_in - {here}:
        _clear(name)
    _shown_in.add(here)
    context.workspace.status_text_set(text)


def end_progress(timers: list[bpy.types.Timer]) -> None:
    """Gives the status bar back to Blender, and ends the timers of what ran; the list is empty then."""
    while timers:
        bpy.context.window_manager.event_timer_remove(timers.pop())
    for name in list(_shown_in):
        _clear(name)
    redraw_panels()


def _clear(name: str) -> None:
    _shown_in.discard(name)
    workspace = bpy.data.workspaces.get(name)
    if workspace is None:
        return
    if workspace == bpy.context.workspace:
        # Without an override, whose end crashes Blender while a window is closed.
        workspace.status_text_set(None)
        return
    with bpy.context.temp_override(workspace=workspace):
        workspace.status_text_set(None)
