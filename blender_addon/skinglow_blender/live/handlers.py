# SPDX-License-Identifier: GPL-3.0-or-later
"""Handlers of Blender's events. They never raise: a fault is stored and shown in the panel."""

from collections.abc import Iterable
from typing import Any

import bpy

from ..identity import key_of
from ..preferences import follows_lights
from ..read import world_image
from ..read.file_skins import skins_of_file
from ..session import SESSION
from ..show.group_following import follow_materials, merge_copies, remove_orphans
from ..show.image_pairs import keep_in_file
from ..show.lut_image import ROWS, skin_groups
from ..show.mask import mask_groups, store_masks
from ..show.tile_image import TILES
from ..table import occlusion
from . import shape_answers, shape_update
from .file_upgrade import upgrade
from .guard import REPORTS_IMPORTS, guarded, has_skins
from .hidden_layers import is_of_before, remember_hidden
from .live_update import update_scene
from .relevant_updates import changes_of
from .shape_tiles import store_missing_tiles
from .windows import (
    follow_windows,
    is_shown,
    shown_layers,
    stop_following_windows,
    update_shown,
    update_windows_soon,
)


@guarded
def before_depsgraph_update(_scene: bpy.types.Scene, _unused: None) -> None:
    """Called before an edit is evaluated: tiles that it asks for are evaluated with it, and the update shows them.

    Stored after it they would show the texels of those before, as Blender evaluates what a handler writes without a
    report. In a window, where it may take a while, a timer stores them (windows.py).
    """
    if bpy.app.background and SESSION.may_lack_tiles and not SESSION.rendering:
        store_missing_tiles(skins_of_file() if has_skins() else ())


