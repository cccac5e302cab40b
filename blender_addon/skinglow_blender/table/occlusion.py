# SPDX-License-Identifier: GPL-3.0-or-later
"""Fraction of each light that other objects let through to a skin's far side (mode physical)."""

from itertools import count
from typing import Any, NamedTuple

import bpy
import numpy as np

from ..errors import SkinError, core
from ..identity import key_of
from ..read.mesh_reading import MeshCache
from ..read.scene_lights import SceneLight, make_light
from ..read.scene_reading import SceneReading, Skin
from ..session import SESSION
from .far_side import FarSide, far_side_of

_versions = count()


class _Body(NamedTuple):
    """An object, or an instance of one, that casts shadows."""

    key: str  #: of the original object
    version: int  #: of its mesh
    matrix: tuple[float, ...]  #: object to world, row-major


class _Pass(NamedTuple):
    """The result of one pass over a depsgraph."""

    bodies: list[_Body]
    meshes: dict[int, Any]  #: arrays by version
    far_sides: dict[str, FarSide]  #: of the requested skins, by key
    own: dict[str, int]  #: index of each such skin's own body, if it casts shadows


class Traced(NamedTuple):
    """What stands in the way of light."""

    version: int  #: different for different contents
    scene: Any  #: a skinglow.Occluders, in the world
    own: dict[str, int]  #: index of each skin's own body, if it casts shadows


class Occluders:
    """The occluders of one depsgraph mode, rebuilt only when one of them changes."""

    def __init__(self) -> None:
        self.version = -1
        self.meshes = MeshCache()
        self.bodies: list[_Body] | None = None
        self.scene: Any = None  #: a skinglow.Occluders

    def update(self, found: _Pass) -> None:
        if self.bodies == found.bodies:
            return
        self.bodies = self.scene = None
        near = next((far.points for far in found.far_sides.values() if len(far.points)), None)
        meshes = []
        for body in found.bodies:
            arrays = found.meshes[body.version]
            matrix = np.array(body.matrix).reshape(4, 4)
            meshes.append((arrays.vertices @ matrix[:3, :3].T + matrix[:3, 3], arrays.triangles))
        # Rays are traced in single precision, which is finest about the origin: put that where the skins are.
        self.scene = core().Occluders(meshes, near.mean(axis=0) if near is not None else None)
        self.bodies, self.version = found.bodies, next(_versions)


def forget(mode: str | None = None) -> None:
    """Frees the occluders of a depsgraph mode, or of both."""
    for each in [mode] if mode is not None else list(SESSION.occluders):
        SESSION.occluders.pop(each, None)


def with_visible_fractions(
    reading: SceneReading, depsgraph: bpy.types.Depsgraph, faults: dict[str, str]
) -> SceneReading:
    """The reading with each light's visible fraction from each skin; unchanged if the scene's occlusion is off.

    A skin whose rays cannot be traced is removed from the reading and added to the faults; it keeps its last good
    lookup.
    """
    if not depsgraph.scene.skinglow.occlusion:
        forget()
        return reading
    requested = {skin.key: skin for _obj, skin in reading.skins if skin.mode == "PHYSICAL"}
    if not requested or not (reading.lights or any(skin.shape is not None for skin in requested.values())):
        return reading
    try:
        fractions, traced = _visible_fractions(requested, reading.lights, depsgraph)
    except (SkinError, ValueError, RuntimeError, MemoryError) as error:
        forget(depsgraph.mode)
        faults.update(
            {key: f"{skin.name}: the occlusion of its lights failed: {error}" for key, skin in requested.items()}
        )
        return reading._replace(skins=[(obj, skin) for obj, skin in reading.skins if skin.key not in requested])
    lights = [
        light._replace(visible={key: row[i] for key, row in fractions.items()})
        for i, light in enumerate(reading.lights)
    ]
    return reading._replace(lights=lights, occluders=traced)


def _visible_fractions(
    skins: dict[str, Skin], lights: list[SceneLight], depsgraph: bpy.types.Depsgraph
) -> tuple[dict[str, list[float]], Traced]:
    """For each skin one fraction per light, 0 to 1, and what stands in the way."""
    if not hasattr(core(), "Occluders"):
        raise SkinError("this build of the core was made without Embree and traces no rays; turn Occlusion off")
    occluders = SESSION.occluders.setdefault(depsgraph.mode, Occluders())
    found = _read_pass(depsgraph, skins, occluders.meshes)
    occluders.update(found)
    fractions = {}
    for key, skin in skins.items():
        row = [1.0] * len(lights)
        far = found.far_sides.get(key)
        traced = [
            i
            for i, light in enumerate(lights)
            if light.casts_shadows and not light.unlit_reason and light.lights(skin.key)
        ]
        if far is not None and traced:
            own = [found.own[key]] if key in found.own else []
            core_lights = [make_light(lights[i]) for i in traced]
            visible = occluders.scene.visible_fraction(core_lights, far.points, far.normals, excluded=own).mean
            for i, fraction in zip(traced, visible, strict=True):
                row[i] = float(fraction)
        fractions[key] = row
    return fractions, Traced(occluders.version, occluders.scene, found.own)


def _read_pass(depsgraph: bpy.types.Depsgraph, skins: dict[str, Skin], cache: MeshCache) -> _Pass:
    """Reads bodies in depsgraph order, and the skins' far sides; instances are valid during the iteration only."""
    found = _Pass([], {}, {}, {})
    layer = depsgraph.view_layer if depsgraph.mode == "VIEWPORT" else None
    cache.start(depsgraph)
    for instance in depsgraph.object_instances:
        obj, parent = instance.object, instance.parent
        if obj.type != "MESH" or not instance.show_self:
            continue
        # Collections hidden in the viewport by their eye icon are still in the viewport's depsgraph.
        if layer is not None and not (parent if instance.is_instance else obj).original.visible_get(view_layer=layer):
            continue
        key = key_of(obj)
        matrix = instance.matrix_world
        is_skin = key in skins and key not in found.far_sides
        if is_skin:
            found.far_sides[key] = far_side_of(obj, matrix, skins[key])
        if not obj.visible_shadow or (instance.is_instance and not parent.visible_shadow):
            continue
        arrays = cache.read(obj)
        if not len(arrays.triangles):
            continue
        if is_skin:
            found.own[key] = len(found.bodies)
        found.meshes[arrays.version] = arrays
        found.bodies.append(_Body(key, arrays.version, tuple(value for row in matrix for value in row)))
    return found
