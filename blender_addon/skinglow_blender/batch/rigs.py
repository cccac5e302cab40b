# SPDX-License-Identifier: GPL-3.0-or-later
"""Light rigs of a batch: a selection of the scene's lights, or the lights of a rig file added temporarily."""

import warnings
from collections.abc import Iterable, Iterator, Mapping
from contextlib import ExitStack, contextmanager
from os import PathLike
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from .. import blender_version
from ..errors import SkinError, core
from .rig_lights import ADDED, added_lights

FILE_SUFFIXES = (".json", ".sl")


class _Rig(NamedTuple):
    name: str  #: in file names and the manifest
    #: Names of visible lights and collections of lights; all other lights are hidden. None: as in the scene.
    lights: tuple[str, ...] | None = None
    file: Path | None = None  #: rig file (docs/rig_format.md) or studio light, whose lights are added


class Rig(_Rig):
    """A light rig: the lights of its pictures, in addition to the world and emissive materials."""

    __slots__ = ()

    def __new__(cls, name: str, lights: tuple[str, ...] | None = None, file: Path | None = None, **old: Any) -> "Rig":  # noqa: ANN401
        if "lamps" in old:
            _warn_of_lamps()
            lights = old.pop("lamps")
        return super().__new__(cls, name, lights, file, **old)

    @property
    def lamps(self) -> tuple[str, ...] | None:
        """Deprecated name of `lights`."""
        _warn_of_lamps()
        return self.lights


def _warn_of_lamps() -> None:
    warnings.warn("skinglow_blender.Rig.lamps is now skinglow_blender.Rig.lights", DeprecationWarning, stacklevel=3)


class ReadyRig(NamedTuple):
    """A rig whose names and file have been checked."""

    rig: Rig
    shown: tuple[str, ...] | None  #: full names of the visible light objects; None: as in the scene
    collections: tuple[str, ...]  #: full names of the collections of the rig
    found: Any  #: skinglow.LightRig of the file, or None


RigLike = Rig | str | PathLike


def as_rigs(rigs: RigLike | Iterable[RigLike] | Mapping[str, Any] | None) -> list[Rig]:
    """Converts the rigs of `render_batch`; raises SkinError if a name is missing, duplicate or not a file name.

    None            one rig "scene": the lights of the scene, unchanged
    "Sunset"        the lights of the collection of that name, or the light of that name
    "day=Key,Fill"  several lights or collections, under a name of your own
    "noon.json", "evening=dusk.sl"  the lights of a file; those of the scene are hidden
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
        raise SkinError("No light rigs given: name lights, collections or rig files")
    names = [rig.name for rig in found]
    for name in names:
        if names.count(name) > 1:
            raise SkinError(f"Two light rigs are named '{name}': give each a different name, NAME=...")
        if not name or name != name.strip() or name.startswith(".") or any(c in '/\\:*?"<>|' for c in name):
            raise SkinError(
                f"'{name}' is not allowed as the name of a light rig, since it is used in file names: give NAME=..."
            )
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
    """Finds a rig's lights and reads its file; raises SkinError naming what is missing and what exists."""
    found = None
    if rig.file is not None:
        path = Path(bpy.path.abspath(str(rig.file)))
        try:
            found = core().read_light_rig(path)
        except ValueError as error:
            raise SkinError(f"Light rig '{rig.name}': {error}") from error
        rig = rig._replace(file=path)
    if rig.lights is None:
        return ReadyRig(rig, None, (), found)
    lights, collections = light_objects(scene), _collections_of(scene)
    shown: list[str] = []
    named: list[str] = []
    for name in rig.lights:
        collection, light = (_named(name, among, rig) for among in (collections, lights))
        inside = [o.name_full for o in collection.all_objects if o.type == "LIGHT"] if collection is not None else []
        if not inside and light is None:
            have = ", ".join(f"'{n}'" for n in sorted(o.name_full for o in lights)) or "none"
            what = "contains no lights" if collection is not None else "is neither a light nor a collection of lights"
            raise SkinError(f"Light rig '{rig.name}': '{name}' {what} of scene '{scene.name}'; its lights: {have}")
        if inside:
            named.append(collection.name_full)
        shown += inside or [light.name_full]
    return ReadyRig(rig, tuple(dict.fromkeys(shown)), tuple(named), found)