@guarded
def on_depsgraph_update(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Called after an edit."""
    if not has_skins(depsgraph):
        return
    # What is known is put back where it still holds.
    address = depsgraph.as_pointer()
    known = SESSION.known.pop(address, None)
    reading, SESSION.reading = SESSION.reading, None
    if not follows_lights():
        return
    changes = changes_of(depsgraph, known)
    SESSION.note_reshaped(changes.reshaped)
    if not changes.objects and known is not None:
        SESSION.known[address] = known
    if not any(changes):
        SESSION.reading = reading
        return
    # Asked last: most edits concern no skin.
    if not is_shown(depsgraph):
        return
    SESSION.may_lack_tiles |= changes.objects or bool(changes.reshaped)
    if is_of_before(depsgraph):
        update_windows_soon()
        return
    moved = changes.materials and follow_materials()
    follow_weights(obj for obj in changes.reshaped if key_of(obj.data) in changes.meshes)
    known_images = [key for key in changes.images if world_image.is_known(key)]
    for key in known_images:
        world_image.forget(key)
    if not known_images and not changes.skins and not moved:
        return
    if update_shown(depsgraph, SESSION.known.get(address)):
        update_windows_soon()


@guarded
def on_frame_change(scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
    """Called after a frame change: in an animation render this is the only depsgraph with that frame's lights."""
    if not has_skins(depsgraph):
        return
    if depsgraph.mode == "RENDER" and SESSION.render_frame not in (None, _frame_of(scene)):
        # A motion blur step. The lookup is that of the frame itself; writing now would overwrite it before the renderer
        # has read it.
        return
    known = SESSION.known.pop(depsgraph.as_pointer(), None)
    SESSION.reading = None
    if not is_shown(depsgraph):
        return
    if is_of_before(depsgraph):
        update_windows_soon()
        return
    if known is not None and changes_of(depsgraph, known, is_frame=True).objects:
        known = None
    update_shown(depsgraph, known)


@guarded
def on_render_init(_scene: bpy.types.Scene, _unused: None) -> None:
    """Called when a render begins: the viewport's images are not updated until it ends."""
    SESSION.rendering = True
    SESSION.render_faults.clear()


@guarded
def on_render_pre(scene: bpy.types.Scene, _unused: None) -> None:
    """Called when the render of a frame begins."""
    SESSION.rendering = True
    SESSION.render_frame = _frame_of(scene)


def _frame_of(scene: bpy.types.Scene) -> float:
    """The frame before time is remapped: other scenes that the compositor renders have it in common."""
    return scene.frame_current + scene.frame_subframe


@guarded
def on_render_end(_scene: bpy.types.Scene, _unused: None) -> None:
    """Called when a render ends or is canceled: restores the viewport's lookups."""
    SESSION.rendering = False
    SESSION.render_frame = None
    occlusion.forget("RENDER")
    show_viewport()
    if SESSION.built_while_rendering:
        SESSION.built_while_rendering = False
        for layer in shown_layers():
            if layer is not None and layer.depsgraph is not None:
                update_shown(layer.depsgraph)


@guarded
def on_render_cancel(scene: bpy.types.Scene, _unused: None) -> None:
    """Called when a render is canceled: what it waited for then is no fault."""
    for key in [key for (key, mode), state in SESSION.shapes.items() if mode == "RENDER" and state.is_canceled]:
        SESSION.faults.pop(key, None)
        SESSION.render_faults.pop(key, None)
    on_render_end(scene, None)


@guarded
def on_undo(_first: Any, _second: Any) -> None:  # noqa: ANN401
    """Called after undo and redo: all cached state is invalid. Pixels are not undone, but the images in the nodes are.

    The skins are tagged, so Blender evaluates and reports them. Evaluating here, before Blender does, can crash it.
    """
    SESSION.forget()
    remember_hidden()
    for obj in skins_of_file():
        obj.update_tag(refresh={"OBJECT"})
    update_windows_soon()


@guarded
def on_import(_context: Any, _unused: None) -> None:  # noqa: ANN401
    """Called after data was appended, linked or pasted: skins may have come with it."""
    SESSION.has_none = None
    SESSION.may_lack_tiles = True


def follow_weights(skins: Iterable[bpy.types.Object]) -> None:
    """Stores the masks of skins by their vertex groups; while they are painted in a window, a moment later.

    Reading the weights takes 6 us a vertex, so that no pose may ask for it.
    """
    for obj in skins:
        if not mask_groups(obj):
            continue
        if bpy.app.background and not SESSION.rendering:
            store_masks(obj)
        else:
            if SESSION.painted is not None:
                SESSION.painted.add(key_of(obj))
            update_windows_soon()


@guarded
def on_load(_first: Any, _second: Any) -> None:  # noqa: ANN401
    """Called after loading a file. Evaluations during loading are not reported, so everything is updated here."""
    shape_update.forget()
    SESSION.forget()
    SESSION.render_faults.clear()
    SESSION.undone_graphs.clear()
    follow_windows()  # loading clears subscriptions
    upgrade()
    merge_copies()
    if bpy.context.view_layer is not None and skins_of_file():
        update_scene(bpy.context.evaluated_depsgraph_get(), only_live=True)
    remove_orphans()


@guarded
def on_save(_first: Any, _second: Any) -> None:  # noqa: ANN401
    """Called before saving: generated pixels are not saved unless packed."""
    for image in {i for group in skin_groups() for kind in (ROWS, TILES) for i in kind.all_of(group)}:
        if image.library is None and image.size[0]:
            keep_in_file(image)


def show_viewport() -> None:
    """Restores the viewport's images in the nodes."""
    for group in skin_groups():
        for atlases in (SESSION.atlases, SESSION.tile_atlases):
            atlas = atlases.get((key_of(group), "VIEWPORT"))
            if atlas is not None:
                atlas.show(group)


HANDLERS = (
    ("depsgraph_update_pre", before_depsgraph_update),
    ("depsgraph_update_post", on_depsgraph_update),
    ("frame_change_post", on_frame_change),
    ("render_init", on_render_init),
    ("render_pre", on_render_pre),
    ("render_complete", on_render_end),
    ("render_cancel", on_render_cancel),
    ("load_post", on_load),
    ("undo_post", on_undo),
    ("redo_post", on_undo),
    ("save_pre", on_save),
)


if REPORTS_IMPORTS:
    HANDLERS += (("blend_import_post", on_import),)


def register() -> None:
    """Adds the handlers."""
    for event, handler in HANDLERS:
        getattr(bpy.app.handlers, event).append(handler)
    follow_windows()


def unregister() -> None:
    """Removes the handlers."""
    for event, handler in HANDLERS:
        handlers = getattr(bpy.app.handlers, event)
        if handler in handlers:
            handlers.remove(handler)
    # Whoever saves the file from now on, and whoever renders it, has the pixels that are shown now.
    on_save(None, None)
    stop_following_windows()
    shape_answers.stop()
    shape_update.forget()
    SESSION.forget_tables()
