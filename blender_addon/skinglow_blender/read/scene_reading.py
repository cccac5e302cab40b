# SPDX-License-Identifier: GPL-3.0-or-later
"""One pass over an evaluated scene: its lights, its world and its skins."""

from functools import lru_cache
from math import pi
from typing import Any, NamedTuple

import bpy
from mathutils import Matrix, Vector

from ..blender_version import output_target
from ..identity import key_of, lasting_key_of
from ..setting_values import as_typed
from ..tissue_presets import TISSUE_SLIDERS
from .known_objects import Known, may_instance
from .measured_size import MEASURED_CONE, MEASURED_UNIT, scale_since_measured
from .scene_lights import SceneLight, read_light
from .scene_world import World, read_world
from .shown_mesh import Frame, frame_of

MM_PER_METER = 1000.0
#: Custom property of a skin object that its node group reads: texels per mm, texel width, row, strength.
ROW_PROPERTY = "skinglow_lut"
#: Custom property of a skin object that light is solved in with coefficients instead of a tissue: three of absorption
#: and three of reduced scattering, 1/mm, index of refraction, whether its surface is smooth.
MEDIUM_PROPERTY = "skinglow_medium"
MEDIUM_LENGTH = 8


class Skin(NamedTuple):
    """The evaluated settings of one skin."""

    name: str  #: of the object
    key: str  #: identity.key_of the object
    mode: str
    weights: str  #: 'OBJECT', 'SURFACE' or 'SHAPE'; always 'OBJECT' where the mode is not physical
    live: bool
    strength: float
    base: tuple  #: key of the base lookup (_base_key)
    blood_weight: tuple[float, float, float]
    attenuation: tuple[float, float, float]
    point: tuple[float, float, float]  #: reference point of distances to the lights, world
    reference: str  #: key of the object whose origin or bone is that point, or ""
    world_size: float  #: edge length of the object's unit cube in the world, scene units
    surface: "SurfaceBounds | None"  #: needed for light per pixel only
    shape: "ShapeSettings | None" = None  #: needed for light through the shape only


class ShapeSettings(NamedTuple):
    """What light through the shape of a skin depends on, besides its mesh."""

    cell_mm: float
    reentries: int
    unit_mm: float  #: as its thickness was measured
    medium: tuple[float, ...] | None  #: MEDIUM_PROPERTY; None: the tissue of the sliders
    frame: Frame


class SurfaceBounds(NamedTuple):
    """Bounds of a skin's surface and of the normals of its far side, in the world."""

    min: tuple[float, float, float]
    max: tuple[float, float, float]
    normal_cone: tuple[tuple[float, float, float], float]  #: of the far side: axis, half angle in radians
    depth_per_mm: float  #: scene units per millimeter of the thickness attribute


class SceneReading(NamedTuple):
    """The lights, skins and world of one depsgraph, in depsgraph order."""

    lights: list[SceneLight]
    skins: list[tuple[bpy.types.Object, Skin]]  #: with their original objects; invalid after undo or load
    world: World | None
    occluders: Any = None  #: table.occlusion.Traced; None: nothing stands in the way of light
    known: Known | None = None  #: for the next reading


def read_scene(depsgraph: bpy.types.Depsgraph, known: Known | None = None) -> SceneReading:
    """Reads a depsgraph. It holds no hidden objects, and viewport and render have different ones.

    known  what an earlier reading of this depsgraph found, if nothing that matters was added or removed since
    """
    found = _Found(depsgraph)
    objects = known.evaluated(depsgraph) if known is not None and not known.instancing else None
    if objects is not None:
        for obj in objects:
            found.take(obj, obj.type, obj, None)
        return SceneReading(found.lights, found.skins, read_world(depsgraph), known=known)
    # Iterating over the instances of a scattered forest is slow: do so only if something in the scene instances.
    read, instancers = [], []
    for obj in depsgraph.objects:
        kind = obj.type
        if found.take(obj, kind, obj, None):
            read.append(obj.original)
        if kind != "LIGHT" and may_instance(obj):
            instancers.append(obj.original)
    instancing = set()
    if instancers:
        for instance in depsgraph.object_instances:
            if instance.is_instance and found.take(instance.object, instance.object.type, instance, instance.parent):
                instancing.add(key_of(instance.parent))
    world = read_world(depsgraph)
    known = None
    # A render's depsgraph is read once; with Occlusion any object matters.
    if depsgraph.mode == "VIEWPORT" and not depsgraph.scene.skinglow.occlusion:
        known = Known(depsgraph, read, instancers, instancing, world)
    return SceneReading(found.lights, found.skins, world, known=known)


