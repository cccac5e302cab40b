# SPDX-License-Identifier: GPL-3.0-or-later
"""The evaluated meshes of skins that light is solved in, with the texels of their faces, reread only when they changed.

Light is solved in the frame of the *body*: the world matrix of an object is a rigid frame, by which the body stands in
the world, times a stretch, which belongs to the body. So a body that only moves stays what it is.
"""

from itertools import count
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from ..identity import key_of
from .mesh_reading import evaluated_mesh, triangles_of, vertices_of

#: Mesh attribute at the corners of faces: x and y in texels of the tile image, 1 + index of the tile or 0 for none.
TEXEL_ATTRIBUTE = "skinglow_texel"
#: Relative difference of stretches that comes from single precision as a body turns.
ROUNDED = 1e-5

_versions = count()


class ShownMesh(NamedTuple):
    """A mesh in object space."""

    version: int  #: different for different contents
    address: int  #: of Blender's own data; 0 for a temporary copy
    vertices: np.ndarray  #: (n, 3) float32
    corners: np.ndarray | None  #: (c, 3) float32, the texels at the corners of the faces; None: it has none
    corner_count: int  #: of the faces
    triangles: np.ndarray  #: (m, 3) int32
    texels: np.ndarray | None  #: (m, 3, 3) float32, at the corners of the triangles; None: it has none

    def has(self, vertices: np.ndarray, corners: np.ndarray | None) -> bool:
        """Whether it has these vertices and texels."""
        return np.array_equal(self.vertices, vertices) and _same(self.corners, corners)

    def is_like(self, other: "ShownMesh") -> bool:
        """Whether the contents are the same."""
        if not self.has(other.vertices, other.corners) or not np.array_equal(self.triangles, other.triangles):
            return False
        return self.texels is None or np.array_equal(self.texels, other.texels)


class ShownMeshes:
    """The meshes that were read last, by skin and depsgraph mode; the same in both modes where they are alike."""

    def __init__(self) -> None:
        self._last: dict[tuple[str, str], ShownMesh] = {}
        self._reported: set[str] = set()

    def start(self, depsgraph: bpy.types.Depsgraph) -> None:
        """Starts a pass over a depsgraph, before anything is deleted in it: its reports may point to that."""
        self._reported = {key_of(update.id) for update in depsgraph.updates if update.is_updated_geometry}

    def read(self, obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> ShownMesh:
        """The mesh of an evaluated object."""
        me = key_of(obj)
        old = self._last.get((me, depsgraph.mode))
        with evaluated_mesh(obj) as mesh:
            address = mesh.as_pointer() if obj.mode != "EDIT" else 0
            # Blender does not report all changes, in renders none, so what is fast to read is compared.
            vertices = vertices_of(mesh)
            is_there = old is not None and address and address == old.address
            if is_there and np.array_equal(old.vertices, vertices) and self._reported.isdisjoint((me, key_of(mesh))):
                # Corners are many, and the viewport reports what changes them alone.
                if depsgraph.mode == "VIEWPORT" and old.corner_count == len(mesh.loops):
                    return old
                if _same(old.corners, corner_texels(mesh)):
                    return old
            corners = corner_texels(mesh)
            triangles = triangles_of(mesh)
            texels = corners[_loops_of(mesh)] if corners is not None else None
            count = len(mesh.loops)
        found = ShownMesh(-1, address, vertices, corners, count, triangles, texels)
        same = (self._last.get((me, mode)) for mode in ("VIEWPORT", "RENDER"))
        like = next((other for other in same if other is not None and other.is_like(found)), None)
        found = like._replace(address=address) if like is not None else found._replace(version=next(_versions))
        self._last[me, depsgraph.mode] = found
        return found

    def reread(self) -> None:
        """Has all meshes read anew: undo replaces Blender's data, and addresses may come again."""
        self._last = {key: mesh._replace(address=0) for key, mesh in self._last.items()}

    def forget(self, keys: set[str]) -> None:
        """Drops the meshes of these skins."""
        self._last = {key: mesh for key, mesh in self._last.items() if key[0] not in keys}


def _same(a: np.ndarray | None, b: np.ndarray | None) -> bool:
    return a is b or (a is not None and b is not None and np.array_equal(a, b))


def corner_texels(mesh: bpy.types.Mesh) -> np.ndarray | None:
    """The texels at the corners of a mesh's faces, (c, 3) float32, of an evaluated mesh too; None: it has none."""
    attribute = mesh.attributes.get(TEXEL_ATTRIBUTE)
    if attribute is None or (attribute.domain, attribute.data_type) != ("CORNER", "FLOAT_VECTOR"):
        return None
    if len(attribute.data) != len(mesh.loops):
        return None
    values = np.empty(3 * len(mesh.loops), np.float32)
    attribute.data.foreach_get("vector", values)
    return values.reshape(-1, 3)


def _loops_of(mesh: bpy.types.Mesh) -> np.ndarray:
    """The corners of a mesh's triangles, (m, 3) int32; the triangles were found before."""
    loops = np.empty(3 * len(mesh.loop_triangles), np.int32)
    mesh.loop_triangles.foreach_get("loops", loops)
    return loops.reshape(-1, 3)


class Frame(NamedTuple):
    """How a body stands in the world."""

    body_to_world: tuple[tuple[float, ...], ...]  #: (4, 4), rigid
    stretch: tuple[tuple[float, ...], ...]  #: (3, 3), object to body

    def same_stretch(self, other: "Frame") -> bool:
        """Whether the stretches differ by no more than the rounding of a body that turns."""
        mine, others = np.array(self.stretch), np.array(other.stretch)
        return bool(np.abs(mine - others).max() <= ROUNDED * np.abs(mine).max())


def frame_of(matrix: Matrix) -> Frame:
    """The frame of an object with that world matrix."""
    location, rotation, _scale = matrix.decompose()
    rigid = Matrix.Translation(location) @ rotation.normalized().to_matrix().to_4x4()
    # In double precision, in which the rotation's inverse is its transpose.
    turned = np.array(rigid, np.float64)[:3, :3].T @ np.array(matrix, np.float64)[:3, :3]
    return Frame(tuple(map(tuple, rigid)), tuple(map(tuple, turned.tolist())))


class BodyMesh(NamedTuple):
    """A mesh in the frame of its body."""

    vertices: np.ndarray  #: (n, 3) float64
    triangles: np.ndarray  #: (m, 3), counter-clockwise seen from outside
    texels: np.ndarray  #: (m, 3, 3)


def body_mesh(mesh: ShownMesh, frame: Frame) -> BodyMesh:
    """A mesh that has texels, as its body has it."""
    stretch = np.array(frame.stretch)
    vertices = mesh.vertices @ stretch.T
    if np.linalg.det(stretch) > 0.0:
        return BodyMesh(vertices, mesh.triangles, mesh.texels)
    # Mirroring reverses the winding order.
    return BodyMesh(vertices, np.ascontiguousarray(mesh.triangles[:, ::-1]), np.ascontiguousarray(mesh.texels[:, ::-1]))
