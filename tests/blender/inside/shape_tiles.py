"""Light in tiles: Blender's pixels against the function that fills them, on everything that may be done to a mesh."""

import bpy
import numpy as np
from mathutils import Euler, Matrix

from inside.scenes import add_light, black_material, camera_above, render_settings
from inside.tile_scenes import ball, fill, function, make_skins, places, render, without_updates

#: 10 m from the origin.
CENTER = np.array((6000.0, -8000.0, 500.0))
SPACING, CELL = 24.0, 40
COLUMNS, ROWS = 3, 2


def bend(obj):
    """An armature of one bone that turns and shifts the mesh."""
    armature = bpy.data.armatures.new("Armature")
    rig = bpy.data.objects.new("Armature", armature)
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = armature.edit_bones.new("Bone")
    bone.head, bone.tail = (0.0, 0.0, 0.0), (0.0, 0.0, 5.0)
    bpy.ops.object.mode_set(mode="OBJECT")
    rig.location = obj.location
    obj.vertex_groups.new(name="Bone").add(range(0, len(obj.data.vertices), 2), 1.0, "REPLACE")
    obj.vertex_groups.new(name="Still").add(range(1, len(obj.data.vertices), 2), 1.0, "REPLACE")
    pose = rig.pose.bones["Bone"]
    pose.rotation_mode, pose.rotation_euler, pose.location = "XYZ", (0.05, 0.1, 0.08), (0.3, 0.2, -0.1)
    obj.modifiers.new("Armature", "ARMATURE").object = rig


def subdivide(obj, levels):
    modifier = obj.modifiers.new("Subdivision", "SUBSURF")
    modifier.levels = modifier.render_levels = levels


def scene_of_balls():
    """Name to world matrix of six skins in a grid, far from the origin: as they are, mirrored, subdivided, bent, as an
    instance, scaled; the first three share a mesh, and all of them a material.
    """
    at = [CENTER + SPACING * np.array((i % COLUMNS - 1.0, i // COLUMNS - 0.5, 0.0)) for i in range(6)]
    plain = ball("Plain", at[0], material=black_material())
    mirrored, smooth = ball("Mirrored", at[1], plain.data), ball("Subdivided", at[2], plain.data)
    plain.rotation_euler = (0.3, 1.2, -0.4)
    mirrored.scale, mirrored.rotation_euler = (-1.0, 1.1, 0.9), (0.2, 0.1, 0.5)
    subdivide(smooth, 2)
    bent, inside, large = (
        ball(name, at[i], plain.data.copy()) for i, name in enumerate(("Bent", "Inside", "Large"), 3)
    )
    bend(bent)
    subdivide(bent, 1)
    large.scale = (1.1, 1.1, 1.1)
    collection = bpy.data.collections.new("Instanced")
    collection.objects.link(inside)
    bpy.context.scene.collection.objects.unlink(inside)
    inside.location = (0.0, 0.0, 0.0)
    instance = bpy.data.objects.new("Instance", None)
    instance.instance_type, instance.instance_collection = "COLLECTION", collection
    instance.location, instance.rotation_euler = at[4], (0.0, 0.4, 1.0)
    bpy.context.scene.collection.objects.link(instance)
    skins = [plain, mirrored, smooth, bent, inside, large]
    bpy.context.view_layer.update()
    matrices = [np.array(obj.matrix_world, np.float64) for obj in skins]
    matrices[4] = np.array(Matrix.Translation(at[4]) @ Euler((0.0, 0.4, 1.0)).to_matrix().to_4x4(), np.float64)
    return skins, matrices


def check_pixels_are_the_function(work):
    """Cycles and EEVEE: root of the mean square at most 1 % of the mean."""
    add_light()
    skins, matrices = scene_of_balls()
    group = make_skins(skins)
    camera_above(COLUMNS * SPACING, CENTER + (0.0, 0.0, 100.0))
    found = {}
    with without_updates():
        fill(group, skins)
        render_settings(COLUMNS * CELL, ROWS * CELL)
        where = places(work / "places.exr", CENTER, 100.0)
        for engine in ("CYCLES", "EEVEE"):
            render_settings(COLUMNS * CELL, ROWS * CELL, engine)
            shown = render(work / f"{engine}.exr")
            for i, (obj, matrix) in enumerate(zip(skins, matrices, strict=True)):
                row, column = divmod(i, COLUMNS)
                cell = np.s_[row * CELL : (row + 1) * CELL, column * CELL : (column + 1) * CELL]
                found[f"{engine} {obj.name}"] = error_of(shown[cell], where[cell], matrix)
    assert max(found.values()) <= 0.01, found
    return found


def error_of(shown, where, matrix):
    """RMS over mean, of the pixels that the ball fills."""
    filled = np.isfinite(where[:, :, 0])
    for axis in (0, 1):
        for step in (-1, 1):
            filled &= np.roll(filled, step, axis)
    assert filled.sum() > 60
    inverse = np.linalg.inv(matrix)
    expected = function(where[filled] @ inverse[:3, :3].T + inverse[:3, 3])
    return float(np.sqrt(np.mean((shown[filled] - expected) ** 2)) / expected.mean())