def _collections_of(scene: bpy.types.Scene) -> list[bpy.types.Collection]:
    return [scene.collection, *scene.collection.children_recursive]


def _named(name: str, among: list[bpy.types.ID], rig: Rig) -> bpy.types.ID | None:
    """The one of that name; None: there is none. Raises SkinError if there are several.

    Names are unique within a file only. The full name of what is linked has the file in brackets: that is unique.
    """
    found = [each for each in among if each.name_full == name] or [each for each in among if each.name == name]
    if len(found) > 1:
        names = ", ".join(f"'{each.name_full}'" for each in found)
        raise SkinError(f"Light rig '{rig.name}': '{name}' may be {names}: give that name, or rename one in its file")
    return found[0] if found else None


def light_objects(scene: bpy.types.Scene) -> list[bpy.types.Object]:
    """All light objects of a scene, hidden or not, including those in instanced collections."""
    found: dict[bpy.types.Object, None] = {}
    visited: set[bpy.types.Collection] = set()
    objects = list(scene.objects)
    while objects:
        obj = objects.pop(0)
        if obj.type == "LIGHT":
            found[obj] = None
        instanced = obj.instance_collection
        if instanced is not None and instanced not in visited:
            visited.add(instanced)
            objects += instanced.all_objects
    return list(found)


@contextmanager
def lit_by(scene: bpy.types.Scene, ready: ReadyRig, onto: tuple[float, float, float] | None) -> Iterator[list[str]]:
    """Context manager that lights a scene's renders by that rig; yields notes on what is not supported.

    onto  target of a rig file's point, world; None: its lights are placed as in the file
    """
    with ExitStack() as undo:
        if ready.shown is not None:
            for collection in _collections_of(scene):
                if collection.name_full in ready.collections and collection != scene.collection:
                    for hiding in HIDING:
                        _set(undo, collection, hiding, False)
            for obj in light_objects(scene):
                _show_only_if(undo, obj, obj.name_full in ready.shown)
        notes = []
        if ready.found is not None:
            notes = undo.enter_context(added_lights(scene, ready.found, onto))
        yield notes


#: The properties that hide an object or a collection. The viewport is lit by the rig too, so that a skin gets the nodes
#: for its lights, which cannot be added while rendering.
HIDING = ("hide_render", "hide_viewport")


def _show_only_if(undo: ExitStack, obj: bpy.types.Object, shown: bool) -> None:
    for hiding in HIDING:
        curves = blender_version.animation_curves(obj, hiding)
        if shown and curves:
            continue  # its visibility is animated
        for curve in curves:
            if not curve.mute:
                curve.mute = True
                undo.callback(setattr, curve, "mute", False)
        _set(undo, obj, hiding, not shown)


def _set(undo: ExitStack, owner: bpy.types.Object | bpy.types.Collection, hiding: str, hidden: bool) -> None:
    if getattr(owner, hiding) != hidden:
        setattr(owner, hiding, hidden)
        undo.callback(setattr, owner, hiding, not hidden)


def check_lights(ready: ReadyRig, scene: bpy.types.Scene, lit: set[str]) -> None:
    """Raises SkinError if the lights of a picture (`lit`, by SceneLight.object_name) are not those of the rig."""
    if ready.shown is None:
        return
    for obj in light_objects(scene):
        here = obj.name_full in lit
        if here and obj.name_full not in ready.shown and obj.name_full not in _added_names(scene):
            raise SkinError(f"light '{obj.name}' is not part of the rig and could not be hidden in the render")
        if not here and obj.name_full in ready.shown and not blender_version.animation_curves(obj, "hide_render"):
            raise SkinError(
                f"light '{obj.name}' of the rig is not in the render: a collection above it is disabled in renders or "
                "excluded from the view layer"
            )


def _added_names(scene: bpy.types.Scene) -> set[str]:
    return {obj.name_full for obj in scene.collection.objects if ADDED in obj}
