# SPDX-License-Identifier: GPL-3.0-or-later
"""The thickness of a mesh at each vertex, mm, as the attribute that the node group reads."""

import hashlib
from collections.abc import Callable, Sequence
from typing import NamedTuple

import bpy
import numpy as np

from .errors import SkinError, core
from .scene_reading import MEASURED_CONE, MEASURED_SIZE, MEASURED_UNIT, MM_PER_METER
from .skin_group import THICKNESS_ATTRIBUTE
from .skin_settings import as_typed

#: Mesh property: digest of what it was measured on, or that its thicknesses were given.
MEASURED_GEOMETRY = "skinglow_measured"
GIVEN = "given"


def unit_mm(obj: bpy.types.Object, scene: bpy.types.Scene) -> float:
    """Millimeters in one scene unit: the skin's own setting, or the scene's unit scale."""
    own = as_typed(obj.skinglow.unit_mm)
    return own if own > 0.0 else MM_PER_METER * scene.unit_settings.scale_length


class Geometry(NamedTuple):
    """What a thickness is measured on."""

    vertices: np.ndarray  #: (n, 3) float64, world, scene units
    triangles: np.ndarray  #: (m, 3) int32, counter-clockwise seen from outside
    unit_mm: float
    rays: int
    min_openness: float  #: darkest far side through which light still comes in

    def digest(self) -> str:
        """Equal digests, equal thickness."""
        state = hashlib.sha256(self.vertices.tobytes())
        state.update(self.triangles.tobytes())
        state.update(f"{self.unit_mm} {self.rays} {self.min_openness}".encode())
        return state.hexdigest()


def read_geometry(obj: bpy.types.Object, scene: bpy.types.Scene) -> Geometry:
    """The mesh as it stands in the world, without its modifiers: the attribute belongs to its own vertices."""
    check_mesh(obj)
    mesh = obj.data
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", vertices)
    mesh.calc_loop_triangles()
    triangles = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles)
    triangles = triangles.reshape(-1, 3)
    # The place in the world does not matter, and the origin keeps more digits.
    world = vertices.reshape(-1, 3) @ np.array(obj.matrix_world, np.float64)[:3, :3].T
    if obj.matrix_world.determinant() < 0.0:
        triangles = triangles[:, ::-1]  # a mirrored mesh is wound the other way
    return Geometry(
        world, np.ascontiguousarray(triangles), unit_mm(obj, scene), obj.skinglow.rays, obj.skinglow.min_openness
    )


def is_measured(obj: bpy.types.Object, geometry: Geometry) -> bool:
    """Whether the thickness that is stored was measured on this very geometry, or given."""
    if THICKNESS_ATTRIBUTE not in obj.data.attributes:
        return False
    return obj.data.get(MEASURED_GEOMETRY) in (GIVEN, geometry.digest())


def ensure_measured(
    obj: bpy.types.Object, scene: bpy.types.Scene, progress: Callable[[float], bool] | None = None
) -> bool:
    """Measures and stores a mesh's thickness unless that was done for this very geometry; whether it did.

    Thicknesses that were given stay until they are measured on purpose ('Measure Thickness').
    """
    geometry = read_geometry(obj, scene)
    if is_measured(obj, geometry):
        return False
    store_measured(obj, scene, geometry, measure(geometry, progress))
    return True


def store_measured(
    obj: bpy.types.Object, scene: bpy.types.Scene, geometry: Geometry, thickness_mm: Sequence[float]
) -> None:
    """Stores what was measured on a geometry, and for which it was; raises SkinError if the mesh changed meanwhile."""
    digest = geometry.digest()
    if read_geometry(obj, scene).digest() != digest:
        raise SkinError(f"'{obj.name}' was changed while its thickness was measured: measure it again")
    store(obj, thickness_mm, geometry.unit_mm)
    obj.data[MEASURED_GEOMETRY] = digest


def measure(geometry: Geometry, progress: Callable[[float], bool] | None = None) -> np.ndarray:
    """Thickness at each vertex, (n,) mm; `progress` is told the share done and says whether to go on."""
    sg = core()
    if not hasattr(sg, "thickness"):
        raise SkinError(
            "This build of the core measures no thickness (it was made without Embree); hand thicknesses in as "
            "make_skin(obj, thickness=[mm, ...])"
        )
    return sg.thickness(
        geometry.vertices,
        geometry.triangles,
        unit_mm=geometry.unit_mm,
        rays=geometry.rays,
        min_sky_visibility=geometry.min_openness,
        progress=progress,
    )


def check_mesh(obj: bpy.types.Object) -> None:
    """Raises SkinError, in words, for an object that cannot be a skin."""
    if obj is None or obj.type != "MESH":
        raise SkinError(f"'{getattr(obj, 'name', obj)}' is not a mesh: select the mesh that is to glow")
    if not obj.data.polygons:
        raise SkinError(f"'{obj.name}' has no faces, so that no light can come through it")
    if obj.mode == "EDIT":
        raise SkinError(f"'{obj.name}' is in edit mode: leave it (Tab) first")
    scales = [column.to_3d().length for column in obj.matrix_world.col[:3]]
    if min(scales) == 0.0 or obj.matrix_world.to_3x3().determinant() == 0.0:
        raise SkinError(f"'{obj.name}' has scale 0 along an axis, so that it has no thickness: scale it up")


def store(obj: bpy.types.Object, thickness_mm: Sequence[float], unit_mm: float) -> None:
    """Writes thicknesses, one per vertex in mm, as the attribute, and what goes with it; unit_mm of a scene unit."""
    mesh = obj.data
    values = np.ascontiguousarray(thickness_mm, np.float32)
    if values.shape != (len(mesh.vertices),):
        raise SkinError(
            f"'{obj.name}' has {len(mesh.vertices)} vertices, but thicknesses of shape {values.shape} were given"
        )
    if not np.isfinite(values).all() or (values < 0.0).any():
        raise SkinError(f"'{obj.name}': a thickness is negative or not finite; allowed are 0 or more, mm")
    attribute = mesh.attributes.get(THICKNESS_ATTRIBUTE)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("POINT", "FLOAT"):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(THICKNESS_ATTRIBUTE, "FLOAT", "POINT")
    attribute.data.foreach_set("value", values)
    mesh[MEASURED_GEOMETRY] = GIVEN
    mesh[MEASURED_SIZE] = abs(obj.matrix_world.to_3x3().determinant()) ** (1.0 / 3.0)
    mesh[MEASURED_UNIT] = unit_mm
    normals = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("normal", normals)
    axis, half_angle = core().normal_cone(normals.reshape(-1, 3))
    mesh[MEASURED_CONE] = (*axis, half_angle)
    mesh.update()


def remove(mesh: bpy.types.Mesh) -> None:
    """Takes the attribute and what goes with it away."""
    attribute = mesh.attributes.get(THICKNESS_ATTRIBUTE)
    if attribute is not None:
        mesh.attributes.remove(attribute)
    for name in (MEASURED_SIZE, MEASURED_UNIT, MEASURED_CONE, MEASURED_GEOMETRY):
        mesh.pop(name, None)
