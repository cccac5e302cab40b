# SPDX-License-Identifier: GPL-3.0-or-later
"""The thickness of a mesh at each vertex, mm, stored as the attribute that the node group reads."""

import math
from collections.abc import Callable, Sequence

import bpy
import numpy as np

from ..errors import SkinError, core
from ..identity import library_of
from ..read.file_skins import skins_of_file
from ..read.measured_geometry import Geometry, mesh_digest, mesh_digests, read_geometry, unit_mm
from ..read.measured_size import (
    MEASURED_BY,
    MEASURED_CONE,
    MEASURED_MATRIX,
    MEASURED_SAMPLES,
    MEASURED_SIZE,
    MEASURED_UNIT,
    is_moved_as_a_whole,
    is_reshaped,
    matrix_of,
    samples_of,
)
from ..session import SESSION

THICKNESS_ATTRIBUTE = "skinglow_thickness"
#: 1 where the thickness is known. Blender fills both attributes with 0 at vertices that they were not written for.
KNOWN_ATTRIBUTE = "skinglow_thickness_known"
#: Thicknesses are divided by what is known of them, which is at least this.
MIN_KNOWN = 1e-6
#: Mesh property: digest of the measured geometry, or GIVEN for custom thicknesses.
MEASURED_GEOMETRY = "skinglow_measured"
GIVEN = "given"
#: Mesh property: digest of the mesh itself and the kinds of its modifiers when it was measured.
MEASURED_MESH = "skinglow_measured_mesh"
#: Mesh property: fraction of the vertices at which no far side was found.
NO_FAR_SIDE = "skinglow_no_far_side"

#: Mesh property: limit of the histogram in mm; min, median, max, mm; fraction above the limit; the histogram.
SUMMARY = "skinglow_summary"
HISTOGRAM_BINS = 32


def is_measured(obj: bpy.types.Object, geometry: Geometry) -> bool:
    """Whether the stored thickness was measured on exactly this geometry, or is custom."""
    if any(name not in obj.data.attributes for name in (THICKNESS_ATTRIBUTE, KNOWN_ATTRIBUTE)):
        return False
    stored = obj.data.get(MEASURED_GEOMETRY)
    if stored != geometry.digest():
        return stored == GIVEN
    # In the world it is the same; what changed between object and mesh, as where a scale is applied, has to be known.
    return not is_reshaped(obj.data) and measured_as(obj) is not None


def is_from_measurement(mesh: bpy.types.Mesh) -> bool:
    """Whether the stored thickness was measured, rather than given."""
    return mesh.get(MEASURED_GEOMETRY, GIVEN) != GIVEN


def measured_as(obj: bpy.types.Object) -> bpy.types.Object | None:
    """The skin with whose modifiers its mesh was measured: itself, else another with the same mesh.

    None: mesh or modifiers are not those that were measured, but for moving, turning and scaling the whole. Pose, shape
    keys and the settings of modifiers are not looked at: animation changes them.
    """
    stored = obj.data.get(MEASURED_MESH)
    if stored is None or is_moved_as_a_whole(obj.data):
        return obj
    users = [obj, *sharing_skins(obj)]
    return next((user for user, now in zip(users, mesh_digests(users), strict=True) if stored in now), None)


def sharing_skins(obj: bpy.types.Object) -> list[bpy.types.Object]:
    """The other skins with the same mesh, and so with the same thickness."""
    if obj.data.users < 2:
        return []
    return [other for other in skins_of_file() if other.data == obj.data and other != obj]


def user_that_fits(obj: bpy.types.Object) -> bpy.types.Object | None:
    """Another skin with the same mesh by whose settings, in some scene of its own, that was measured."""
    for other in sharing_skins(obj):
        if not all(measured_otherwise(other, scene) for scene in other.users_scene):
            return other
    return None


