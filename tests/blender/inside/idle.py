"""What cannot change a skin is not looked at: counted by how often the scene is read."""

from contextlib import contextmanager

import bpy
import skinglow_blender as sb
from skinglow_blender.live import live_update

from inside.scenes import add_light, assert_shows, depsgraph, link, paper_table, patch


@contextmanager
def counted_readings():
    """The number of times that the scene is read, in a list."""
    count, read_scene = [0], live_update.read_scene

    def counting(graph):
        count[0] += 1
        return read_scene(graph)

    live_update.read_scene = counting
    try:
        yield count
    finally:
        live_update.read_scene = read_scene


def add_empty(name="Empty"):
    return link(bpy.data.objects.new(name, None))


def check_file_without_skins(_work):
    empty, key, obj = add_empty(), add_light(), patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    sb.remove_skin(obj)
    depsgraph()
    with counted_readings() as count:
        for step in range(3):
            empty.location.x = obj.location.x = step
            key.data.energy = 10.0 + step
            depsgraph()
            bpy.context.scene.frame_set(step)
        assert count == [0]
        sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
        assert count[0] > 0


def check_edits_that_move_no_light_and_no_skin(_work):
    key, empty, plain, obj = add_light(), add_empty(), patch("Plain"), patch("Skin")
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    depsgraph()
    with counted_readings() as count:
        empty.location.x = 1.0
        depsgraph()
        plain.location.y = 2.0
        depsgraph()
        plain.data.vertices[0].co.z = 1.0
        plain.data.update()
        depsgraph()
        assert count == [0]
    assert_shows(obj, paper_table([key]))


def check_edits_that_move_a_light_or_a_skin(_work):
    """By themselves, by their parent, their constraint's target, an instancer or their visibility."""
    key, fill, empty, obj = add_light("Key"), add_light("Fill"), add_empty(), patch("Skin")
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    key.parent = empty
    fill.constraints.new("COPY_LOCATION").target = empty
    depsgraph()
    empty.location = (1.0, 2.0, 3.0)
    depsgraph()
    assert_shows(obj, paper_table([key, fill]), ulps=2)
    fill.hide_viewport = True
    assert_shows(obj, paper_table([key]))
    fill.hide_viewport = False
    fill.hide_set(True)
    assert_shows(obj, paper_table([key]))
    fill.hide_set(False)
    assert_shows(obj, paper_table([key, fill]), ulps=2)
    bpy.data.objects.remove(fill)
    assert_shows(obj, paper_table([key]))
    empty.scale = (2.0, 2.0, 2.0)
    assert_shows(obj, paper_table([key]))


def check_occlusion_looks_at_every_object(_work):
    obj, plain = patch("Skin"), patch("Plain")
    sb.make_skin(obj, thickness=[1.0] * 4, mode="physical")
    bpy.context.scene.skinglow.occlusion = True
    depsgraph()
    with counted_readings() as count:
        plain.location.y = 2.0
        depsgraph()
        assert count[0] > 0
