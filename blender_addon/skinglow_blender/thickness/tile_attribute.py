# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the corners of a mesh's faces are in the image of its tiles, stored as the attribute that the nodes read.

The tiles belong to faces and corners: moving vertices keeps them, adding or deleting some does not.
"""

import hashlib

import bpy
import numpy as np

from ..errors import core
from ..read.measured_geometry import unit_mm
from ..read.mesh_reading import triangles_of, vertices_of
from ..read.shown_mesh import TEXEL_ATTRIBUTE
from ..read.shown_mesh import corner_texels as texels_of
from ..session import SESSION
from .thickness_attribute import SUMMARY, check_local, read

__all__ = [
    "TEXEL_ATTRIBUTE",
    "encloses_flesh",
    "ensure_tiles",
    "is_current",
    "is_of_this_mesh",
    "remove_tiles",
    "rows_of",
    "texels_of",
]

#: Mesh property: digest of faces and corners, rows, number of tiles, spacing in mm, what they were made for, and the
#: volume that the mesh enclosed.
TILES_OF_MESH = "skinglow_tiles"
#: Fraction of the vertices of a closed mesh with flesh behind them, at least.
MIN_ENCLOSED = 0.5
#: Distance of texels, mm.
SPACING_MM = 0.8


def ensure_tiles(obj: bpy.types.Object, scene: bpy.types.Scene) -> bool:
    """Makes tiles for a mesh unless it has some for these faces and this thickness; returns whether it did.

    Raises SkinError if the mesh is linked from a library and has none.
    """
    mesh = obj.data
    if is_current(mesh) and is_of_this_mesh(mesh):
        return False
    if mesh.library is not None and is_of_this_mesh(mesh):
        return False
    check_local(obj)
    sizes, corners = _faces(mesh)
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.vertices.foreach_get("co", vertices)
    thickness, known = read(mesh)
    body, unit, triangles = (
        vertices.reshape(-1, 3) @ np.array(obj.matrix_world, np.float64)[:3, :3].T,
        unit_mm(obj, scene),
        triangles_of(mesh),
    )
    if obj.matrix_world.determinant() < 0.0:
        triangles = triangles[:, ::-1]  # mirroring reverses the winding order
    made = core().FaceTiles(
        body,
        sizes,
        corners,
        core().near_thin_skin(body, triangles, np.where(known, thickness, np.inf), unit_mm=unit),
        unit_mm=unit,
        spacing_mm=SPACING_MM,
    )
    attribute = mesh.attributes.get(TEXEL_ATTRIBUTE)
    if attribute is not None and (attribute.domain, attribute.data_type) != ("CORNER", "FLOAT_VECTOR"):
        mesh.attributes.remove(attribute)
        attribute = None
    if attribute is None:
        attribute = mesh.attributes.new(TEXEL_ATTRIBUTE, "FLOAT_VECTOR", "CORNER")
    attribute.data.foreach_set("vector", np.ascontiguousarray(made.texels, np.float32).ravel())
    mesh[TILES_OF_MESH] = {
        "faces": _digest(sizes, corners),
        "rows": int(made.height),
        "tiles": int(made.tiles),
        "spacing_mm": float(made.spacing_mm),
        "made_for": _made_for(mesh),
        "volume": _volume(mesh),
    }
    if made.height == 0:
        enclosed = core().Shape(body, triangles, unit_mm=unit).report["enclosed"]
        mesh[TILES_OF_MESH]["enclosed"] = float(enclosed)
    mesh.update()
    if SESSION.shown_meshes is not None:
        SESSION.shown_meshes.reread()
    return True


def is_current(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh has tiles, made for the thickness that it has; a quick look, which does not see every edit."""
    stored = mesh.get(TILES_OF_MESH)
    return stored is not None and TEXEL_ATTRIBUTE in mesh.attributes and list(stored["made_for"]) == _made_for(mesh)


def is_of_this_mesh(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh has tiles, made for exactly its faces and corners.

    Blender 5.2 turns all faces around, with what is stored at their corners, where a negative scale is applied: the
    mesh is mirrored at the same time, so outside is where it was, and the tiles stay those of its faces.
    """
    stored, attribute = mesh.get(TILES_OF_MESH), mesh.attributes.get(TEXEL_ATTRIBUTE)
    if stored is None or attribute is None or (attribute.domain, attribute.data_type) != ("CORNER", "FLOAT_VECTOR"):
        return False
    sizes, corners = _faces(mesh)
    if stored["faces"] == _digest(sizes, corners):
        return True
    is_turned = stored["faces"] == _digest(sizes, _turned(sizes, corners))
    return is_turned and stored.get("volume", 0.0) * _volume(mesh) > 0.0


def rows_of(mesh: bpy.types.Mesh) -> int:
    """The rows of a mesh's tiles; 0 if it has none."""
    stored = mesh.get(TILES_OF_MESH)
    return int(stored["rows"]) if stored is not None else 0


def encloses_flesh(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh without a row of tiles is thick; else it is open, and there is no flesh behind its faces."""
    return mesh[TILES_OF_MESH].get("enclosed", 1.0) >= MIN_ENCLOSED


def remove_tiles(mesh: bpy.types.Mesh) -> None:
    """Removes attribute and property."""
    attribute = mesh.attributes.get(TEXEL_ATTRIBUTE)
    if attribute is not None:
        mesh.attributes.remove(attribute)
    mesh.pop(TILES_OF_MESH, None)


def _faces(mesh: bpy.types.Mesh) -> tuple[np.ndarray, np.ndarray]:
    """Corners per face, and the vertex of each corner."""
    sizes, corners = np.empty(len(mesh.polygons), np.int32), np.empty(len(mesh.loops), np.int32)
    mesh.polygons.foreach_get("loop_total", sizes)
    mesh.loops.foreach_get("vertex_index", corners)
    return sizes, corners


def _turned(sizes: np.ndarray, corners: np.ndarray) -> np.ndarray:
    """The corners of the same faces seen from the other side: each keeps its first, and has the others in reverse."""
    size, first = (np.repeat(each, sizes) for each in (sizes, np.cumsum(sizes) - sizes))
    return corners[first + (first - np.arange(len(corners))) % size]


def _volume(mesh: bpy.types.Mesh) -> float:
    """The volume that a mesh encloses, about its middle where it is open; negative where it is inside out."""
    vertices = vertices_of(mesh).astype(np.float64)
    a, b, c = (vertices - vertices.mean(axis=0))[triangles_of(mesh)].transpose(1, 0, 2)
    return float((a * np.cross(b, c)).sum() / 6.0)


def _digest(sizes: np.ndarray, corners: np.ndarray) -> str:
    return hashlib.sha256(sizes.tobytes() + corners.tobytes()).hexdigest()


def _made_for(mesh: bpy.types.Mesh) -> list[float]:
    """What changes when another thickness is stored, or the mesh gets other faces; quick to find."""
    return [float(len(mesh.polygons)), float(len(mesh.loops)), SPACING_MM, *mesh.get(SUMMARY, ())]
