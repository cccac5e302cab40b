"""A skin of mode physical follows the world: each change of it, and nothing else; what the report says of it."""

import math

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb

from inside.scenes import (
    BLOOD,
    add_light,
    assert_shows,
    black_material,
    camera_above,
    depsgraph,
    gray,
    patch,
    render_settings,
)
from inside.world_scenes import (
    CountedReads,
    background,
    coded,
    constant_world,
    decoded,
    directions,
    image_of,
    image_world,
    mapped,
    mean_irradiance,
    set_pixels,
    smooth_radiance,
    store,
    world_tree,
)

THIN = [0.0, 1.0, 2.0, 3.0]


def skin(mode="physical"):
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=THIN, mode=mode)
    return obj


def table(irradiance):
    base = sg.base_lut(sg.TISSUE_PRESETS["light"], 256, 12.0)
    return sg.recolor(base, np.asarray(irradiance) / math.pi).astype(np.float32)


def assert_lit_by(obj, radiance, rtol=1e-5):
    """Lit by this mean radiance, as the handlers left it: nothing is asked for here."""
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), table(math.pi * np.asarray(radiance)), rtol=rtol)


def check_follows_values_and_nodes(_work):
    obj = skin()
    assert not sb.lut(obj, depsgraph()).any()
    node = constant_world((0.8, 0.4, 0.2), 2.0)
    assert_lit_by(obj, (1.6, 0.8, 0.4))
    node.inputs["Strength"].default_value = 0.5
    assert_lit_by(obj, (0.4, 0.2, 0.1))
    node.inputs["Color"].default_value = (0.1, 0.2, 0.4, 1.0)
    assert_lit_by(obj, (0.05, 0.1, 0.2))
    tree = node.id_data
    value = tree.nodes.new("ShaderNodeValue")
    value.outputs[0].default_value = 3.0
    tree.links.new(value.outputs[0], node.inputs["Strength"])
    assert_lit_by(obj, (0.3, 0.6, 1.2))
    value.outputs[0].default_value = 1.0
    assert_lit_by(obj, (0.1, 0.2, 0.4))
    tree.links.remove(node.inputs["Strength"].links[0])
    assert_lit_by(obj, (0.05, 0.1, 0.2))
    bpy.context.view_layer.use_sky = False
    assert_lit_by(obj, (0.0, 0.0, 0.0))
    bpy.context.view_layer.use_sky = True
    assert_lit_by(obj, (0.05, 0.1, 0.2))
    bpy.context.scene.world.cycles_visibility.diffuse = False
    if bpy.app.version < (4, 0, 0):
        # Not reported there.
        sb.update(depsgraph())
    assert_lit_by(obj, (0.0, 0.0, 0.0))
    other = bpy.context.scene.world
    constant_world((1.0, 1.0, 1.0))
    assert_lit_by(obj, (1.0, 1.0, 1.0))
    bpy.context.scene.world = other
    assert_lit_by(obj, (0.0, 0.0, 0.0))
    bpy.context.scene.world = None
    assert_lit_by(obj, (0.0, 0.0, 0.0))


def check_adds_to_the_lights(_work):
    obj = skin()
    add_light(kind="SUN", energy=2.0).data.angle = 0.0
    constant_world((0.25, 0.5, 0.75))
    assert_shows(obj, table(2.0 + math.pi * np.array((0.25, 0.5, 0.75))), ulps=4)


def check_follows_images(_work):
    obj = skin()
    first, second = smooth_radiance(directions(32)), smooth_radiance(directions(16)) ** 2
    image = image_of(first, "First")
    _tree, light, texture = image_world(image)
    assert_lit_by(obj, mean_irradiance(first) / math.pi)
    texture.image = image_of(second, "Second")
    assert_lit_by(obj, mean_irradiance(second) / math.pi)
    light.inputs["Strength"].default_value = 3.0
    assert_lit_by(obj, 3.0 * mean_irradiance(second) / math.pi)
    # Painted pixels are reported by no version: they are seen at the next look at the scene.
    set_pixels(texture.image, 0.5 * second)
    light.inputs["Strength"].default_value = 1.0
    assert_lit_by(obj, 0.5 * mean_irradiance(second) / math.pi)
    set_pixels(texture.image, 2.0 * second)
    assert [r.why for r in sb.update(depsgraph())] == ["world"]
    assert_lit_by(obj, 2.0 * mean_irradiance(second) / math.pi)


