"""What renderers show: each frame the lookup of that frame, in Cycles with and without persistent data."""

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.show.lut_image import shown_image

from inside.scenes import (
    BLOOD,
    add_light,
    black_material,
    camera_above,
    depsgraph,
    gray,
    paper_table,
    patch,
    read_exr,
    render_settings,
    strips,
)

FRAMES = 10


def color_at(frame):
    return np.array([1.0 - frame / 20, frame / 10, 0.25 + 0.5 * (frame % 2)])


def height_at(frame):
    return 0.5 + 0.3 * frame


def thicknesses(width):
    return (np.arange(width) + 0.5) / width * 6.0


def scene_with_moving_light(width=16):
    """A patch of strips from 0 to 6 mm thick, one for each pixel, and a light keyed on every frame."""
    key = add_light("Key")
    for frame in range(1, FRAMES + 1):
        key.data.color = color_at(frame)
        key.location = (0.0, 0.0, height_at(frame))
        key.data.keyframe_insert("color", frame=frame)
        key.keyframe_insert("location", frame=frame)
    obj = strips(width, material=black_material())
    sb.make_skin(obj, thickness=np.repeat(thicknesses(width), 4), mode="paper")
    camera_above()
    scene = render_settings(width, 4)
    scene.frame_start, scene.frame_end = 1, FRAMES
    return scene, obj


def expected_frame(frame, width=16, thickest=12.0):
    """The lookup of that frame along the patch's thickness, (width, 3), interpolated as an image is."""
    color = color_at(frame).astype(np.float32).astype(float)
    weight = BLOOD + color / (1.0 + float(np.float32(height_at(frame))) ** 2)
    entries = thicknesses(width) / thickest * 255
    below = np.floor(entries).astype(int)
    share = (entries - below)[:, None]
    table = gray()[:, None] * weight
    return table[below] * (1 - share) + table[below + 1] * share


def assert_frames(folder, tolerance, last=FRAMES):
    for frame in range(1, last + 1):
        picture = read_exr(folder / f"{frame:04d}.exr")
        expected = expected_frame(frame, picture.shape[1])
        np.testing.assert_allclose(picture[1], expected, atol=tolerance, err_msg=f"frame {frame}")
        # Not by chance: the frames before and after differ by far more.
        for other in {max(frame - 1, 1), min(frame + 1, FRAMES)} - {frame}:
            assert np.abs(picture[1] - expected_frame(other, picture.shape[1])).max() > 10 * tolerance


def render_animation(folder):
    scene = bpy.context.scene
    folder.mkdir(exist_ok=True)
    scene.render.filepath = f"{folder}/####"
    bpy.ops.render.render(animation=True)


def check_animation(work):
    scene_with_moving_light()
    render_animation(work / "animation")
    assert_frames(work / "animation", 2e-5)


def check_animation_with_persistent_data(work):
    scene, _ = scene_with_moving_light()
    scene.render.use_persistent_data = True
    for again in ("first", "again"):
        render_animation(work / f"persistent_{again}")
        assert_frames(work / f"persistent_{again}", 2e-5)


def check_animation_with_motion_blur(work):
    """The picture is the frame's own, not that of a step between frames."""
    scene, obj = scene_with_moving_light()
    scene.render.use_motion_blur = True
    # Something that blurs, far from the picture.
    mover = patch("Mover", location=(50.0, 0.0, 0.0))
    mover.keyframe_insert("location", frame=1)
    mover.location.x = 60.0
    mover.keyframe_insert("location", frame=FRAMES)
    render_animation(work / "blur")
    assert_frames(work / "blur", 2e-5)


def check_a_second_scene_whose_time_is_remapped(work):
    """The compositor renders it at the first one's frame, which it maps to another: that is no motion blur step."""
    second, _ = scene_with_moving_light()
    second.render.frame_map_old, second.render.frame_map_new = 100, 50
    for extra in (False, True):
        first = show_in_another_scene(second)
        first.render.use_motion_blur = second.render.use_motion_blur = extra
        first.render.filepath = str(work / "remapped.exr")
        for frame in (2, 4):
            first.frame_set(frame)
            bpy.ops.render.render(write_still=True)
            picture = read_exr(first.render.filepath)
            np.testing.assert_allclose(picture[1], expected_frame(2 * frame), atol=2e-5, err_msg=f"{frame} {extra}")


