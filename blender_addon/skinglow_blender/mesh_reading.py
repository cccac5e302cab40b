# SPDX-License-Identifier: GPL-3.0-or-later
"""Evaluated meshes as arrays, read again only where they changed."""

from collections.abc import Iterator
from contextlib import contextmanager
from itertools import count
from typing import NamedTuple

import bpy
import numpy as np

_versions = count()


class MeshArrays(NamedTuple):
    """A mesh in its own space."""

    version: int  #: another one for every other content
    vertices: np.ndarray  #: (n, 3) float32
    triangles: np.ndarray  #: (m, 3) int32
    corners: np.ndarray  #: (l,) int32, vertex of each face corner
    faces: np.ndarray  #: (f,) int32, first corner of each face


class MeshCache:
    """The meshes of the last walk through a scene.

    Blender does not say reliably what changed (nothing at all in renders), so vertices and faces are compared, which
    takes a few milliseconds for a million vertices; triangles are only made where something is different.
    """

    def __init__(self) -> None:
        self._before: dict[tuple, MeshArrays] = {}
        self._now: dict[tuple, MeshArrays] = {}
        self._by_address: dict[int, MeshArrays] = {}

    def start(self) -> None:
        """Another walk begins; what the last one did not see is forgotten."""
        self._before, self._now, self._by_address = self._now, {}, {}

    def read(self, obj: bpy.types.Object) -> MeshArrays:
        """The arrays of an evaluated object."""
        with evaluated_mesh(obj) as mesh:
            # Many instances show one mesh. A copy is gone by the next, which may come to the same address.
            address = mesh.as_pointer() if obj.mode != "EDIT" else 0
            if address in self._by_address:
                return self._by_address[address]
            vertices = _numbers(mesh.vertices, "co", 3, np.float32).reshape(-1, 3)
            corners = _numbers(mesh.loops, "vertex_index", 1, np.int32)
            faces = _numbers(mesh.polygons, "loop_start", 1, np.int32)
            # An object may show several meshes of one size, as instances: told apart by their order.
            name = (obj.original.name_full, len(vertices), len(corners), len(faces))
            key = next((*name, i) for i in count() if (*name, i) not in self._now)
            arrays = self._before.get(key)
            if arrays is None or not _same(arrays, vertices, corners, faces):
                mesh.calc_loop_triangles()
                triangles = _numbers(mesh.loop_triangles, "vertices", 3, np.int32).reshape(-1, 3)
                arrays = MeshArrays(next(_versions), vertices, triangles, corners, faces)
            self._now[key] = arrays
            if address:
                self._by_address[address] = arrays
            return arrays


@contextmanager
def evaluated_mesh(obj: bpy.types.Object) -> Iterator[bpy.types.Mesh]:
    """An evaluated object's mesh; in edit mode, where its data may not hold one yet, a copy."""
    if obj.mode != "EDIT":
        yield obj.data
        return
    try:
        yield obj.to_mesh()
    finally:
        obj.to_mesh_clear()


def _numbers(collection: bpy.types.bpy_prop_collection, name: str, width: int, kind: type) -> np.ndarray:
    values = np.empty(width * len(collection), kind)
    collection.foreach_get(name, values)
    return values


def _same(old: MeshArrays, vertices: np.ndarray, corners: np.ndarray, faces: np.ndarray) -> bool:
    return (
        np.array_equal(old.vertices, vertices)
        and np.array_equal(old.corners, corners)
        and np.array_equal(old.faces, faces)
    )