def measured_otherwise(obj: bpy.types.Object, scene: bpy.types.Scene) -> str:
    """What of the settings changed since the thickness was measured, in words; empty: nothing, or it was given.

    A linked mesh was measured by the settings of its own file.
    """
    mesh = obj.data
    if library_of(mesh) is not None or not is_from_measurement(mesh):
        return ""
    then, now = mesh.get(MEASURED_UNIT), unit_mm(obj, scene)
    # Blender keeps the unit of the scene in single precision.
    if then is not None and not math.isclose(then, now, rel_tol=1e-6):
        return f"Its thickness was measured where one unit was {then:.4g} mm, which is now {now:.4g} mm"
    if MEASURED_BY in mesh and list(mesh[MEASURED_BY]) != _measured_by(obj.skinglow.rays, obj.skinglow.min_openness):
        return "Rays or Min Sky Visibility were changed after its thickness was measured"
    return ""


def _measured_by(rays: int, min_sky_visibility: float) -> list[float]:
    """The value of MEASURED_BY."""
    return [float(rays), min_sky_visibility]


def ensure_measured(
    obj: bpy.types.Object, scene: bpy.types.Scene, progress: Callable[[float], bool] | None = None
) -> bool:
    """Measures and stores a mesh's thickness unless that was done for this geometry; returns whether it measured.

    Custom thicknesses are kept until they are measured explicitly (Measure Thickness), and those of a linked mesh
    always: they were measured in its own file.
    """
    if library_of(obj.data) is not None and THICKNESS_ATTRIBUTE in obj.data.attributes:
        return False
    geometry = read_geometry(obj, scene)
    if is_measured(obj, geometry):
        return False
    check_local(obj)
    store_measured(obj, scene, geometry, *measure(geometry, progress))
    return True


def store_measured(
    obj: bpy.types.Object,
    scene: bpy.types.Scene,
    geometry: Geometry,
    thickness_mm: Sequence[float],
    no_far_side: Sequence[bool] = (),
) -> None:
    """Stores measured thicknesses and their geometry's digest; raises SkinError if the mesh changed meanwhile."""
    digest = geometry.digest()
    if read_geometry(obj, scene).digest() != digest:
        raise SkinError(f"'{obj.name}' was changed while its thickness was measured: measure again")
    store(obj, thickness_mm, geometry.unit_mm)
    obj.data[MEASURED_GEOMETRY] = digest
    obj.data[MEASURED_MESH] = mesh_digest(obj)
    obj.data[MEASURED_BY] = _measured_by(geometry.rays, geometry.min_sky_visibility)
    obj.data[NO_FAR_SIDE] = float(np.mean(no_far_side)) if len(no_far_side) else 0.0


def no_far_side_text(mesh: bpy.types.Mesh) -> str:
    """What a person should know about vertices without a far side; empty if there are none."""
    fraction = mesh.get(NO_FAR_SIDE, 0.0)
    if fraction <= 0.0:
        return ""
    share = f"{fraction:.1%}" if fraction >= 0.001 else "Some"
    return f"{share} of the vertices found no far side: the mesh is open, doubled or flat there, and shows no glow"


def measure(geometry: Geometry, progress: Callable[[float], bool] | None = None) -> tuple[np.ndarray, np.ndarray]:
    """Thickness at each of the mesh's own vertices, (v,) mm, and where no far side was found, (v,) bool.

    `progress` is called with the completed fraction, returns False to stop.
    """
    sg = core()
    if not hasattr(sg, "thickness_report"):
        raise SkinError(
            "This build of the core was made without Embree and measures no thickness: pass thicknesses as "
            "make_skin(obj, thickness=[mm, ...])"
        )
    thickness, no_far_side = sg.thickness_report(
        geometry.vertices,
        geometry.triangles,
        unit_mm=geometry.unit_mm,
        rays=geometry.rays,
        min_sky_visibility=geometry.min_sky_visibility,
        progress=progress,
    )
    if geometry.shown_as is None:
        return thickness, no_far_side
    return thickness[geometry.shown_as], no_far_side[geometry.shown_as]


def check_local(obj: bpy.types.Object) -> None:
    """Raises SkinError if the mesh is linked from a library or overrides one: what is stored in it gets lost."""
    library = library_of(obj.data)
    if library is not None:
        raise SkinError(
            f"The mesh of '{obj.name}' belongs to {library.filepath} and cannot keep a thickness: make the "
            "skin in that file, or make object and data local first (Object > Relations > Make Local)"
        )