def check_follows_files(work):
    """A file that is not there, one that is, and one that was written anew and reloaded; its color space."""
    obj = skin()
    linear = 0.25 + 0.1 * smooth_radiance(directions(16))
    code, darker = coded(linear), coded(0.5 * linear)
    path = work / "sky.png"
    store(code, path)
    image = bpy.data.images.load(str(path))
    image_world(image)
    bright, dim = (mean_irradiance(decoded(c)) / math.pi for c in (code, darker))
    assert_lit_by(obj, bright)
    image.colorspace_settings.name = "Non-Color"
    assert_lit_by(obj, mean_irradiance(code) / math.pi)
    image.colorspace_settings.name = "sRGB"
    assert_lit_by(obj, bright)
    store(darker, path)
    image.reload()
    sb.update(depsgraph())
    assert_lit_by(obj, dim)
    path.rename(work / "moved.png")
    image.reload()
    sb.update(depsgraph())
    assert_lit_by(obj, (0.0, 0.0, 0.0))
    row = sb.light_report(obj, depsgraph())[0]
    assert "no pixels" in row["reason"] and str(path) in row["reason"], row
    image.filepath = str(work / "moved.png")
    sb.update(depsgraph())
    assert_lit_by(obj, dim)


def check_pixels_are_read_once(work):
    obj = skin()
    path = work / "large.png"
    store(np.full((64, 128, 3), 0.5), path)
    with CountedReads() as reads:
        tree, light, texture = image_world(bpy.data.images.load(str(path)))
        depsgraph()
        assert reads.count == 1
        key = add_light()
        for i in range(5):
            light.inputs["Strength"].default_value = 1.0 + i
            depsgraph()
            key.location.x = i
            depsgraph()
        node = mapped(tree, texture.inputs["Vector"], "POINT", (0.1, 0.2, 0.3))
        depsgraph()
        node.inputs["Rotation"].default_value = (0.3, 0.2, 0.1)
        depsgraph()
        sb.update(depsgraph())
        sb.light_report(obj, depsgraph())
        assert reads.count == 1
    with CountedReads() as reads:
        # Paper knows no world, so that a scene of such skins reads no image.
        obj.skinglow.mode = "PAPER"
        texture.image = image_of(np.ones((4, 8, 3)), "Other")
        sb.light_report(obj, depsgraph())
        assert reads.count == 0


def check_nothing_is_computed_where_nothing_changed(_work):
    obj = skin()
    image_world(image_of(smooth_radiance(directions(16))))
    depsgraph()
    before = sb.lut(obj, depsgraph())
    bpy.context.scene.world.mist_settings.start = 3.0
    assert sb.update(depsgraph()) == []
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)


def check_paper_and_existing_know_no_world(_work):
    key = add_light()
    obj = skin("paper")
    lit = sb.lut(obj, depsgraph())
    constant_world((5.0, 5.0, 5.0))
    np.testing.assert_array_equal(sb.lut(obj, depsgraph()), lit)
    world = sb.light_report(obj, depsgraph())[-1]
    assert world["kind"] == "WORLD" and not world["weight"].any() and world["share"] == 0.0
    assert world["reason"] == "only Physical mode uses the world"
    bpy.data.objects.remove(key)
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), gray()[:, None] * BLOOD, rtol=1e-6)
    obj.skinglow.mode = "EXISTING"
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), sg.six_gaussian_lookup(256, 12.0), atol=1e-7)


