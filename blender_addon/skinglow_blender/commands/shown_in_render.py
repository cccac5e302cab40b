# SPDX-License-Identifier: GPL-3.0-or-later
"""What skins show in a render of a frame, found without a picture.

What a render shows differs from what the viewport shows. So each frame is evaluated as for a render, with an engine
that draws nothing; the add-on's own handlers then show what they would show in a picture, and that is taken.
"""

import traceback
from collections.abc import Iterator
from contextlib import ExitStack, contextmanager
from typing import NamedTuple

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError
from ..identity import key_of
from ..read.scene_reading import ROW_PROPERTY
from ..session import SESSION
from ..show.frozen import TileRange
from ..show.group_nodes import GroupNodes, nodes_of
from ..show.tile_image import tiles_shown


class Shown(NamedTuple):
    """What a skin shows in one frame of a render."""

    texels: np.ndarray  #: (width, 4)
    scale: tuple[float, float]  #: texels per mm, strength
    nodes: GroupNodes
    tiles: tuple[TileRange, np.ndarray] | None  #: with their pixels (rows, width, 4)


class _Evaluation(bpy.types.RenderEngine):
    """Evaluates the scene for a render and draws nothing."""

    bl_idname = "SKINGLOW_EVALUATION"
    bl_label = "Skinglow Evaluation"

    def render(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Called by Blender for each view layer, which it has evaluated."""


def shown_in_render(scene: bpy.types.Scene) -> dict[str, Shown]:
    """What the skins show in a render of the frame that the scene is at."""
    found: dict[str, Shown] = {}
    faults: list[str] = []

    def take(depsgraph: bpy.types.Depsgraph) -> None:
        faults.extend(SESSION.faults.values())
        for obj, shown in _rows_shown(depsgraph):
            before = found.setdefault(key_of(obj), shown)
            if not _shows_the_same(before, shown):
                faults.append(
                    f"{obj.name}: view layers light it differently, and a frozen material can show one of them: "
                    "turn off Use for Rendering of the others"
                )

    def look(_scene: bpy.types.Scene, depsgraph: bpy.types.Depsgraph) -> None:
        if depsgraph.mode != "RENDER":
            return
        try:
            take(depsgraph)
        except Exception as error:  # noqa: BLE001  Blender keeps what a handler raises to itself
            faults.append(f"unexpected {type(error).__name__}: {error}")
            traceback.print_exception(error)

    # The add-on's own handler runs before this one.
    bpy.app.handlers.frame_change_post.append(look)
    try:
        with _evaluating(scene):
            bpy.ops.render.render("EXEC_DEFAULT", scene=scene.name)
    except RuntimeError as error:
        raise SkinError(f"Frame {scene.frame_current} cannot be evaluated: {' '.join(str(error).split())}") from error
    finally:
        bpy.app.handlers.frame_change_post.remove(look)
    if faults:
        raise SkinError(f"Frame {scene.frame_current}: {'; '.join(dict.fromkeys(faults))}")
    return found


def _shows_the_same(a: Shown, b: Shown) -> bool:
    if not np.array_equal(a.texels, b.texels) or a.scale != b.scale or (a.tiles is None) != (b.tiles is None):
        return False
    return a.tiles is None or (a.tiles[0] == b.tiles[0] and np.array_equal(a.tiles[1], b.tiles[1]))


def _rows_shown(depsgraph: bpy.types.Depsgraph) -> Iterator[tuple[bpy.types.Object, Shown]]:
    reading = SESSION.reading_of(depsgraph)
    for obj, skin in reading.skins if reading is not None else ():
        group = obj.skinglow.group
        atlas = SESSION.atlases.get((key_of(group), depsgraph.mode)) if group is not None else None
        if atlas is not None and skin.key in atlas.tables:
            scale, _width, _row, strength = obj[ROW_PROPERTY]
            texels = atlas.pixels[obj.skinglow.row].copy()
            yield obj, Shown(texels, (scale, strength), nodes_of(group), _tiles_of(obj, depsgraph.mode))


def _tiles_of(obj: bpy.types.Object, mode: str) -> tuple[TileRange, np.ndarray] | None:
    found = tiles_shown(obj, mode)
    return (TileRange(found[0], len(found[1])), found[1]) if found is not None else None


@contextmanager
def _evaluating(scene: bpy.types.Scene) -> Iterator[None]:
    """Context manager in which a render only evaluates the scene, as for the scene's own engine."""
    render = scene.render
    with ExitStack() as undo:
        bpy.utils.register_class(_Evaluation)
        undo.callback(bpy.utils.unregister_class, _Evaluation)
        blender_version.STANDS_FOR[_Evaluation.bl_idname] = render.engine
        undo.callback(blender_version.STANDS_FOR.pop, _Evaluation.bl_idname)
        wanted = {"engine": _Evaluation.bl_idname, "use_compositing": False, "use_sequencer": False}
        for name, value in {**wanted, "use_lock_interface": True}.items():
            undo.callback(setattr, render, name, getattr(render, name))
            setattr(render, name, value)
        yield
