"""What asks for other texels is seen through them at once: in background mode nothing looks a second time by itself."""

import bpy
import skinglow_blender as sb
from skinglow_blender.live.windows import update_windows
from skinglow_blender.session import SESSION
from skinglow_blender.thickness.tile_attribute import TILES_OF_MESH

from inside.scenes import black_material, depsgraph
from inside.shape_scenes import assert_through, lobe, shape_skin, sun


def body(**settings):
    sun()
    obj = lobe(levels=2, material=black_material())
    shape_skin(obj, **settings)
    return obj


def assert_in_time(obj):
    """After one evaluation, as of a script that edits and saves, the skin is not behind."""
    graph = depsgraph()
    assert [rebuilt.why for rebuilt in sb.update(graph)] == []
    assert_through(obj, graph=graph)


def store_smaller(obj):
    """Half as large and as thick, lit in another way: its tiles stay those of before until light goes through them."""
    obj.scale = (0.5, 0.5, 0.5)
    depsgraph()
    sb.make_skin(obj, thickness=[1.5] * len(obj.data.vertices), mode="paper")


def check_tiles_for_another_thickness_are_shown_at_once(_work):
    """Found by random edits: a skin whose mode was changed showed its light in the texels of before."""
    obj = body()
    assert_in_time(obj)
    rows = obj.data[TILES_OF_MESH]["rows"]
    store_smaller(obj)
    assert obj.data[TILES_OF_MESH]["rows"] == rows
    obj.skinglow.mode = "PHYSICAL"
    assert_in_time(obj)
    assert obj.data[TILES_OF_MESH]["rows"] < rows


def check_first_tiles_are_shown_at_once(_work):
    obj = body(weights="object")
    assert TILES_OF_MESH not in obj.data
    obj.skinglow.weights = "SHAPE"
    assert_in_time(obj)


def check_a_window_evaluates_them_before_it_shows_them(_work):
    """There a timer stores them, a moment after the edit was evaluated: it refused them as beyond the image."""
    obj = body()
    store_smaller(obj)
    before = bpy.app.handlers.depsgraph_update_pre
    (handler,) = (each for each in before if each.__name__ == "before_depsgraph_update")
    before.remove(handler)
    try:
        obj.skinglow.mode = "PHYSICAL"
        depsgraph()
        update_windows()
        assert not SESSION.faults, SESSION.faults
        assert_in_time(obj)
    finally:
        before.append(handler)
