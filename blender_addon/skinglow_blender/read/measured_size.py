# SPDX-License-Identifier: GPL-3.0-or-later
"""How large a mesh was when its thickness was measured, and how large it is now: its thickness grows with it.

Applying an object's scale moves it from the object into the mesh, and scaling in Edit Mode scales the mesh alone: both
count.
"""

import bpy
import numpy as np
from mathutils import Matrix

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
    if measured <= 0.0:
        return 1.0
    return _growth(mesh, is_resized=world_size != measured) * world_size / measured


def _growth(mesh: bpy.types.Mesh, *, is_resized: bool) -> float:
    """Factor by which the mesh itself was scaled; 1 where it was changed in another way. Asked for at each edit.

    is_resized  whether its object has another size, so that an uneven scale may have been applied, along one axis
    """
    stored = mesh.get(MEASURED_SAMPLES)
    if stored is None:
        return 1.0
    if is_resized:
        return mesh_scale(mesh) or 1.0
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
    """Factor by which the mesh itself was scaled, judged by its samples; None if it was changed in another way.

    Where the object's uneven scale was applied: the mean factor, as the mesh now is what its object was.
    """
    then, now = _samples_then_and_now(mesh)
    # Mostly nothing was changed.
    if then is None or now == then:
        return None if then is None else 1.0
    scale = core().uniform_scale(then, now)
    stored, size = mesh.get(MEASURED_MATRIX), mesh.get(MEASURED_SIZE, 0.0)
    if scale is not None or stored is None or Matrix(np.reshape(stored, (3, 3))).determinant() < 0.0:
        return scale
    scale = core().uniform_scale(np.array(then) @ np.reshape(stored, (3, 3)).T, now)
    return scale * size if scale is not None else None


def is_moved_as_a_whole(mesh: bpy.types.Mesh) -> bool:
    """Whether a mesh was moved, turned or scaled, but not only mirrored, and is the measured one but for that."""
    then, now = _samples_then_and_now(mesh)
    scale = mesh_scale(mesh)
    if then is None or now == then or scale is None:
        return False
    return scale != 1.0 or not core().is_mirrored(then, now)


def _samples_then_and_now(mesh: bpy.types.Mesh) -> tuple[list | None, list]:
    """Positions of the samples; None and nothing if none were stored, or there are other vertices now."""
    stored = mesh.get(MEASURED_SAMPLES)
    if stored is None or stored[0] != len(mesh.vertices):
        return None, []
    samples = stored[:]
    then = list(zip(samples[2::4], samples[3::4], samples[4::4], strict=True))
    return then, [mesh.vertices[int(i)].co[:] for i in samples[1::4]]


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
