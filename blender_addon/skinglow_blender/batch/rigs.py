# SPDX-License-Identifier: GPL-3.0-or-later
"""Light rigs of a batch: some of the scene's lamps, or the lamps of a rig file, for as long as pictures are made."""

from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from .. import blender_version
from ..errors import SkinError, core
from .rig_lamps import placed_lamps

FILE_SUFFIXES = (".json", ".sl")


class Rig(NamedTuple):
    """A light rig: what shines in its pictures, beside the world and what glows by itself."""

    name: str  #: in file names and the manifest
    #: Names of lamps and of collections of lamps that shine; all others are hidden. None: as the scene has it.
    lamps: tuple[str, ...] | None = None
    file: Path | None = None  #: rig file (docs/rig_format.md) or studio light, whose lamps are added


class ReadyRig(NamedTuple):
    """A rig whose names and file were found to be right."""

    rig: Rig
    shown: tuple[str, ...] | None  #: lamp objects of the scene that shine; None: as the scene has it
    collections: tuple[str, ...]  #: the collections that were named
    found: Any  #: skinglow.LightRig of the file, or None


RigLike = Rig | str | PathLike


def as_rigs(rigs: RigLike | Iterable[RigLike] | Mapping[str, Any] | None) -> list[Rig]:
    """Rigs as `render_batch` takes them; raises SkinError where a name is missing, doubled or no file name.

    None            one rig "scene": the lamps as they are
    "Sunset"        the lamps of the collection of that name, or the lamp of that name
    "day=Key,Fill"  the same with a name of its own, several with commas between
    "noon.json", "evening=dusk.sl"  a file's lamps; the scene's own are hidden
    {"day": ["Key", "Fill"], "noon": Path("noon.json")}, or Rig objects
    """
    if rigs is None:
        return [Rig("scene")]
    if isinstance(rigs, Mapping):
        found = [_of_pair(name, value) for name, value in rigs.items()]
    else:
        single = isinstance(rigs, str | PathLike | Rig)
        found = [_of_one(rig) for rig in ([rigs] if single else rigs)]
    if not found:
        raise SkinError("No light rigs were asked for: name lamps, collections or rig files")
    names = [rig.name for rig in found]
    for name in names:
        if names.count(name) > 1:
            raise SkinError(f"Two light rigs are named '{name}': give each a name of its own, NAME=...")
        if not name or name != name.strip() or name.startswith(".") or any(c in '/\\:*?"<>|' for c in name):
            raise SkinError(f"'{name}' cannot be the name of a light rig, as pictures are named by it: give NAME=...")
    return found


def _of_one(rig: RigLike) -> Rig:
    if isinstance(rig, Rig):
        return rig
    if isinstance(rig, PathLike):
        return Rig(Path(rig).stem, (), Path(rig))
    name, equals, value = rig.partition("=")
    if not equals:
        name, value = Path(rig).stem if _is_file(rig) else rig, rig
    return _of_pair(name, value if _is_file(value) else value.split(","))


def _of_pair(name: str, value: Any) -> Rig:  # noqa: ANN401
    if isinstance(value, Rig):
        return value._replace(name=name)
    if isinstance(value, PathLike) or (isinstance(value, str) and _is_file(value)):
        return Rig(name, (), Path(value))
    return Rig(name, tuple(text.strip() for text in ([value] if isinstance(value, str) else value)))


def _is_file(text: str) -> bool:
    return text.lower().endswith(FILE_SUFFIXES)


