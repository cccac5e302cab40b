# SPDX-License-Identifier: GPL-3.0-or-later
"""Which view layers the windows show, and updates of them that no event of Blender's brings about.

A material shows one lookup. Where two windows show a skin in two view layers, the first of them decides: otherwise each
update of one would undo that of the other, without end.
"""

import bpy

from ..identity import key_of
from ..read.file_skins import skins_of_file
from ..read.known_objects import Known
from ..session import SESSION
from ..show.mask import mask_groups, store_masks
from .guard import faults_shown, has_skins
from .live_update import TURN, update_scene
from .rebuilt import Rebuilt
from .shape_tiles import store_missing_tiles

#: Seconds from a request to the update.
DELAY = 0.05
#: Owner of our subscriptions.
SUBSCRIPTIONS = object()


def shown_layers() -> list[bpy.types.ViewLayer]:
    """The view layers of the windows, each once, in the order of the windows; the context's without windows."""
    layers: list[bpy.types.ViewLayer] = []
    for window in bpy.context.window_manager.windows:
        if window.view_layer not in layers:
            layers.append(window.view_layer)
    return layers or [bpy.context.view_layer]


def is_shown(depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether a depsgraph belongs to a render, to a view layer shown in a window, or to a scene strip of one.

    `frame_set` evaluates all view layers of the scene; the viewport's lookup is that of the visible layer.
    """
    if depsgraph.mode == "RENDER" or depsgraph.view_layer in shown_layers():
        return True
    return any(depsgraph.scene in _scenes_of_strips(window.scene) for window in bpy.context.window_manager.windows)


def _scenes_of_strips(scene: bpy.types.Scene) -> set[bpy.types.Scene]:
    """The scenes that the Sequencer's preview of a scene draws, which evaluates them."""
    editor = scene.sequence_editor
    if editor is None:
        return set()
    strips = editor.strips_all if hasattr(editor, "strips_all") else editor.sequences_all
    return {strip.scene for strip in strips if strip.type == "SCENE"}


def update_shown(depsgraph: bpy.types.Depsgraph, known: Known | None = None) -> list[Rebuilt]:
    """Updates the live skins of a depsgraph, but for those that the layer of an earlier window shows.

    While a render updates its own, which may wait for light through shapes, the window does not: it does so later.

    known  what an earlier reading of it found, if that still holds
    """
    if not TURN.acquire(blocking=depsgraph.mode == "RENDER" or not SESSION.rendering):
        update_windows_soon()
        return []
    try:
        return _update_shown(depsgraph, known)
    finally:
        TURN.release()


def _update_shown(depsgraph: bpy.types.Depsgraph, known: Known | None) -> list[Rebuilt]:
    layers = shown_layers()
    if depsgraph.mode == "RENDER" or depsgraph.view_layer == layers[0]:
        return update_scene(depsgraph, only_live=True, known=known)
    earlier = layers[: layers.index(depsgraph.view_layer)] if depsgraph.view_layer in layers else layers
    return update_scene(
        depsgraph,
        only_live=True,
        known=known,
        left_out=lambda obj: any(obj.visible_get(view_layer=layer) for layer in earlier),
    )


def update_windows_soon() -> None:
    """Schedules another update of the scenes in the windows.

    What a handler writes makes Blender evaluate again without a report, and Blender 4.5 was seen to move instanced
    lights of hidden collections only then. There are no timers in background mode: scripts call update().
    """
    if not bpy.app.background and not bpy.app.timers.is_registered(update_windows):
        bpy.app.timers.register(update_windows, first_interval=DELAY)


def update_windows() -> float | None:
    """Updates the scenes in the windows; tries again after a render."""
    if not has_skins():
        return None
    if SESSION.rendering:
        return DELAY
    with faults_shown():
        skins = skins_of_file()
        painted, SESSION.painted = SESSION.painted, set()
        for obj in skins:
            if mask_groups(obj) and (painted is None or key_of(obj) in painted):
                store_masks(obj)
        depsgraphs = [layer.depsgraph for layer in shown_layers() if layer.depsgraph is not None]
        if store_missing_tiles(skins):
            # What is evaluated has the texels of before.
            for depsgraph in depsgraphs:
                depsgraph.update()
        for depsgraph in depsgraphs:
            update_shown(depsgraph)
    return None


def follow_windows() -> None:
    """Subscribes to scene and view layer changes of windows: a layer evaluated before is shown without a report."""
    bpy.msgbus.clear_by_owner(SUBSCRIPTIONS)
    for name in ("scene", "view_layer"):
        bpy.msgbus.subscribe_rna(key=(bpy.types.Window, name), owner=SUBSCRIPTIONS, args=(), notify=update_windows_soon)


def stop_following_windows() -> None:
    """Ends the subscriptions and a requested update."""
    bpy.msgbus.clear_by_owner(SUBSCRIPTIONS)
    if bpy.app.timers.is_registered(update_windows):
        bpy.app.timers.unregister(update_windows)
