"""The world on a white Lambert plane that faces many ways: what Cycles renders, against the core, to 0.5 %."""

import math

import bpy
import numpy as np
from mathutils import Vector
from skinglow_blender.read import scene_world

from inside.light_units import AGREEMENT, rendered_irradiance, stage
from inside.scenes import depsgraph, link
from inside.world_scenes import (
    NORMALS,
    background,
    coded,
    constant_world,
    directions,
    image_of,
    image_world,
    mapped,
    smooth_irradiance,
    smooth_radiance,
    world_tree,
)


def plane_facing(normal):
    """Turns the stage: the plane faces along the normal, the camera looks at it."""
    turn = Vector(normal).to_track_quat("Z", "Y")
    for obj in bpy.context.scene.objects:
        if obj.type == "EMPTY":
            continue
        obj.rotation_euler = turn.to_euler()
        if obj.type == "CAMERA":
            obj.location = turn @ Vector((0.0, 0.0, 0.5))


def seen(work, normal):
    plane_facing(normal)
    return rendered_irradiance(work, bpy.context.scene)


def core_irradiance(normals=NORMALS):
    world = scene_world.read_world(depsgraph())
    assert not world.note, world.note
    return world.environment.irradiance(np.array(normals))


def assert_agrees(work, normals, expected=None, tolerance=AGREEMENT):
    """The core with Cycles, and with what is expected where that is known; returns the largest difference."""
    ours = core_irradiance(normals)
    if expected is not None:
        np.testing.assert_allclose(ours, expected, rtol=tolerance)
    rendered = np.array([seen(work, normal) for normal in normals])
    off = np.abs(rendered / ours - 1.0)
    assert off.max() < tolerance, f"Cycles {rendered}, core {ours}"
    return float(off.max())


def check_constant_colors(work):
    stage(64)
    color = np.array((0.8, 0.4, 0.2))
    node = constant_world(color, 2.5)
    found = [assert_agrees(work, NORMALS[::2], np.tile(2.5 * math.pi * color, (3, 1)))]
    tree = node.id_data
    rgb, value = tree.nodes.new("ShaderNodeRGB"), tree.nodes.new("ShaderNodeValue")
    rgb.outputs[0].default_value, value.outputs[0].default_value = (0.1, 0.9, 0.5, 1.0), 0.7
    tree.links.new(rgb.outputs[0], node.inputs["Color"])
    tree.links.new(value.outputs[0], node.inputs["Strength"])
    found.append(assert_agrees(work, NORMALS[:1], [0.7 * math.pi * np.array((0.1, 0.9, 0.5))]))
    if bpy.app.version < (5, 0, 0):
        bpy.context.scene.world.use_nodes = False
        bpy.context.scene.world.color = (0.3, 0.6, 0.9)
        found.append(assert_agrees(work, NORMALS[:1], [math.pi * np.array((0.3, 0.6, 0.9))]))
    return found


def check_mixed_and_added(work):
    stage(64)
    tree, output = world_tree()
    one, other = background(tree, (1.0, 0.5, 0.25)), background(tree, (0.25, 0.5, 1.0))
    mix, add = tree.nodes.new("ShaderNodeMixShader"), tree.nodes.new("ShaderNodeAddShader")
    mix.inputs[0].default_value = 0.25
    tree.links.new(one.outputs[0], mix.inputs[1])
    tree.links.new(other.outputs[0], mix.inputs[2])
    tree.links.new(mix.outputs[0], output.inputs["Surface"])
    found = [assert_agrees(work, NORMALS[:1], [math.pi * np.array((0.8125, 0.5, 0.4375))])]
    path = tree.nodes.new("ShaderNodeLightPath")
    tree.links.new(path.outputs["Is Camera Ray"], mix.inputs[0])
    found.append(assert_agrees(work, NORMALS[:1], [math.pi * np.array((1.0, 0.5, 0.25))]))
    tree.links.new(one.outputs[0], add.inputs[0])
    tree.links.new(other.outputs[0], add.inputs[1])
    tree.links.new(add.outputs[0], output.inputs["Surface"])
    found.append(assert_agrees(work, NORMALS[:1], [math.pi * np.array((1.25, 1.0, 1.25))]))
    return found


def check_dark_worlds(work):
    """Cycles sees none of them, and each says why."""
    stage(16)
    node = constant_world()
    world, layer = bpy.context.scene.world, bpy.context.view_layer

    def why():
        assert not seen(work, NORMALS[0]).any()
        read = scene_world.read_world(depsgraph())
        assert read.irradiance == (0.0, 0.0, 0.0)
        return read.unlit_reason or read.note

    layer.use_sky = False
    assert "view layer" in why()
    layer.use_sky = True
    world.cycles_visibility.diffuse = False
    assert "ray visibility" in why()
    world.cycles_visibility.diffuse = True
    node.inputs["Strength"].default_value = 0.0
    assert why() == ""
    node.id_data.links.clear()
    assert "no shader" in why()
    bpy.context.scene.world = None
    assert not seen(work, NORMALS[0]).any() and scene_world.read_world(depsgraph()) is None