def show_in_another_scene(second):
    """A scene in the window whose compositor shows a render of the second one, and nothing else."""
    camera = second.camera
    first = bpy.data.scenes.new("First")
    bpy.context.window.scene = first
    first.collection.objects.link(camera)
    first.camera = camera
    render_settings(second.render.resolution_x, second.render.resolution_y)
    if hasattr(first, "compositing_node_group"):
        tree = first.compositing_node_group = bpy.data.node_groups.new("Composite", "CompositorNodeTree")
        tree.interface.new_socket("Image", in_out="OUTPUT", socket_type="NodeSocketColor")
        end = tree.nodes.new("NodeGroupOutput")
    else:
        first.use_nodes = True
        tree = first.node_tree
        tree.nodes.clear()
        end = tree.nodes.new("CompositorNodeComposite")
    for scene in (first, second):  # the last one is shown; a render of its own scene brings about a composite
        layers = tree.nodes.new("CompositorNodeRLayers")
        layers.scene = scene
    tree.links.new(layers.outputs[0], end.inputs[0])
    return first


def check_viewport_and_render_have_lights_of_their_own(work):
    """One light for the viewport only, one for the render only; each sees its own, before, while and after."""
    view, final = add_light("View", color=(1.0, 0.0, 0.0)), add_light("Final", color=(0.0, 0.0, 1.0))
    view.hide_render = True
    final.hide_viewport = True
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[0.0] * 4, mode="paper")
    camera_above()
    render_settings(4, 4).render.filepath = str(work / "own.exr")
    seen = {}

    def while_rendering(_scene, graph):
        if graph.mode == "RENDER":
            seen["render"] = sb.lut(obj, graph)

    bpy.app.handlers.frame_change_post.append(while_rendering)
    try:
        for _ in range(2):
            np.testing.assert_array_max_ulp(sb.lut(obj, depsgraph()), paper_table([view]), 1)
            bpy.ops.render.render(write_still=True)
            np.testing.assert_array_max_ulp(seen["render"], paper_table([final]), 1)
            picture = read_exr(work / "own.exr")
            np.testing.assert_allclose(picture[2, 2], paper_table([final])[0], rtol=1e-5)
            np.testing.assert_array_max_ulp(sb.lut(obj, depsgraph()), paper_table([view]), 1)
            assert "viewport" in shown_image(obj.skinglow.group).name
    finally:
        bpy.app.handlers.frame_change_post.remove(while_rendering)


def check_renamed_excluded_and_linked(work):
    """Rendered: a light renamed, one in an excluded collection, a skin and a light of a library."""
    add_light("Library lamp", color=(0.0, 1.0, 0.0), location=(0.0, 0.0, 2.0))
    sb.make_skin(patch("Library skin", size=1.0, material=black_material()), thickness=[0.0] * 4, mode="paper")
    depsgraph()
    library = str(work / "library.blend")
    bpy.ops.wm.save_as_mainfile(filepath=library)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    with bpy.data.libraries.load(library, link=True) as (_source, target):
        target.objects = ["Library skin", "Library lamp"]
    linked, linked_light = target.objects
    for obj in target.objects:
        bpy.context.scene.collection.objects.link(obj)
    extra = bpy.data.collections.new("Extra")
    bpy.context.scene.collection.children.link(extra)
    key = add_light("Key", color=(1.0, 0.0, 0.0))
    add_light("Left out", color=(0.0, 0.0, 1.0), collection=extra)
    own = patch("Own", size=1.0, location=(1.0, 0.0, 0.0), material=black_material("Own"))
    sb.make_skin(own, thickness=[0.0] * 4, mode="paper", reference_point=(0.0, 0.0, 0.0))
    camera_above(2.0, (0.5, 0.0, 5.0))
    key.name = "Renamed"
    bpy.context.view_layer.layer_collection.children["Extra"].exclude = True
    for red in (1.0, 0.25):
        key.data.color = (red, 0.0, 0.0)
        render_settings(4, 4).render.filepath = str(work / f"linked_{red}.exr")
        bpy.ops.render.render(write_still=True)
        picture = read_exr(work / f"linked_{red}.exr")
        expected = paper_table([key, linked_light])[0]
        np.testing.assert_allclose(picture[2, 0], expected, rtol=1e-5)
        np.testing.assert_allclose(picture[2, 3], expected, rtol=1e-5)
    assert linked.library is not None