class _Found:
    """Lights and skins as they are come across in a depsgraph."""

    def __init__(self, depsgraph: bpy.types.Depsgraph) -> None:
        self.lights: list[SceneLight] = []
        self.skins: list[tuple[bpy.types.Object, Skin]] = []
        self._seen: set[str] = set()
        self._target = output_target(depsgraph.scene)
        self._layer = depsgraph.view_layer if depsgraph.mode == "VIEWPORT" else None

    def take(self, obj: bpy.types.Object, kind: str, placed: Any, instancer: bpy.types.Object | None) -> bool:  # noqa: ANN401
        """Reads an object or an instance of one; returns whether it is a light or a skin.

        placed  what has its world matrix: the object, or the instance
        """
        if kind == "LIGHT":
            if self._is_visible(instancer or obj):
                name = f"{obj.name} in {instancer.name}" if instancer else obj.name
                self.lights.append(read_light(obj, placed.matrix_world, name, self._target, instancer))
            return True
        if kind != "MESH":
            return False
        settings = obj.skinglow
        if not settings.enabled:
            return False
        skin = _read_skin(obj, settings, placed.matrix_world)
        if skin.key not in self._seen:
            self._seen.add(skin.key)
            self.skins.append((obj.original, skin))
        return True

    def _is_visible(self, obj: bpy.types.Object) -> bool:
        # Collections hidden in the viewport by their eye icon are still in the viewport's depsgraph.
        return self._layer is None or obj.original.visible_get(view_layer=self._layer)


def read_skin(obj: bpy.types.Object, matrix: Matrix) -> Skin:
    """Reads the settings of an evaluated skin object (with drivers and keyframes applied) at that world matrix."""
    return _read_skin(obj, obj.skinglow, matrix)


def _read_skin(obj: bpy.types.Object, settings: bpy.types.PropertyGroup, matrix: Matrix) -> Skin:
    mode = settings.mode
    # A number of an earlier version that no longer has a name reads as "" until file_upgrade.py replaced it.
    weights = (settings.weights or "SURFACE") if mode == "PHYSICAL" else "OBJECT"
    reference = settings.reference
    rows, world_size = _rows_and_size(matrix.copy().freeze())
    return Skin(
        name=obj.name,
        key=key_of(obj),
        mode=mode,
        weights=weights,
        live=settings.live,
        strength=as_typed(settings.strength),
        base=_base_key(settings, mode),
        blood_weight=_triple(settings.blood_weight),
        attenuation=_triple(settings.attenuation),
        point=_reference_point(obj, settings, reference, rows),
        reference=_key_of(settings.reference_object) if reference == "OBJECT" else "",
        world_size=world_size,
        surface=_surface_bounds(obj, matrix, world_size) if weights == "SURFACE" else None,
        shape=_shape_settings(obj, matrix) if weights == "SHAPE" else None,
    )


def lit_per_pixel(skin: Skin, obj: bpy.types.Object, matrix: Matrix) -> Skin:
    """The same skin where its light cannot be shown through its shape."""
    return skin._replace(weights="SURFACE", surface=_surface_bounds(obj, matrix, skin.world_size), shape=None)


def _shape_settings(obj: bpy.types.Object, matrix: Matrix) -> ShapeSettings:
    settings = obj.skinglow
    medium = tuple(obj.get(MEDIUM_PROPERTY, ()))
    return ShapeSettings(
        cell_mm=as_typed(settings.cell_mm),
        reentries=settings.reentries,
        unit_mm=obj.original.data.get(MEASURED_UNIT, MM_PER_METER),
        medium=medium if len(medium) == MEDIUM_LENGTH else None,
        frame=frame_of(matrix),
    )


