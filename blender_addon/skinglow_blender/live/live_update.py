# SPDX-License-Identifier: GPL-3.0-or-later
"""Updates the skins' images after a change in the scene; does nothing if nothing changed."""

import threading
from collections.abc import Callable

import bpy
import numpy as np

from ..errors import SkinError
from ..identity import key_of
from ..read import working_space
from ..read.known_objects import Known
from ..read.scene_reading import ROW_PROPERTY, SceneReading, Skin, lit_per_pixel, read_scene, read_skin
from ..session import SESSION
from ..show.frozen import is_frozen
from ..show.group_nodes import nodes_of
from ..show.lut_image import Atlas, group_layout, images_of
from ..show.tile_image import place_tiles
from ..table.light_room import NO_ROOM
from ..table.lut_layout import plain_row, surface_row
from ..table.occlusion import with_visible_fractions
from ..table.skin_tables import Table, compute_table, signature_of
from ..table.texel_mapping import texels_per_mm
from ..thickness.tile_attribute import rows_of
from . import shape_answers, shape_update, waiting
from .frozen_update import follow_frozen, mark_of
from .hidden_layers import evaluate_anew
from .hidden_skins import to_make_ready
from .needed_nodes import crowding, fit_nodes, is_cut_down, is_fixed, make_room
from .rebuilt import Rebuilt
from .shape_tiles import hide_tiles, write_tiles

#: Held during an update. A render has a thread of its own, and its lights would be taken for those of the viewport, or
#: these for its own.
TURN = threading.RLock()


def update_scene(
    depsgraph: bpy.types.Depsgraph,
    only_live: bool = False,
    left_out: Callable[[bpy.types.Object], bool] | None = None,
    known: Known | None = None,
    made: bpy.types.Object | None = None,
) -> list[Rebuilt]:
    """Recomputes and shows what changed in this depsgraph. Faults go to SESSION.faults and do not affect other skins.

    A skin with a fault keeps its last good table. With only_live, skins that are not live keep the table they show.
    left_out  whether another view layer decides what a skin shows
    known     what an earlier reading of this depsgraph found, if that still holds; None: every object is looked at
    made      a skin that is made ready for renders also if it is hidden in this depsgraph; others are if they may be
              rendered and have not been made ready for these lights
    """
    with TURN:
        return _update_scene(depsgraph, only_live, left_out, known, made)


def _update_scene(
    depsgraph: bpy.types.Depsgraph,
    only_live: bool,
    left_out: Callable[[bpy.types.Object], bool] | None,
    known: Known | None,
    made: bpy.types.Object | None,
) -> list[Rebuilt]:
    evaluate_anew(depsgraph)
    SESSION.updates += 1
    SESSION.interrupted = False
    faults: dict[str, str] = {}
    reading = with_visible_fractions(read_scene(depsgraph, known), depsgraph, faults)
    address = depsgraph.as_pointer()
    SESSION.reading = (address, reading)
    if reading.known is not None:
        SESSION.known[address] = reading.known
    else:
        SESSION.known.pop(address, None)
    seen = {skin.key for _obj, skin in reading.skins} | faults.keys()
    if made is not None:
        SESSION.scene_skins = None
    hidden = [made] if made is not None and key_of(made) not in seen else []
    others = to_make_ready(depsgraph, reading, seen.union(map(key_of, hidden))) if left_out is None else []
    hidden += others
    if hidden:
        reading = reading._replace(skins=[*reading.skins, *((obj, _as_in_file(obj)) for obj in hidden)])
    SESSION.reference_objects = frozenset(skin.reference for _obj, skin in reading.skins if skin.reference)
    rebuilt: list[Rebuilt] = []
    groups: dict[str, tuple[bpy.types.NodeTree, list[tuple[bpy.types.Object, Skin]]]] = {}
    for obj, skin in reading.skins:
        if left_out is not None and left_out(obj):
            continue
        group = obj.skinglow.group
        if group is None:
            faults[skin.key] = f"{skin.name}: its node group was deleted: make the skin again"
            continue
        groups.setdefault(key_of(group), (group, []))[1].append((obj, skin))
    if any(skin.shape is not None for _obj, skin in reading.skins):
        shape_update.start(depsgraph)
    for group, members in groups.values():
        if is_frozen(group):
            follow_frozen(group, members, faults)
            if depsgraph.mode == "VIEWPORT":
                frame = depsgraph.scene.frame_current
                SESSION.marks.update((skin.key, (frame, mark_of(obj, skin, reading))) for obj, skin in members)
            continue
        try:
            members = [(obj, skin if obj in hidden else _as_can_be(obj, skin, depsgraph)) for obj, skin in members]
            rebuilt += _update_group(group, members, reading, depsgraph, only_live, faults)
            through = {obj: rows_of(obj.data) for obj in hidden if obj.skinglow.group == group}
            if any(through.values()) and nodes_of(group).tiles:
                place_tiles(group, {obj: rows for obj, rows in through.items() if rows})
        except SkinError as error:
            for _obj, skin in members:
                faults[skin.key] = f"{skin.name}: {error}"
    for obj in others:
        # What is wrong with a hidden skin is told when it is shown, and by the render that shows it.
        faults.pop(key_of(obj), None)
    SESSION.faults = faults
    if depsgraph.mode == "RENDER":
        for key, fault in faults.items():
            SESSION.render_faults.setdefault(key, f"Render of frame {depsgraph.scene.frame_current}: {fault}")
    shape_update.forget_lost({skin.key for _obj, skin in reading.skins if skin.shape is not None})
    shape_answers.take_soon()
    waiting.pass_on()
    return rebuilt


