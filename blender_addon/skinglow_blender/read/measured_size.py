# SPDX-License-Identifier: GPL-3.0-or-later
"""How large a mesh was when its thickness was measured, and how large it is now: its thickness grows with it.

Applying an object's scale moves it from the object into the mesh, and scaling in Edit Mode scales the mesh alone: both
count.
"""

import bpy
import numpy as np

from ..errors import core

#: Mesh properties stored when its thickness was measured: edge length of its unit cube in the world, scene units;
#: matrix of its object without the position, by rows; number of its vertices, and index and position of some;
#: millimeters per scene unit; bounding cone of its normals in object space (axis, half angle in radians); rays and min
#: sky visibility, not of a thickness that was given.
MEASURED_SIZE = "skinglow_world_size"
MEASURED_MATRIX = "skinglow_matrix"
MEASURED_SAMPLES = "skinglow_samples"
MEASURED_UNIT = "skinglow_unit_mm"
MEASURED_CONE = "skinglow_normal_cone"
MEASURED_BY = "skinglow_measured_by"
SAMPLES = 8


def matrix_of(obj: bpy.types.Object) -> list[float]:
    """The value of MEASURED_MATRIX."""
    return [value for row in obj.matrix_world.to_3x3() for value in row]


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
    return _growth(mesh) * world_size / measured if measured > 0.0 else 1.0


def _growth(mesh: bpy.types.Mesh) -> float:
    """Factor by which the mesh itself was scaled; 1 where it was changed in another way. Asked for at each edit."""
    stored = mesh.get(MEASURED_SAMPLES)
    if stored is None:
        return 1.0
    samples, vertices = stored[:], mesh.vertices
    first, last = tuple(samples[2:5]), tuple(samples[-3:])
    if samples[0] == len(vertices) and first != last:
        # What leaves two points where they are scales nothing, whatever it does to others.
        if vertices[int(samples[1])].co[:] == first and vertices[int(samples[-4])].co[:] == last:
            return 1.0
    return mesh_scale(mesh) or 1.0


def is_reshaped(mesh: bpy.types.Mesh) -> bool:
    """Whether vertices were added, removed, or moved in another way than by scaling and turning all; a quick look."""
    stored = mesh.get(MEASURED_SAMPLES)
    return stored is not None and (stored[0] != len(mesh.vertices) or mesh_scale(mesh) is None)


def mesh_scale(mesh: bpy.types.Mesh) -> float | None:
    """Factor by which the mesh itself was scaled, judged by its samples; None if it was changed in another way."""
    stored = mesh.get(MEASURED_SAMPLES)
    if stored is None:
        return None
    samples, vertices = stored[:], mesh.vertices
    if samples[0] != len(vertices):
        return None
    then = list(zip(samples[2::4], samples[3::4], samples[4::4], strict=True))
    now = [vertices[int(i)].co[:] for i in samples[1::4]]
    # Mostly nothing was changed.
    if now == then:
        return 1.0
    return core().uniform_scale(then, now)


def is_stretched(obj: bpy.types.Object) -> bool:
    """Whether an object of a measured mesh was scaled by unlike factors since, which no one thickness follows."""
    stored, samples = obj.data.get(MEASURED_MATRIX), obj.data.get(MEASURED_SAMPLES)
    now = matrix_of(obj)
    if stored is None or samples is None or list(stored) == now or mesh_scale(obj.data) is None:
        return False
    samples = samples[:]  # as a list, which has slices with steps
    indices = [int(i) for i in samples[1::4]]
    before = np.transpose([samples[2::4], samples[3::4], samples[4::4]]) @ np.reshape(stored, (3, 3)).T
    after = np.array([obj.data.vertices[i].co for i in indices]) @ np.reshape(now, (3, 3)).T
    return core().uniform_scale(before, after) is None
