"""Keyed and driven settings of skins act in each rendered frame, whatever the live update writes meanwhile."""

import bpy
import numpy as np

from inside.material_sockets import node_of, picture, skin_scene
from inside.scenes import read_exr, render_settings

FRAMES = (1, 2, 3)


def key(owner, path, values):
    """Keys a property at the first and the last frame."""
    for frame, value in zip((FRAMES[0], FRAMES[-1]), values, strict=True):
        bpy.context.scene.frame_set(frame)
        setattr(owner, path.rpartition(".")[2], value)
        owner.keyframe_insert(path.rpartition(".")[2], frame=frame)


def rendered(work):
    """The pictures of all frames, while the viewport shows the second one."""
    scene = render_settings(4, 4)
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    scene.frame_set(2)
    scene.render.filepath = f"{work}/keyed_####"
    bpy.ops.render.render(animation=True)
    return [read_exr(work / f"keyed_{frame:04d}.exr") for frame in FRAMES]


def check_keyed_tint_under_a_light_that_changes(work):
    """Each frame has another lookup, which is put into the nodes while it renders: their keys still hold."""
    for weights in ("object", "surface"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        obj = skin_scene(weights)
        before = picture(work)
        key(node_of(obj).inputs["Tint"], "default_value", ((1.0, 0.0, 0.0, 1.0), (0.0, 0.0, 1.0, 1.0)))
        key(bpy.data.lights["Lamp"], "energy", (100.0, 300.0))
        factors = ((1.0, 0.0, 0.0), (1.0, 0.0, 1.0), (0.0, 0.0, 3.0))
        for shown, factor in zip(rendered(work), factors, strict=True):
            np.testing.assert_allclose(shown, before * np.array(factor), rtol=1e-4, atol=1e-7)


def check_keyed_strength_of_an_object_that_moves(work):
    """The object's property is written in each frame: where it is then still is where its keys put it."""
    obj = skin_scene()
    obj.skinglow.reference = "POINT"
    before = picture(work)
    key(obj.skinglow, "strength", (1.0, 3.0))
    key(obj, "location", ((1.0, 0.0, 0.0), (-1.0, 0.0, 0.0)))
    places = (slice(2, 4), slice(0, 4), slice(0, 2))
    for shown, strength, columns in zip(rendered(work), (1.0, 2.0, 3.0), places, strict=True):
        expected = np.zeros_like(before)
        expected[:, columns] = strength * before[:, columns]
        np.testing.assert_allclose(shown, expected, rtol=1e-4, atol=1e-7)


def check_driven_strength_and_mask(work):
    """Strength driven by a keyed property of the object, Mask by the frame."""
    obj = skin_scene()
    node = node_of(obj)
    before = picture(work)
    for frame, value in ((1, 1.0), (3, 5.0)):
        obj["glow"] = value
        obj.keyframe_insert('["glow"]', frame=frame)
    driver = node.inputs["Strength"].driver_add("default_value").driver
    driver.type = "AVERAGE"
    variable = driver.variables.new()
    variable.targets[0].id, variable.targets[0].data_path = obj, '["glow"]'
    driver = node.inputs["Mask"].driver_add("default_value").driver
    driver.type, driver.expression = "SCRIPTED", "frame / 4"
    key(bpy.data.lights["Lamp"], "energy", (100.0, 300.0))
    for frame, shown, glow in zip(FRAMES, rendered(work), (1.0, 3.0, 5.0), strict=True):
        np.testing.assert_allclose(shown, before * frame * glow * frame / 4, rtol=1e-4)
