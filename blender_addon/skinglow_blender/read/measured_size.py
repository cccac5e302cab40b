# SPDX-License-Identifier: GPL-3.0-or-later
"""How large a mesh was when its thickness was measured, and how large it is now: its thickness grows with it.

Applying an object's scale moves it from the object into the mesh, and scaling in Edit Mode scales the mesh alone: both
count.
"""

import bpy
import numpy as np
from mathutils import Vector

from ..errors import core

#: Mesh properties stored when its thickness was measured: edge length of its unit cube in the world, scene units;
#: number of its vertices, and index and position of some; millimeters per scene unit; bounding cone of its normals in
#: object space (axis, half angle in radians).
MEASURED_SIZE = "skinglow_world_size"
MEASURED_SAMPLES = "skinglow_samples"
MEASURED_UNIT = "skinglow_unit_mm"
MEASURED_CONE = "skinglow_normal_cone"
SAMPLES = 8


def samples_of(mesh: bpy.types.Mesh) -> list[float]:
    """The value of MEASURED_SAMPLES."""
    count = len(mesh.vertices)
    found = [float(count)]
    for i in np.unique(np.linspace(0, count - 1, SAMPLES).astype(int)).tolist():
        found += [float(i), *mesh.vertices[i].co]
    return found


def scale_since_measured(mesh: bpy.types.Mesh, world_size: float) -> float:
    """Factor by which a mesh, of an object of that size, has become larger, and so thicker, since it was measured."""
    measured = mesh.get(MEASURED_SIZE, world_size)
    return (mesh_scale(mesh) or 1.0) * world_size / measured if measured > 0.0 else 1.0


def is_reshaped(mesh: bpy.types.Mesh) -> bool:
    """Whether vertices were added, removed, or moved in another way than by scaling and turning all; a quick look."""
    stored = mesh.get(MEASURED_SAMPLES)
    return stored is not None and (stored[0] != len(mesh.vertices) or mesh_scale(mesh) is None)


def mesh_scale(mesh: bpy.types.Mesh) -> float | None:
    """Factor by which the mesh itself was scaled, judged by its samples; None if it was changed in another way."""
    stored = mesh.get(MEASURED_SAMPLES)
    if stored is None or stored[0] != len(mesh.vertices):
        return None
    vertices = mesh.vertices
    then = [Vector(stored[k + 1 : k + 4]) for k in range(1, len(stored), 4)]
    now = [vertices[int(stored[k])].co for k in range(1, len(stored), 4)]
    # Mostly nothing was changed.
    if now == then:
        return 1.0
    return core().uniform_scale(then, now)
