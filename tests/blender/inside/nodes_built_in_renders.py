"""Without a window a frame gets the nodes that it needs as it is rendered: in `blender -b -a` nothing else shows it.

What it needs nobody knows before: a large area light has up to eight terms where it is near, and one where it is far.
"""

import bpy
import numpy as np
import skinglow_blender as sb

from inside.lights_that_come_on import FRAMES, as_beside_a_window, close, in_animation, keyed, layout
from inside.material_sockets import node_of
from inside.scenes import add_light, depsgraph, read_exr
from inside.surface_weights import core_lights, expected, pixels, skin


def softbox(z=-0.7):
    """A large area light below the skin."""
    light = add_light("Softbox", kind="AREA", location=(0.2, 0.0, z), energy=500.0)
    light.rotation_euler, light.data.size = (np.pi, 0.0, 0.0), 2.0
    return light


def light_comes(_obj):
    keyed(bpy.data.objects["Softbox"], "location", ((0.2, 0.0, -20.0), (0.2, 0.0, -5.0), (0.2, 0.0, -0.7)))


def skin_comes(obj):
    keyed(obj, "location", ((0.0, 0.0, 20.0), (0.0, 0.0, 5.0), (0.0, 0.0, 0.0)))


def light_grows(_obj):
    keyed(bpy.data.lights["Softbox"], "size", (0.01, 0.5, 2.0))


COMING = (light_comes, skin_comes, light_grows)


def scene(come):
    """A skin that is far from the light at the frame that is shown."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    sb.register()
    softbox(-20.0)
    obj = skin()
    bpy.data.objects["Softbox"].location.z = -0.7 if come != light_comes else -20.0
    # Keyed without an evaluation: nothing sees them near.
    come(obj)
    bpy.context.scene.frame_set(FRAMES[0])
    return obj


def still(work):
    """The picture of the last frame after the viewport has shown it."""
    bpy.context.scene.frame_set(FRAMES[-1])
    sb.update(depsgraph())
    return pixels(work)


def check_what_comes_near_in_an_animation(work):
    for come in COMING:
        obj = scene(come)
        assert layout(obj) == (256, 0, 1, 0), (come.__name__, layout(obj))
        shown, faults = in_animation(work)
        assert faults and not any(faults) and sb.health(obj) == [], (come.__name__, faults)
        assert layout(obj) == (256, 0, 8, 0), layout(obj)
        np.testing.assert_allclose(shown, still(work), rtol=1e-4, atol=1e-6, err_msg=come.__name__)
        close(shown, expected(core_lights()), 0.16, come.__name__)


def check_the_viewport_is_as_before(work):
    """What it shows was laid out for other nodes."""
    obj = scene(light_comes)
    before = sb.lut(obj, depsgraph())
    in_animation(work)
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)
    assert sb.update(depsgraph()) == [] and bpy.context.scene.frame_current == FRAMES[0]
    bpy.data.lights["Softbox"].energy *= 2.0
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), 2.0 * before, rtol=1e-5)
    path = str(work / "rendered.blend")
    bpy.ops.wm.save_as_mainfile(filepath=path)
    bpy.ops.wm.open_mainfile(filepath=path)
    np.testing.assert_allclose(sb.lut(bpy.data.objects["Patch"], depsgraph()), 2.0 * before, rtol=1e-5)


def check_persistent_data_and_keys_of_the_material(work):
    """Each frame has its own nodes, its own pixels and its own keys of the material."""
    obj = scene(light_comes)
    tint = node_of(obj).inputs["Tint"]
    keyed(tint, "default_value", ((1.0, 0.0, 0.0, 1.0), (0.0, 1.0, 0.0, 1.0), (0.5, 0.5, 1.0, 1.0)))
    scene_now = bpy.context.scene
    scene_now.frame_set(FRAMES[0])
    scene_now.render.use_persistent_data = True
    in_animation(work)
    shown = [read_exr(work / f"surface_{frame:04d}.exr") for frame in FRAMES]
    scene_now.render.use_persistent_data = False
    for frame, picture in zip(FRAMES, shown, strict=True):
        scene_now.frame_set(frame)
        sb.update(depsgraph())
        np.testing.assert_allclose(picture, pixels(work), rtol=1e-4, atol=1e-6, err_msg=f"frame {frame}")
    assert shown[0][:, :, 1].max() == 0.0 < shown[1][:, :, 1].max()


def check_beside_a_window_the_nodes_stay(work):
    """What they have room for is shown, and that it is too little is told."""
    obj = scene(skin_comes)
    with as_beside_a_window():
        shown, _faults = in_animation(work)
        assert layout(obj) == (256, 0, 1, 0), layout(obj)
        (fault,) = sb.health(obj)
        text = str(fault)
        assert "'Softbox'" in text and "coarser" in text and "show this frame in the viewport once" in text, text
        assert "Render of frame 3" in text
        # The remedy that it names.
        wanted = still(work)
        assert np.abs(shown - wanted).max() > 0.1 * wanted.max() and sb.health(obj) == []
        bpy.context.scene.frame_set(FRAMES[0])
        sb.update(depsgraph())
        shown, faults = in_animation(work)
        assert not any(faults) and sb.health(obj) == []
        np.testing.assert_allclose(shown, wanted, rtol=1e-4, atol=1e-6)
