# SPDX-License-Identifier: GPL-3.0-or-later
"""What is wrong with the thickness of a skin, for the panel: found once after each change of its mesh or modifiers.

To find it takes a look at every vertex, which drawing has no time for. So drawing shows what was found last, and
requests what is out of date; a timer finds it a moment later and redraws the panels.
"""

import time

import bpy

from ..commands.health import quick_faults, thickness_faults, with_thickness_faults
from ..commands.material_health import Fault, measured_slots
from ..identity import key_of
from ..live.guard import faults_shown, guarded
from ..preferences import follows_lights
from ..session import SESSION
from .light_list import redraw_panels, view_layer_of

#: Seconds without a change of a mesh before it is looked at: nothing is while a slider is dragged or a stroke drawn.
DELAY = 0.3


def shown_faults(obj: bpy.types.Object, context: bpy.types.Context) -> list[Fault]:
    """The faults that the panel shows of a skin, requested anew if its mesh changed since. For draw()."""
    key = key_of(obj)
    stamp = (context.scene.name, context.view_layer.name, tuple(measured_slots(obj)))
    found_for, found = SESSION.thickness_faults.get(key, (None, ()))
    # In Edit Mode Blender's own copy of the mesh is out of date; leaving the mode reports a change.
    if found_for != stamp and obj.mode != "EDIT":
        SESSION.requested_faults[key] = stamp
        # There are no timers in background mode.
        if not bpy.app.background and not bpy.app.timers.is_registered(_find_soon):
            bpy.app.timers.register(_find_soon, first_interval=DELAY)
    return with_thickness_faults(quick_faults(obj), lambda: found)


def find_requested() -> int:
    """Finds the requested faults; returns the number of skins."""
    found = 0
    while SESSION.requested_faults:
        key, stamp = SESSION.requested_faults.popitem()
        obj = next((o for o in bpy.data.objects if key_of(o) == key), None)
        layer = view_layer_of(*stamp[:2])
        if obj is None or obj.type != "MESH" or obj.mode == "EDIT" or layer is None or layer.depsgraph is None:
            continue
        SESSION.thickness_faults[key] = (stamp, tuple(thickness_faults(obj, layer.depsgraph)))
        found += 1
    return found


def _find_soon() -> float | None:
    if SESSION.rendering or time.monotonic() - SESSION.reshaped_at < DELAY:
        return DELAY
    with faults_shown():
        if find_requested():
            redraw_panels()
    return None


@guarded
def on_change(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Called after an edit while lights are not followed: else the edits' own handler notes what changed.

    That reads Blender's report, which takes longer than all else of an idle edit, once.
    """
    if SESSION.thickness_faults and not follows_lights():
        SESSION.note_reshaped(update.id for update in depsgraph.updates if update.is_updated_geometry)


def register() -> None:
    """Follows edits."""
    bpy.app.handlers.depsgraph_update_post.append(on_change)


def unregister() -> None:
    """Forgets what was found."""
    if bpy.app.timers.is_registered(_find_soon):
        bpy.app.timers.unregister(_find_soon)
    if on_change in bpy.app.handlers.depsgraph_update_post:
        bpy.app.handlers.depsgraph_update_post.remove(on_change)
    SESSION.thickness_faults.clear()
    SESSION.requested_faults.clear()