def _as_in_file(obj: bpy.types.Object) -> Skin:
    """A skin that is hidden and so not evaluated, but a render may show it, and has to find its nodes."""
    shape_update.forget({key_of(obj)})
    skin = read_skin(obj, obj.matrix_world)
    if skin.shape is None or rows_of(obj.data):
        return skin
    return lit_per_pixel(skin, obj, obj.matrix_world)


def _as_can_be(obj: bpy.types.Object, skin: Skin, depsgraph: bpy.types.Depsgraph) -> Skin:
    """The skin, lit per pixel if its light cannot be shown through its shape."""
    if skin.shape is None:
        return skin
    group = obj.skinglow.group
    has_nodes = not is_fixed(group) or nodes_of(group).tiles
    if shape_update.prepare(obj, skin, depsgraph, has_nodes).reason is None:
        return skin
    evaluated = obj.evaluated_get(depsgraph)
    return lit_per_pixel(skin, evaluated, evaluated.matrix_world)


def _update_group(
    group: bpy.types.NodeTree,
    members: list[tuple[bpy.types.Object, Skin]],
    reading: SceneReading,
    depsgraph: bpy.types.Depsgraph,
    only_live: bool,
    faults: dict[str, str],
) -> list[Rebuilt]:
    mode = depsgraph.mode
    row_of = _separate_rows(group, members)
    # A redo brings back nodes and layout, and images of the size that they were made with.
    layout = group_layout(group)
    width = max([skin.base[1] for _obj, skin in members] + ([layout.width] if layout is not None else []))
    images = make_room(group, width, 1 + max(row_of.values()))
    atlas = _atlas(group, mode, images)
    before = {key: (signature, atlas.rows.get(key)) for key, signature in atlas.signatures.items()}
    other = SESSION.atlases.get((key_of(group), "RENDER" if mode == "VIEWPORT" else "VIEWPORT"))
    kept = _keep(atlas, other, members) if only_live else set()
    fixed = is_fixed(group)
    _compute(atlas, members, kept, reading, faults, fixed)
    if fit_nodes(group, atlas, members, reading, depsgraph):
        for _obj, skin in members:
            SESSION.render_faults.pop(skin.key, None)
        old, atlas = atlas, _atlas(group, mode, images_of(group))
        kept = _keep(atlas, old, members) if only_live else set()
        _compute(atlas, members, kept, reading, faults, fixed)
    rebuilt = []
    for obj, skin in members:
        table = atlas.tables.get(skin.key)
        if table is None:
            continue
        row, signature = row_of[skin.key], atlas.signatures[skin.key]
        if not atlas.holds(skin.key, row, table):
            atlas.put(skin.key, row, table, _texels(table, skin, atlas))
            changed_from = before.get(skin.key, (None, None))
            if changed_from != (signature, row):
                rebuilt.append(Rebuilt(skin.name, mode, changed_from[0], signature, skin.key))
        _set_row_property(obj, skin, atlas, row)
    _follow_shapes(group, members, atlas, kept, reading, faults)
    atlas.look_for_loss(group)
    if atlas.is_dirty:
        atlas.write(group)
    if mode == "RENDER" or not SESSION.rendering:
        atlas.show(group)
    return rebuilt


def _follow_shapes(
    group: bpy.types.NodeTree,
    members: list[tuple[bpy.types.Object, Skin]],
    atlas: Atlas,
    kept: set[str],
    reading: SceneReading,
    faults: dict[str, str],
) -> None:
    """Brings the light through shapes up to date, and the tiles that show it."""
    shown = {}
    for obj, skin in members:
        state = shape_update.state_of(skin.key, atlas.mode) if skin.shape is not None else None
        table = atlas.tables.get(skin.key)
        if state is None or table is None:
            hide_tiles(obj)
            continue
        if skin.key not in kept or not shape_update.keep(state, skin):
            shape_update.follow(state, skin, table, reading, atlas.mode)
        if state.fault:
            faults[skin.key] = f"{skin.name}: {state.fault}"
        if state.shown is not None:
            shown[obj] = state.shown
    write_tiles(group, atlas.mode, shown)


