# SPDX-License-Identifier: GPL-3.0-or-later
"""Sample points on a skin's far side, where light enters."""

from typing import NamedTuple

import bpy
import numpy as np
from mathutils import Matrix

from ..errors import core
from ..read.measured_size import MEASURED_UNIT, scale_since_measured
from ..read.mesh_reading import evaluated_mesh
from ..read.scene_reading import MM_PER_METER, Skin
from ..thickness.thickness_attribute import read

#: Samples per skin; docs/accuracy.md has the error by their number.
MAX_SAMPLES = 256


class FarSide(NamedTuple):
    """Sample points in the world, scene units."""

    points: np.ndarray  #: (n, 3) float64
    normals: np.ndarray  #: (n, 3) float64, unit, pointing out of the far side


def far_side_of(obj: bpy.types.Object, matrix: Matrix, skin: Skin) -> FarSide:
    """Far sides x - d n of some vertices of an evaluated skin object at that world matrix.

    Prefers vertices thinner than the lookup's last entry: thicker ones let next to nothing through.
    """
    to_world = np.array(matrix, np.float64)
    with evaluated_mesh(obj) as mesh:
        thickness_mm, known = read(mesh)
        if not known.any():
            return FarSide(np.empty((0, 3)), np.empty((0, 3)))
        original = obj.original.data
        thickness_mm *= scale_since_measured(original, skin.world_size)
        thin = np.flatnonzero(known & (thickness_mm < skin.base[2]))
        candidates = thin if len(thin) else np.flatnonzero(known)
        chosen = candidates[core().stratified_indices(len(candidates), MAX_SAMPLES)]
        # One by one: reading all normals of a large mesh would take longer than tracing the rays.
        vertices = np.array([mesh.vertices[i].co for i in chosen.tolist()], np.float64)
        normals = np.array([mesh.vertices[i].normal for i in chosen.tolist()], np.float64)
    depth = thickness_mm[chosen].astype(np.float64) / original.get(MEASURED_UNIT, MM_PER_METER)
    world = vertices @ to_world[:3, :3].T + to_world[:3, 3]
    # Normals transform by the inverse transpose.
    world_normals = normals @ np.array(matrix.to_3x3().inverted_safe(), np.float64)
    return FarSide(*core().far_side(world, world_normals, depth))