def check_view_layers_have_lights_of_their_own(work):
    """A light that one of two view layers excludes; each layer's picture shows its own lookup."""
    scene = bpy.context.scene
    extra = bpy.data.collections.new("Extra")
    scene.collection.children.link(extra)
    key, fill = add_light("Key", color=(1.0, 0.0, 0.0)), add_light("Fill", color=(0.0, 0.0, 1.0), collection=extra)
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[0.0] * 4, mode="paper")
    second = scene.view_layers.new("Second")
    second.layer_collection.children["Extra"].exclude = True
    camera_above()
    render_settings(4, 4)
    pictures = {}

    def keep(_scene, graph):
        if graph.mode == "RENDER":
            pictures[graph.view_layer.name] = sb.lut(obj, graph)

    bpy.app.handlers.frame_change_post.append(keep)
    try:
        bpy.ops.render.render()
    finally:
        bpy.app.handlers.frame_change_post.remove(keep)
    np.testing.assert_array_max_ulp(pictures["ViewLayer"], paper_table([key, fill]), 1)
    np.testing.assert_array_max_ulp(pictures["Second"], paper_table([key]), 1)
    # Each layer rendered by itself, and both at once, give the same pictures.
    for layer, lights in (("ViewLayer", [key, fill]), ("Second", [key])):
        for other in scene.view_layers:
            other.use = other.name == layer
        scene.render.filepath = str(work / f"{layer}.exr")
        bpy.ops.render.render(write_still=True)
        np.testing.assert_allclose(read_exr(work / f"{layer}.exr")[2, 2], paper_table(lights)[0], rtol=1e-5)


def check_a_skin_that_does_not_follow_renders_what_it_shows(work):
    """Live off, on a material with a skin that follows: its row is in the render's image too."""
    material = black_material()
    key = add_light("Key", location=(0.0, 0.0, 4.0))
    follows = patch("Follows", size=1.0, location=(-0.5, 0.0, 0.0), material=material)
    stays = patch("Stays", size=1.0, location=(0.5, 0.0, 0.0), material=material)
    for obj in (follows, stays):
        sb.make_skin(obj, thickness=[0.0] * 4, mode="paper", reference_point=(0, 0, 0))
    stays.skinglow.live = False
    depsgraph()
    before = sb.lut(stays, depsgraph())[0]
    key.data.color = (0.0, 0.0, 1.0)
    depsgraph()
    camera_above(2.0)
    scene = render_settings(4, 4)
    scene.render.filepath = str(work / "stays.exr")
    bpy.ops.render.render(write_still=True)
    left, _, _, right = read_exr(scene.render.filepath)[2]
    np.testing.assert_allclose(right, before, rtol=1e-5)
    np.testing.assert_allclose(left, sb.lut(follows, depsgraph())[0], rtol=1e-5)
    assert abs(left - right).max() > 0.01


def check_a_skin_with_keyed_scale_is_rendered_at_its_own_size(work):
    """What the add-on sets on the object in each frame does not take back its keys to the first one's."""
    add_light("Key")
    obj = patch(size=0.5, material=black_material())
    sb.make_skin(obj, thickness=[0.0] * 4, mode="paper")
    for frame in range(1, 5):
        obj.scale = [frame] * 3
        obj.keyframe_insert("scale", frame=frame)
    camera_above(4.0)
    scene = render_settings(32, 32)
    scene.frame_end = 4
    scene.frame_set(1)
    render_animation(work / "scaled")
    widths = [int(np.count_nonzero(read_exr(work / f"scaled/{f:04d}.exr")[16].max(axis=1))) for f in range(1, 5)]
    assert widths == [4, 8, 12, 16], widths