def check_smooth_image(work):
    """Of bands l <= 2 alone: nine coefficients are all of it."""
    stage(256)
    image_world(image_of(smooth_radiance(directions(64))), strength=1.5)
    return assert_agrees(work, NORMALS, 1.5 * smooth_irradiance(np.array(NORMALS)))


def check_turned_images(work):
    stage(128)
    image = image_of(smooth_radiance(directions(64)))
    turn = (0.4, -0.9, 2.1)
    holder = link(bpy.data.objects.new("Holder", None))
    holder.rotation_euler = turn
    found = {}
    for name, kind, scale in (
        ("point", "POINT", (1.0, 1.0, 1.0)),
        ("texture, mirrored", "TEXTURE", (1.0, -1.0, 1.0)),
        ("vector, larger", "VECTOR", (2.0, 2.0, 2.0)),
        ("normal, mirrored", "NORMAL", (-1.0, 1.0, 1.0)),
        ("twice", "POINT", (1.0, 1.0, -1.0)),
    ):
        tree, _light, texture = image_world(image)
        node = mapped(tree, texture.inputs["Vector"], kind, turn, scale, None if name == "twice" else "Generated")
        if name == "twice":
            mapped(tree, node.inputs["Vector"], "TEXTURE", (0.0, 0.0, 1.0))
        still = smooth_irradiance(np.array(NORMALS[::4]))
        assert abs(core_irradiance(NORMALS[::4]) / still - 1.0).max() > 0.05, "the turn shows nothing"
        found[name] = assert_agrees(work, NORMALS[::4])
    tree, _light, texture = image_world(image)
    coordinate = tree.nodes.new("ShaderNodeTexCoord")
    coordinate.object = holder
    tree.links.new(coordinate.outputs["Object"], texture.inputs["Vector"])
    found["object"] = assert_agrees(work, NORMALS[::4])
    return found


def check_bytes(work):
    """8-bit pictures: sRGB is decoded, data is not."""
    stage(128)
    linear = 0.25 + 0.1 * smooth_radiance(directions(64))
    expected = 0.25 * math.pi + 0.1 * smooth_irradiance(np.array(NORMALS[::4]))
    image_world(image_of(coded(linear), is_float=False))
    found = [assert_agrees(work, NORMALS[::4], expected)]
    image_world(image_of(linear, is_float=False, colorspace="Non-Color"))
    found.append(assert_agrees(work, NORMALS[::4], expected))
    # A picture of half the coverage shows half of each code.
    image = bpy.data.images.new("Covered", 32, 16, alpha=True)
    image.pixels.foreach_set(np.tile(np.array((0.8, 0.6, 0.4, 0.5), np.float32), 32 * 16))
    image.update()
    image.filepath_raw, image.file_format = str(work / "covered.png"), "PNG"
    image.save()
    image_world(bpy.data.images.load(image.filepath_raw))
    found.append(assert_agrees(work, NORMALS[::4]))
    return found


def check_mirror_ball(work):
    stage(256)
    size = 256
    middles = 2.0 * (np.arange(size) + 0.5) / size - 1.0
    x, z = np.meshgrid(middles, middles)
    y = -np.sqrt(np.maximum(1.0 - x * x - z * z, 0.0))
    reflected = np.stack([-2.0 * y * x, 1.0 - 2.0 * y * y, -2.0 * y * z], axis=-1)
    image_world(image_of(smooth_radiance(reflected)), projection="MIRROR_BALL")
    return assert_agrees(work, NORMALS, smooth_irradiance(np.array(NORMALS)))


def check_bright_spot(work):
    """Nine coefficients are not all of a sun: what they are off by is measured, and the object weight is exact."""
    stage(4096)
    height = 256
    d = directions(height)
    toward = np.array((0.6, 0.0, 0.8))
    radiance = np.where((d @ toward > math.cos(0.1))[..., None], (40.0, 30.0, 20.0), (0.05, 0.05, 0.05))
    image_world(image_of(radiance))
    area = np.sin(np.pi * (np.arange(height) + 0.5) / height)[:, None] * (np.pi / height) ** 2
    exact = np.array([(radiance * (area * np.maximum(d @ n, 0.0))[..., None]).sum(axis=(0, 1)) for n in NORMALS])
    rendered = np.array([seen(work, normal) for normal in NORMALS])
    np.testing.assert_allclose(rendered, exact, rtol=0.02)
    ours = core_irradiance()
    peak = (radiance * (area * np.maximum(d @ toward, 0.0))[..., None]).sum(axis=(0, 1))
    off = np.abs(ours - exact) / peak
    # A point of light: 3/32 of its greatest irradiance at the horizon (bands 0 to 2 of the clamped cosine).
    assert 0.01 < off.max() < 0.1, off
    mean = math.pi * (radiance * area[..., None]).sum(axis=(0, 1)) / (4.0 * math.pi)
    np.testing.assert_allclose(scene_world.read_world(depsgraph()).irradiance, mean, rtol=1e-3)
    return float(off.max())