@lru_cache(maxsize=4096)
def _rows_and_size(matrix: Matrix) -> tuple[tuple[tuple[float, ...], ...], float]:
    """The rows of a world matrix and the edge length of the unit cube in it: most objects stay where they are."""
    return tuple(map(tuple, matrix.copy())), abs(matrix.to_3x3().determinant()) ** (1.0 / 3.0)


def _surface_bounds(obj: bpy.types.Object, matrix: Matrix, world_size: float) -> SurfaceBounds:
    corners = [matrix @ Vector(corner) for corner in obj.bound_box]
    mesh = obj.original.data
    # Modifiers change the normals, and a non-uniform scale distorts the cone.
    cone = mesh.get(MEASURED_CONE)
    scales = [column.to_3d().length for column in matrix.col[:3]]
    if cone is None or len(obj.modifiers) or max(scales) - min(scales) > 1e-4 * max(scales):
        normal_cone = ((0.0, 0.0, 1.0), pi)
    else:
        normal_cone = (tuple(-(matrix.to_3x3() @ Vector(cone[:3])).normalized()), cone[3])
    return SurfaceBounds(
        min=tuple(map(min, *corners)),
        max=tuple(map(max, *corners)),
        normal_cone=normal_cone,
        depth_per_mm=scale_since_measured(mesh, world_size) / mesh.get(MEASURED_UNIT, MM_PER_METER),
    )


def _base_key(settings: bpy.types.PropertyGroup, mode: str) -> tuple:
    """(kind, size, max thickness in mm, ...): everything the base lookup depends on."""
    size, max_thickness = settings.size, as_typed(settings.max_thickness_mm)
    base = settings.base if mode == "PAPER" else ""
    if mode == "PHYSICAL" or base == "SKIN":
        kind = "TISSUE" if mode == "PHYSICAL" else "TISSUE_GRAY"
        return kind, size, max_thickness, tuple(as_typed(getattr(settings, name)) for name in TISSUE_SLIDERS)
    if base == "IMAGE":
        image = settings.base_image
        if image is None:
            return "IMAGE", 1, max_thickness, "", ""
        return "IMAGE", max(image.size[0], 1), max_thickness, lasting_key_of(image), image.colorspace_settings.name
    return "BUILTIN", size, max_thickness


def _triple(vector: bpy.types.bpy_prop_array) -> tuple[float, float, float]:
    x, y, z = vector
    return as_typed(x), as_typed(y), as_typed(z)


def _key_of(obj: bpy.types.Object | None) -> str:
    return key_of(obj) if obj is not None else ""


def _point_of(obj: bpy.types.Object, bone: str) -> tuple[float, float, float]:
    """The origin of an evaluated object, or the head of one of its bones, in the world."""
    matrix = obj.matrix_world
    if bone and obj.pose is not None and bone in obj.pose.bones:
        return tuple(matrix @ obj.pose.bones[bone].head)
    return tuple(matrix.translation)


def _reference_point(
    obj: bpy.types.Object, settings: bpy.types.PropertyGroup, reference: str, rows: tuple[tuple[float, ...], ...]
) -> tuple[float, float, float]:
    (a, b, c, d), (e, f, g, h), (i, j, k, m), _ = rows
    if reference == "POINT":
        return _triple(settings.reference_point)
    if reference == "ORIGIN":
        return d, h, m
    if reference == "OBJECT" and settings.reference_object is not None:
        return _point_of(settings.reference_object, settings.reference_bone)
    # In double precision: mathutils rounds to single, which would cost the distances their last digits.
    box = obj.bound_box
    (ax, ay, az), (bx, by, bz) = box[0], box[6]
    x, y, z = (ax + bx) / 2.0, (ay + by) / 2.0, (az + bz) / 2.0
    return a * x + b * y + c * z + d, e * x + f * y + g * z + h, i * x + j * y + k * z + m