def store(
    obj: bpy.types.Object, thickness_mm: Sequence[float], unit_mm: float, known: Sequence[bool] | None = None
) -> None:
    """Stores thicknesses, one per vertex in mm, and the related mesh properties.

    unit_mm  mm per scene unit
    known    where a vertex has one; None: everywhere
    """
    check_local(obj)
    mesh = obj.data
    values = np.ascontiguousarray(thickness_mm, np.float32)
    if values.shape != (len(mesh.vertices),):
        raise SkinError(
            f"'{obj.name}' has {len(mesh.vertices)} vertices, but thicknesses of shape {values.shape} were given"
        )
    if not np.isfinite(values).all() or (values < 0.0).any():
        raise SkinError(f"'{obj.name}': a thickness is negative or not finite; allowed: 0 mm or more")
    known = np.ones(len(values), bool) if known is None else np.asarray(known, bool)
    _write(mesh, THICKNESS_ATTRIBUTE, np.where(known, values, np.float32(0.0)))
    _write(mesh, KNOWN_ATTRIBUTE, known.astype(np.float32))
    limit = obj.skinglow.max_thickness_mm
    found = core().thickness_summary(values[known], limit, HISTOGRAM_BINS)
    mesh[SUMMARY] = [limit, found.min_mm, found.median_mm, found.max_mm, found.fraction_above, *found.histogram]
    mesh[MEASURED_GEOMETRY] = GIVEN
    mesh.pop(NO_FAR_SIDE, None)
    mesh.pop(MEASURED_MESH, None)
    mesh.pop(MEASURED_BY, None)
    mesh[MEASURED_SIZE] = abs(obj.matrix_world.to_3x3().determinant()) ** (1.0 / 3.0)
    mesh[MEASURED_MATRIX] = matrix_of(obj)
    mesh[MEASURED_SAMPLES] = samples_of(mesh)
    mesh[MEASURED_UNIT] = unit_mm
    normals = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("normal", normals)
    axis, half_angle = core().normal_cone(normals.reshape(-1, 3))
    mesh[MEASURED_CONE] = (*axis, half_angle)
    mesh.update()


def _write(mesh: bpy.types.Mesh, name: str, values: np.ndarray) -> None:
    SESSION.may_lack_tiles = True
    attribute = mesh.attributes.get(name)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("POINT", "FLOAT"):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(name, "FLOAT", "POINT")
    attribute.data.foreach_set("value", values)


def read(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Thickness at each vertex, (n,) float32, mm, and where it is known, (n,) bool; the mesh may be evaluated."""
    count = len(mesh.vertices)
    stored, known = np.zeros(count, np.float32), np.zeros(count, np.float32)
    for name, values in ((THICKNESS_ATTRIBUTE, stored), (KNOWN_ATTRIBUTE, known)):
        attribute = mesh.attributes.get(name)
        if attribute is not None and (attribute.domain, len(attribute.data)) == ("POINT", count):
            attribute.data.foreach_get("value", values)
    return stored / np.maximum(known, np.float32(MIN_KNOWN)), known > MIN_KNOWN


def mark_known(mesh: bpy.types.Mesh) -> None:
    """Brings a mesh up to date whose thickness was stored before it was marked as known."""
    if mesh.library is None and THICKNESS_ATTRIBUTE in mesh.attributes and KNOWN_ATTRIBUTE not in mesh.attributes:
        _write(mesh, KNOWN_ATTRIBUTE, np.ones(len(mesh.vertices), np.float32))


def remove(mesh: bpy.types.Mesh) -> None:
    """Removes the attributes and the related mesh properties."""
    for name in (THICKNESS_ATTRIBUTE, KNOWN_ATTRIBUTE):
        attribute = mesh.attributes.get(name)
        if attribute is not None:
            mesh.attributes.remove(attribute)
    for name in (
        MEASURED_SIZE,
        MEASURED_MATRIX,
        MEASURED_SAMPLES,
        MEASURED_UNIT,
        MEASURED_CONE,
        MEASURED_BY,
        MEASURED_GEOMETRY,
        MEASURED_MESH,
        NO_FAR_SIDE,
        SUMMARY,
    ):
        mesh.pop(name, None)
