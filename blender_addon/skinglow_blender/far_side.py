# SPDX-License-Identifier: GPL-3.0-or-later
"""Places on a skin's far side, where the light comes in."""

from functools import lru_cache
from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from .errors import core
from .mesh_reading import evaluated_mesh
from .scene_reading import MEASURED_UNIT, MM_PER_METER, Skin, grown
from .skin_group import THICKNESS_ATTRIBUTE

#: Places that stand for a skin; docs/accuracy.md has the error by their number.
PLACES = 256


class FarSide(NamedTuple):
    """World, scene units."""

    points: np.ndarray  #: (n, 3) float64
    normals: np.ndarray  #: (n, 3) float64, unit, out of the far side


def far_side_of(obj: bpy.types.Object, matrix: Matrix, skin: Skin) -> FarSide:
    """Far sides x - d n of some vertices of an evaluated skin object at that world matrix.

    Of those thinner than the lookup's last entry, if there are any: thicker ones let next to nothing through.
    """
    to_world = np.array(matrix, np.float64)
    with evaluated_mesh(obj) as mesh:
        count = len(mesh.vertices)
        attribute = mesh.attributes.get(THICKNESS_ATTRIBUTE)
        if attribute is None or len(attribute.data) != count or count == 0:
            return FarSide(np.empty((0, 3)), np.empty((0, 3)))
        thickness_mm = np.empty(count, np.float32)
        attribute.data.foreach_get("value", thickness_mm)
        original = obj.original.data
        thickness_mm *= grown(original, skin.world_size)
        thin = np.flatnonzero(thickness_mm < skin.base[2])
        among = thin if len(thin) else np.arange(count)
        chosen = among[_some_of(len(among))]
        # One by one: all normals of a large mesh would take longer than the rays.
        vertices = np.array([mesh.vertices[i].co for i in chosen.tolist()], np.float64)
        normals = np.array([mesh.vertices[i].normal for i in chosen.tolist()], np.float64)
    depth = thickness_mm[chosen].astype(np.float64) / original.get(MEASURED_UNIT, MM_PER_METER)
    world = vertices @ to_world[:3, :3].T + to_world[:3, 3]
    # Normals go with the inverse transpose.
    facing = normals @ np.array(matrix.to_3x3().inverted_safe(), np.float64)
    return FarSide(*core().far_side(world, facing, depth))


@lru_cache(maxsize=64)
def _some_of(count: int) -> np.ndarray:
    """Indices of at most PLACES of so many things, the same each time.

    One anywhere in each of as many stretches: neighbors in a mesh's order mostly are neighbors in space, and even
    steps could follow a grid's columns. Half the error of so many places taken at random (measured on a scanned head).
    """
    if count <= PLACES:
        return np.arange(count)
    return ((np.arange(PLACES) + np.random.default_rng(1).random(PLACES)) * count / PLACES).astype(np.int64)
