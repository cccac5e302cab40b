# SPDX-License-Identifier: GPL-3.0-or-later
"""Blender's calls when something changes. No exception leaves them: a fault is kept for the panel."""

import traceback
from collections.abc import Callable
from typing import Any

import bpy
from bpy.app.handlers import persistent

from . import occlusion, world_image
from .errors import SkinError
from .group_following import follow_materials, may_change_groups, remove_orphans
from .live_update import STATE, update_scene
from .lut_image import images_of, skin_groups

#: Changes of these alone cannot change a lamp, the world or a skin's place.
HARMLESS = frozenset(("Material", "Image", "Texture", "Brush", "Text", "Action", "Screen", "WindowManager"))


def guarded(function: Callable[..., None]) -> Callable[..., None]:
    """Keeps exceptions in. Blender hands handlers as many arguments as the function has positional ones: two."""

    def handler(first: Any, second: Any = None) -> None:  # noqa: ANN401  differs between handlers and versions
        try:
            function(first, second)
        except (SkinError, ValueError) as error:
            STATE.faults["*"] = str(error)
        except Exception as error:  # noqa: BLE001  whatever it is, the user's work goes on
            STATE.faults["*"] = f"Unexpected: {type(error).__name__}: {error} (the system console has the details)"
            traceback.print_exc()

    handler.__name__ = function.__name__
    return persistent(handler)


def is_shown(depsgraph: bpy.types.Depsgraph) -> bool:
    """Whether a depsgraph is a render's, or that of a view layer which a window shows.

    `frame_set` evaluates all view layers of the scene; the viewport's lookup is that of the layer in view.
    """
    if depsgraph.mode == "RENDER":
        return True
    layers = [window.view_layer for window in bpy.context.window_manager.windows] or [bpy.context.view_layer]
    return depsgraph.view_layer in layers


@guarded
def on_depsgraph_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Something was edited."""
    if not is_shown(depsgraph):
        return
    if any(may_change_groups(update) for update in depsgraph.updates):
        follow_materials()
    images_changed = _forget_changed_images(depsgraph)
    kinds = [type(update.id).__name__ for update in depsgraph.updates]
    # Blender 3.4 reports changes of an image without saying of what.
    if kinds and HARMLESS.issuperset(kinds) and not images_changed:
        return
    if update_scene(depsgraph, only_live=True):
        look_again_soon()


def _forget_changed_images(depsgraph: bpy.types.Depsgraph) -> bool:
    """Has changed images of a world read again; whether there were any."""
    changed = {u.id.original.name_full for u in depsgraph.updates if isinstance(u.id, bpy.types.Image)}
    known = [name for name in changed if world_image.is_known(name)]
    for name in known:
        world_image.forget(name)
    return bool(known)


@guarded
def on_frame_change(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Another frame: in an animation render this is the only depsgraph that holds the lights of that frame."""
    if depsgraph.mode == "RENDER" and STATE.render_frame not in (None, scene.frame_current_final):
        # A step of motion blur. The picture is that of the frame itself; writing now would spoil it, as the
        # renderer may not have read the frame's image yet.
        return
    if is_shown(depsgraph):
        update_scene(depsgraph, only_live=True)


@guarded
def on_render_init(_scene: bpy.types.Scene, _unused: None) -> None:
    """A render begins: the viewport's images wait until it is over."""
    STATE.rendering = True


@guarded
def on_render_pre(scene: bpy.types.Scene, _unused: None) -> None:
    """A frame's render begins."""
    STATE.rendering = True
    STATE.render_frame = scene.frame_current_final


@guarded
def on_render_end(_scene: bpy.types.Scene, _unused: None) -> None:
    """The render is over, or was cancelled: the viewport's lookups come back."""
    STATE.rendering = False
    STATE.render_frame = None
    occlusion.forget("RENDER")
    show_viewport()


@guarded
def on_undo(_first: Any, _second: Any) -> None:  # noqa: ANN401
    """Undo or redo: nothing remembered holds any more. Pixels are not undone, but what the nodes show is.

    Evaluation follows and is reported, as the skins are tagged. Evaluating here, before Blender does, can crash it.
    """
    forget_all()
    for obj in bpy.data.objects:
        if obj.skinglow.enabled:
            obj.update_tag(refresh={"OBJECT"})
    look_again_soon()


def look_again_soon() -> None:
    """Has the windows' scenes looked at once more in a moment.

    What a handler writes makes Blender evaluate a second time without a report, and Blender 4.5 was seen to move
    instanced lamps of hidden collections only then. Without a window there are no timers: scripts call update().
    """
    if not bpy.app.background and not bpy.app.timers.is_registered(look_again):
        bpy.app.timers.register(look_again, first_interval=0.05)


def look_again() -> None:
    """Looks at what the windows show."""
    if STATE.rendering:
        return
    try:
        for window in bpy.context.window_manager.windows:
            if window.view_layer.depsgraph is not None:
                update_scene(window.view_layer.depsgraph, only_live=True)
    except (SkinError, ValueError) as error:
        STATE.faults["*"] = str(error)


@guarded
def on_load(_first: Any, _second: Any) -> None:  # noqa: ANN401
    """A file was loaded. What is evaluated while it loads is not reported, so it is looked at here."""
    forget_all()
    follow_windows()  # loading takes subscriptions away
    if bpy.context.view_layer is not None and any(obj.skinglow.enabled for obj in bpy.data.objects):
        update_scene(bpy.context.evaluated_depsgraph_get(), only_live=True)
    remove_orphans()


def forget_all() -> None:
    """Back to the state before the first update."""
    STATE.rendering = False
    STATE.render_frame = None
    STATE.forget()
    world_image.forget()
    occlusion.forget()


@guarded
def on_save(_first: Any, _second: Any) -> None:  # noqa: ANN401
    """Generated pixels are not saved unless packed."""
    for image in {i for group in skin_groups() for i in images_of(group)}:
        if image.library is None and image.is_dirty:
            image.pack()


def show_viewport() -> None:
    """Puts the viewport's images back into the nodes."""
    for group in skin_groups():
        atlas = STATE.atlases.get((group.name_full, "VIEWPORT"))
        if atlas is not None:
            atlas.show(group)


#: Whose subscriptions these are; any object of our own will do.
WINDOWS = object()


def follow_windows() -> None:
    """Has a window's turn to another scene or view layer noticed: one evaluated before is shown without a report."""
    bpy.msgbus.clear_by_owner(WINDOWS)
    for name in ("scene", "view_layer"):
        bpy.msgbus.subscribe_rna(key=(bpy.types.Window, name), owner=WINDOWS, args=(), notify=look_again_soon)


HANDLERS = (
    ("depsgraph_update_post", on_depsgraph_update),
    ("frame_change_post", on_frame_change),
    ("render_init", on_render_init),
    ("render_pre", on_render_pre),
    ("render_complete", on_render_end),
    ("render_cancel", on_render_end),
    ("load_post", on_load),
    ("undo_post", on_undo),
    ("redo_post", on_undo),
    ("save_pre", on_save),
)


def register() -> None:
    """Asks Blender for its calls."""
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)
    follow_windows()


def unregister() -> None:
    """Takes them back."""
    for event, handler in HANDLERS:
        handlers = getattr(bpy.app.handlers, event)
        if handler in handlers:
            handlers.remove(handler)
    bpy.msgbus.clear_by_owner(WINDOWS)
    if bpy.app.timers.is_registered(look_again):
        bpy.app.timers.unregister(look_again)
    STATE.forget()
