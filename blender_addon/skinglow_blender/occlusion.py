# SPDX-License-Identifier: GPL-3.0-or-later
"""Which share of each lamp's light other objects let through to a skin's far side (mode physical)."""

from typing import Any, NamedTuple

import bpy
import numpy as np

from .errors import SkinError, core
from .far_side import FarSide, far_side_of
from .mesh_reading import MeshCache
from .scene_lights import Lamp, make_light
from .scene_reading import SceneReading, Skin


class _Body(NamedTuple):
    """An object, or an instance of one, that casts shadows."""

    key: str  #: of the original object
    version: int  #: of its mesh
    matrix: tuple[float, ...]  #: to the world, row by row


class _Walk(NamedTuple):
    """What one walk through a depsgraph found."""

    bodies: list[_Body]
    meshes: dict[int, Any]  #: arrays by version
    places: dict[str, FarSide]  #: far sides of the skins asked for, by key
    own: dict[str, int]  #: index of each such skin's own body, where it casts shadows


class _Occluders:
    """The occluders of one kind of depsgraph: built again only when one of them changed."""

    def __init__(self) -> None:
        self.meshes = MeshCache()
        self.bodies: list[_Body] | None = None
        self.scene: Any = None  #: a skinglow.Occluders

    def update(self, walk: _Walk) -> None:
        if self.bodies == walk.bodies:
            return
        self.bodies = self.scene = None
        near = next((far.points for far in walk.places.values() if len(far.points)), None)
        meshes = []
        for body in walk.bodies:
            arrays = walk.meshes[body.version]
            matrix = np.array(body.matrix).reshape(4, 4)
            meshes.append((arrays.vertices @ matrix[:3, :3].T + matrix[:3, 3], arrays.triangles))
        # Single precision is best about the origin: there, where the skins are.
        self.scene = core().Occluders(meshes, near.mean(axis=0) if near is not None else None)
        self.bodies = walk.bodies


#: By the depsgraph's mode: viewport and render show different objects.
_kept: dict[str, _Occluders] = {}


def forget(mode: str | None = None) -> None:
    """Frees what is kept for a depsgraph's mode, or for both."""
    for each in [mode] if mode is not None else list(_kept):
        _kept.pop(each, None)


def with_visible_shares(reading: SceneReading, depsgraph: bpy.types.Depsgraph, faults: dict[str, str]) -> SceneReading:
    """The reading with what each skin sees of each lamp; as it is where the scene's occlusion is off.

    A skin that cannot be traced goes out of the reading and into the faults: it keeps its last good lookup.
    """
    if not depsgraph.scene.skinglow.occlusion:
        forget()
        return reading
    asking = {skin.key: skin for _obj, skin in reading.skins if skin.mode == "PHYSICAL"}
    if not asking or not reading.lamps:
        return reading
    try:
        shares = _visible_shares(asking, reading.lamps, depsgraph)
    except (SkinError, ValueError, RuntimeError, MemoryError) as error:
        forget(depsgraph.mode)
        faults.update(
            {key: f"{skin.name}: its lamps' occlusion cannot be traced: {error}" for key, skin in asking.items()}
        )
        return reading._replace(skins=[(obj, skin) for obj, skin in reading.skins if skin.key not in asking])
    lamps = [
        lamp._replace(visible={key: row[i] for key, row in shares.items()}) for i, lamp in enumerate(reading.lamps)
    ]
    return reading._replace(lamps=lamps)


def _visible_shares(
    skins: dict[str, Skin], lamps: list[Lamp], depsgraph: bpy.types.Depsgraph
) -> dict[str, list[float]]:
    """For each skin one share per lamp, 0 to 1."""
    if not hasattr(core(), "Occluders"):
        raise SkinError("this build of the core traces no rays (it was made without Embree); switch Occlusion off")
    kept = _kept.setdefault(depsgraph.mode, _Occluders())
    walk = _walk(depsgraph, skins, kept.meshes)
    kept.update(walk)
    shares = {}
    for key, skin in skins.items():
        row = [1.0] * len(lamps)
        far = walk.places.get(key)
        traced = [
            i for i, lamp in enumerate(lamps) if lamp.casts_shadows and not lamp.left_out and lamp.lights(skin.name)
        ]
        if far is not None and traced:
            own = [walk.own[key]] if key in walk.own else []
            lights = [make_light(lamps[i]) for i in traced]
            found = kept.scene.visible_fraction(lights, far.points, far.normals, excluded=own).mean
            for i, share in zip(traced, found, strict=True):
                row[i] = float(share)
        shares[key] = row
    return shares


def _walk(depsgraph: bpy.types.Depsgraph, skins: dict[str, Skin], cache: MeshCache) -> _Walk:
    """Bodies in the depsgraph's order, and the skins' far sides; instances hold good only while it is walked."""
    walk = _Walk([], {}, {}, {})
    layer = depsgraph.view_layer if depsgraph.mode == "VIEWPORT" else None
    cache.start(depsgraph)
    for instance in depsgraph.object_instances:
        obj, parent = instance.object, instance.parent
        if obj.type != "MESH" or not instance.show_self:
            continue
        # A collection hidden by its eye in the outliner is in the viewport's depsgraph all the same.
        if layer is not None and not (parent if instance.is_instance else obj).original.visible_get(view_layer=layer):
            continue
        key = obj.original.name_full
        matrix = instance.matrix_world
        is_skin = key in skins and key not in walk.places
        if is_skin:
            walk.places[key] = far_side_of(obj, matrix, skins[key])
        if not obj.visible_shadow or (instance.is_instance and not parent.visible_shadow):
            continue
        arrays = cache.read(obj)
        if not len(arrays.triangles):
            continue
        if is_skin:
            walk.own[key] = len(walk.bodies)
        walk.meshes[arrays.version] = arrays
        walk.bodies.append(_Body(key, arrays.version, tuple(value for row in matrix for value in row)))
    return walk