def check_report(_work):
    obj = skin()
    add_light("Key", kind="SUN", energy=math.pi).data.angle = 0.0
    node = constant_world((0.5, 1.0, 1.5))
    key, world = sb.light_report(obj, depsgraph())
    assert set(key) == set(world)
    assert world["name"] == bpy.context.scene.world.name and world["kind"] == "WORLD" and world["distance"] == 0.0
    np.testing.assert_allclose(world["weight"], math.pi * np.array((0.5, 1.0, 1.5)), rtol=1e-6)
    np.testing.assert_allclose([key["share"], world["share"]], [0.5, 0.5], rtol=1e-6)
    assert world["reason"] == world["note"] == ""
    node.inputs["Strength"].default_value = 0.0
    assert sb.light_report(obj, depsgraph())[1]["reason"] == "its color or strength is 0"
    node.inputs["Strength"].default_value = 1.0
    bpy.context.view_layer.use_sky = False
    assert "view layer" in sb.light_report(obj, depsgraph())[1]["reason"]


def check_what_is_not_followed_is_said(_work):
    obj = skin()
    tree, output = world_tree()
    light = background(tree)
    tree.links.new(light.outputs[0], output.inputs["Surface"])
    sky = tree.nodes.new("ShaderNodeTexSky")
    tree.links.new(sky.outputs[0], light.inputs["Color"])
    row = sb.light_report(obj, depsgraph())[0]
    assert "'Sky Texture' is not supported" in row["reason"] and not row["weight"].any(), row

    tree, _light, texture = image_world(image_of(np.ones((4, 8, 3))))
    node = mapped(tree, texture.inputs["Vector"], "POINT", (0.0, 0.0, 0.5), (1.0, 2.0, 1.0))
    row = sb.light_report(obj, depsgraph())[0]
    assert "non-uniform Scale" in row["note"] and row["weight"].all(), row
    node.inputs["Scale"].default_value = (1.0, 1.0, 1.0)
    node.inputs["Location"].default_value = (0.0, 1.0, 0.0)
    assert "Location" in sb.light_report(obj, depsgraph())[0]["note"]
    node.inputs["Location"].default_value = (0.0, 0.0, 0.0)
    assert sb.light_report(obj, depsgraph())[0]["note"] == ""
    texture.image = None
    assert "no image" in sb.light_report(obj, depsgraph())[0]["reason"]
    infinite = np.ones((4, 8, 3))
    infinite[1, 2] = np.inf
    texture.image = image_of(infinite, "Infinite")
    assert "'Infinite'" in sb.light_report(obj, depsgraph())[0]["reason"]
    assert not sb.lut(obj, depsgraph()).any()


def check_why_says_world(_work):
    obj = skin()
    constant_world()
    obj.skinglow.live = False
    depsgraph()
    assert [r.why for r in sb.update(depsgraph())] == ["world"]


def check_animated_strength(work):
    """In the viewport and, frame by frame, in an animation render."""
    obj = skin()
    camera_above()
    node = constant_world((1.0, 0.5, 0.25))
    scene = render_settings(4, 4)
    for frame, strength in ((1, 1.0), (2, 2.0), (3, 4.0)):
        node.inputs["Strength"].default_value = strength
        node.inputs["Strength"].keyframe_insert("default_value", frame=frame)
    for frame, strength in ((1, 1.0), (3, 4.0), (2, 2.0)):
        scene.frame_set(frame)
        assert_lit_by(obj, strength * np.array((1.0, 0.5, 0.25)))
    rendered = {}

    def record(scene, graph):
        if graph.mode == "RENDER":
            rendered[scene.frame_current] = sb.lut(obj, graph)

    bpy.app.handlers.frame_change_post.append(record)
    scene.frame_start, scene.frame_end = 1, 3
    scene.render.filepath = str(work / "frame_")
    bpy.ops.render.render(animation=True)
    bpy.app.handlers.frame_change_post.remove(record)
    assert sorted(rendered) == [1, 2, 3]
    for frame, strength in ((1, 1.0), (2, 2.0), (3, 4.0)):
        expected = table(strength * math.pi * np.array((1.0, 0.5, 0.25)))
        np.testing.assert_allclose(rendered[frame], expected, rtol=1e-6)
