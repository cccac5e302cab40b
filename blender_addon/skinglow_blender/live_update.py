# SPDX-License-Identifier: GPL-3.0-or-later
"""Brings what changed in a scene into the skins' images, and does nothing at all where nothing changed."""

from typing import NamedTuple

import bpy

from .errors import SkinError
from .lut_image import Atlas, ensure_images, has_room
from .scene_lights import FIELDS
from .scene_reading import ROW_PROPERTY, SceneReading, Skin, read_scene
from .skin_tables import compute_table, signature_of
from .texel_mapping import texels_per_mm


class Rebuilt(NamedTuple):
    """One skin's table that was computed again."""

    skin: str  #: name of the object
    mode: str  #: 'VIEWPORT' or 'RENDER': whose lamps it was computed for
    before: tuple | None  #: signature of what was shown before; None: nothing
    after: tuple  #: signature of what is shown now

    @property
    def why(self) -> str:
        """What changed, in words."""
        return why_changed(self.before, self.after)


class LiveState:
    """What is remembered between updates. Undo and load make it worthless: they replace all data."""

    def __init__(self) -> None:
        self.atlases: dict[tuple[str, str], Atlas] = {}
        self.faults: dict[str, str] = {}
        #: (node group, row) to the name and library of the object whose row it is.
        self.owners: dict[tuple[str, int], tuple[str, str | None]] = {}
        self.rendering = False
        self.render_frame: float | None = None
        #: How often a scene was looked at, so once an edit: what was derived before may be out of date.
        self.looks = 0

    def forget(self) -> None:
        """Forgets all tables, so that the next update computes and shows every one."""
        self.atlases.clear()
        self.owners.clear()
        self.faults.clear()


STATE = LiveState()


def update_scene(depsgraph: bpy.types.Depsgraph, only_live: bool = False) -> list[Rebuilt]:
    """Recomputes and shows what changed for this depsgraph; faults are kept in STATE.faults and do not stop others.

    A skin with a fault keeps its last good table. With only_live, skins that are not set to follow are left.
    """
    STATE.looks += 1
    reading = read_scene(depsgraph)
    rebuilt: list[Rebuilt] = []
    faults: dict[str, str] = {}
    groups: dict[str, tuple[bpy.types.NodeTree, list[tuple[bpy.types.Object, Skin]]]] = {}
    for obj, skin in reading.skins:
        if only_live and not skin.live:
            continue
        group = obj.skinglow.group
        if group is None:
            faults[skin.key] = f"{skin.name}: its node group is gone; make the skin again"
            continue
        groups.setdefault(group.name_full, (group, []))[1].append((obj, skin))
    for group, members in groups.values():
        try:
            rebuilt += _update_group(group, members, reading, depsgraph.mode, faults)
        except SkinError as error:
            for _obj, skin in members:
                faults[skin.key] = f"{skin.name}: {error}"
    STATE.faults = faults
    return rebuilt


def _update_group(
    group: bpy.types.NodeTree,
    members: list[tuple[bpy.types.Object, Skin]],
    reading: SceneReading,
    mode: str,
    faults: dict[str, str],
) -> list[Rebuilt]:
    _separate_rows(group, members)
    _make_room(group, members)
    atlas = _atlas(group, mode)
    rebuilt = []
    for obj, skin in members:
        signature = signature_of(skin, reading.lamps)
        row = obj.skinglow.row
        before = atlas.signatures.get(skin.key)
        try:
            if signature != before or atlas.rows.get(skin.key) != row:
                table = compute_table(skin, reading.lamps)
                atlas.put(row, table.colors)
                atlas.signatures[skin.key] = signature
                atlas.rows[skin.key] = row
                atlas.sizes[skin.key] = len(table.colors)
                atlas.texel_mappings[skin.key] = table.texel_mapping
                rebuilt.append(Rebuilt(skin.name, mode, before, signature))
            _set_row_property(obj, skin, atlas)
        except (SkinError, ValueError) as error:
            faults[skin.key] = str(error)
    if rebuilt:
        atlas.write(group)
    if mode == "RENDER" or not STATE.rendering:
        atlas.show(group)
    return rebuilt


def _atlas(group: bpy.types.NodeTree, mode: str) -> Atlas:
    key = (group.name_full, mode)
    atlas = STATE.atlases.get(key)
    if atlas is None or not atlas.fits(group):
        atlas = STATE.atlases[key] = Atlas(group, mode)
    return atlas


def _separate_rows(group: bpy.types.NodeTree, members: list[tuple[bpy.types.Object, Skin]]) -> None:
    """Gives a row of its own to each skin that has none or that came by a copy of another's."""
    for obj, _skin in members:
        settings = obj.skinglow
        me = (obj.name, obj.library.filepath if obj.library is not None else None)
        if settings.row < 0 or _other_owner(group, settings.row, me):
            used = {o.skinglow.row for o in bpy.data.objects if o.skinglow.group == group}
            settings.row = next(i for i in range(len(used) + 1) if i not in used)
        STATE.owners[group.name_full, settings.row] = me


def _other_owner(group: bpy.types.NodeTree, row: int, me: tuple[str, str | None]) -> bool:
    """Whether a row belongs to another object: one that still is there, in whichever scene, and still has it."""
    owner = STATE.owners.get((group.name_full, row))
    if owner is None or owner == me:
        return False
    other = bpy.data.objects.get(owner)
    return other is not None and other.skinglow.group == group and other.skinglow.row == row


def _make_room(group: bpy.types.NodeTree, members: list[tuple[bpy.types.Object, Skin]]) -> None:
    width = max(skin.base[1] for _obj, skin in members)
    rows = 1 + max(obj.skinglow.row for obj, _skin in members)
    if has_room(group, width, rows):
        return
    if STATE.rendering:
        raise SkinError("its images are too small, and they cannot be enlarged while rendering; update before")
    ensure_images(group, width, rows)


def _set_row_property(obj: bpy.types.Object, skin: Skin, atlas: Atlas) -> None:
    """Tells the object's material where its row is and how thickness finds its texel."""
    height, width = atlas.pixels.shape[:2]
    scale = texels_per_mm(obj, skin, atlas.texel_mappings[skin.key])
    wanted = (scale, 1.0 / width, (obj.skinglow.row + 0.5) / height, skin.strength)
    if tuple(obj.get(ROW_PROPERTY, ())) != wanted:
        obj[ROW_PROPERTY] = wanted
        obj.update_tag(refresh={"OBJECT"})


def why_changed(before: tuple | None, after: tuple) -> str:
    """The difference of two signatures in words."""
    if before is None:
        return "first computed"
    if before[0] != after[0]:
        return f"mode {before[0].lower()} to {after[0].lower()}"
    if len(after) < 3 or before[1] != after[1]:
        return "base lookup"
    names = ("blood weight", "attenuation", "reference point") if after[0] == "PAPER" else ("reference point",)
    reasons = [name for name, a, b in zip(names, before[2:], after[2:], strict=False) if a != b]
    old, new = ({light[0]: light for light in signature[-1]} for signature in (before, after))
    reasons += [f"light '{name}' came" for name in new if name not in old]
    reasons += [f"light '{name}' went" for name in old if name not in new]
    for name in new:
        if name in old and old[name] != new[name]:
            changed = [f for f, a, b in zip(FIELDS, old[name], new[name], strict=True) if a != b]
            reasons.append(f"light '{name}': {', '.join(changed)}")
    return "; ".join(reasons) or "its row of the image"