def make_ready(scene: bpy.types.Scene, rig: Rig) -> ReadyRig:
    """Finds a rig's lamps and reads its file; raises SkinError naming what is not there and what is."""
    found = None
    if rig.file is not None:
        path = Path(bpy.path.abspath(str(rig.file)))
        try:
            found = core().read_light_rig(path)
        except ValueError as error:
            raise SkinError(f"Light rig '{rig.name}': {error}") from error
        rig = rig._replace(file=path)
    if rig.lamps is None:
        return ReadyRig(rig, None, (), found)
    lamps = {obj.name: obj for obj in lamps_of(scene)}
    collections = {c.name: c for c in (scene.collection, *scene.collection.children_recursive)}
    shown: list[str] = []
    named: list[str] = []
    for name in rig.lamps:
        inside = [o.name for o in collections[name].all_objects if o.type == "LIGHT"] if name in collections else []
        if not inside and name not in lamps:
            have = ", ".join(f"'{n}'" for n in sorted(lamps)) or "none"
            what = "holds no lamps" if name in collections else "is neither a lamp nor a collection of lamps"
            raise SkinError(f"Light rig '{rig.name}': '{name}' {what} of scene '{scene.name}'; its lamps: {have}")
        if inside:
            named.append(name)
        shown += inside or [name]
    return ReadyRig(rig, tuple(dict.fromkeys(shown)), tuple(named), found)


def lamps_of(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """All lamp objects of a scene, hidden or not, with those in collections that it instances."""
    found: dict[bpy.types.Object, None] = {}
    looked_at: set[bpy.types.Collection] = set()
    objects = list(scene.objects)
    while objects:
        obj = objects.pop(0)
        if obj.type == "LIGHT":
            found[obj] = None
        instanced = obj.instance_collection
        if instanced is not None and instanced not in looked_at:
            looked_at.add(instanced)
            objects += instanced.all_objects
    return list(found)


@contextmanager
def lit_by(scene: bpy.types.Scene, ready: ReadyRig, onto: tuple[float, float, float] | None) -> Iterator[list[str]]:
    """While it lasts, a scene's renders are lit by that rig; gives notes on what could not be taken over.

    onto  where the point of a rig file comes to lie, world; None: its lamps stand where the file says
    """
    with ExitStack() as undo:
        if ready.shown is not None:
            for name in ready.collections:
                collection = bpy.data.collections.get(name)
                for hiding in HIDING if collection is not None else ():
                    _set(undo, collection, hiding, False)
            for obj in lamps_of(scene):
                _show_only_if(undo, obj, obj.name in ready.shown)
        notes = []
        if ready.found is not None:
            notes = undo.enter_context(placed_lamps(scene, ready.found, onto))
        yield notes


#: What hides an object or a collection. The viewport too has the rig's lamps: by them a skin's nodes get their room,
#: which cannot be had while rendering.
HIDING = ("hide_render", "hide_viewport")


def _show_only_if(undo: ExitStack, obj: bpy.types.Object, shown: bool) -> None:
    for hiding in HIDING:
        curves = blender_version.animation_curves(obj, hiding)
        if shown and curves:
            continue  # its animation says when it shines
        for curve in curves:
            if not curve.mute:
                curve.mute = True
                undo.callback(setattr, curve, "mute", False)
        _set(undo, obj, hiding, not shown)


def _set(undo: ExitStack, owner: bpy.types.Object | bpy.types.Collection, hiding: str, hidden: bool) -> None:
    if getattr(owner, hiding) != hidden:
        setattr(owner, hiding, hidden)
        undo.callback(setattr, owner, hiding, not hidden)


def check_lamps(ready: ReadyRig, scene: bpy.types.Scene, seen: set[str]) -> None:
    """Raises SkinError where the lamps of a picture (`seen`, by Lamp.name) are not those of the rig."""
    if ready.shown is None:
        return
    instanced = {name.split(" in ")[0] for name in seen}
    for obj in lamps_of(scene):
        here = obj.name in seen or obj.name in instanced
        if here and obj.name not in ready.shown and obj.name not in _placed_names(scene):
            raise SkinError(f"lamp '{obj.name}' is not of the rig and could not be hidden from the render")
        if not here and obj.name in ready.shown and not blender_version.animation_curves(obj, "hide_render"):
            raise SkinError(
                f"lamp '{obj.name}' of the rig is not in the render: a collection above it is disabled in renders or "
                "excluded from the view layer"
            )


def _placed_names(scene: bpy.types.Scene) -> set[str]:
    return {obj.name for obj in scene.collection.objects if "skinglow_rig" in obj}