def _keep(atlas: Atlas, other: Atlas | None, members: list[tuple[bpy.types.Object, Skin]]) -> set[str]:
    """Keys of the skins that are not live and keep their table, from this atlas or else from the other."""
    kept = set()
    for key in [skin.key for _obj, skin in members if not skin.live]:
        if key not in atlas.tables and other is not None and key in other.tables:
            atlas.tables[key], atlas.signatures[key] = other.tables[key], other.signatures[key]
        if key in atlas.tables:
            kept.add(key)
    return kept


def _compute(
    atlas: Atlas,
    members: list[tuple[bpy.types.Object, Skin]],
    kept: set[str],
    reading: SceneReading,
    faults: dict[str, str],
    fixed: bool,
) -> None:
    """Computes the tables whose signature changed; a skin with a fault keeps its last one.

    fixed  whether its light has to fit into the nodes that there are
    """
    room = (atlas.layout or NO_ROOM) if fixed else None
    for obj, skin in members:
        if skin.key in kept:
            continue
        signature = signature_of(skin, reading.lights, reading.world)
        if skin.shape is not None:
            signature = signature._replace(mesh=shape_update.mesh_version(skin.key, atlas.mode))
        table = atlas.tables.get(skin.key)
        # Once nodes can be added, what had no room gets it.
        is_cut = table is not None and skin.surface is not None and (table.lighting is None or is_cut_down(table))
        if atlas.signatures.get(skin.key) != signature or (is_cut and not fixed):
            try:
                table = compute_table(skin, reading.lights, reading.world, room)
                atlas.tables[skin.key], atlas.signatures[skin.key] = table, signature
            except (SkinError, ValueError) as error:
                faults[skin.key] = str(error)
                continue
        if is_cut_down(table):
            faults[skin.key] = crowding(obj.skinglow.group, skin, table)


def _texels(table: Table, skin: Skin, atlas: Atlas) -> np.ndarray:
    """A skin's row of the image, with colors in the file's working space."""
    if atlas.layout is None:
        return plain_row(working_space.from_rec709(table.colors), atlas.pixels.shape[1])
    weight = table.weight if table.weight is not None else (1.0, 1.0, 1.0)
    depth_per_mm = skin.surface.depth_per_mm if skin.surface is not None else 0.0
    columns = working_space.from_rec709(table.columns.transpose(0, 2, 1))
    return surface_row(columns, weight, table.lighting, depth_per_mm, atlas.layout, table.constant)


def _atlas(group: bpy.types.NodeTree, mode: str, images: list[bpy.types.Image]) -> Atlas:
    key = (key_of(group), mode)
    atlas = SESSION.atlases.get(key)
    if atlas is None or not atlas.fits(group, images):
        atlas = SESSION.atlases[key] = Atlas(group, mode)
    return atlas


def _separate_rows(group: bpy.types.NodeTree, members: list[tuple[bpy.types.Object, Skin]]) -> dict[str, int]:
    """Assigns a row to each skin that has none or shares one because it was copied from another skin.

    Returns all rows by skin.
    """
    group_key, rows = key_of(group), {}
    for obj, skin in members:
        settings = obj.skinglow
        row = settings.row
        if row < 0 or _other_owner(group, (group_key, row), skin.key):
            used = {o.skinglow.row for o in bpy.data.objects if o.skinglow.group == group}
            settings.row = row = next(i for i in range(len(used) + 1) if i not in used)
        SESSION.owners[group_key, row] = skin.key
        rows[skin.key] = row
    return rows


def _other_owner(group: bpy.types.NodeTree, place: tuple[str, int], me: str) -> bool:
    """Whether a row belongs to another object that still exists, in any scene, and still uses it."""
    owner = SESSION.owners.get(place)
    if owner is None or owner == me:
        return False
    other = next((obj for obj in bpy.data.objects if key_of(obj) == owner), None)
    return other is not None and other.skinglow.group == group and other.skinglow.row == place[1]


def _set_row_property(obj: bpy.types.Object, skin: Skin, atlas: Atlas, row: int) -> None:
    """Sets the property from which the object's material reads its row and the mapping from thickness to texel."""
    height, width = atlas.pixels.shape[:2]
    scale = texels_per_mm(obj, skin, atlas.tables[skin.key].texel_mapping)
    wanted = (scale, 1.0 / width, (row + 0.5) / height, skin.strength)
    if tuple(obj.get(ROW_PROPERTY, ())) != wanted:
        obj[ROW_PROPERTY] = wanted
        # In an animation render the object itself is at the frame where that began: its keys have to be evaluated
        # again. In the viewport that would take back what was edited and not keyed yet.
        obj.update_tag(refresh={"OBJECT", "TIME"} if atlas.mode == "RENDER" else {"OBJECT"})
