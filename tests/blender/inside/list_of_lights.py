"""The panel's list of lights: complete, the strongest first, and not computed again while nothing changed."""

from types import SimpleNamespace

import bpy
import numpy as np
import skinglow_blender as sb
from skinglow_blender.commands import light_listing
from skinglow_blender.identity import key_of
from skinglow_blender.live import handlers
from skinglow_blender.preferences import follows_lights
from skinglow_blender.session import SESSION
from skinglow_blender.ui import light_list
from skinglow_blender.ui.lights_panel import length_text

from inside.scenes import add_light, depsgraph, patch

sb.register()


def skin():
    obj = patch()
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    return obj


def redraw(obj):
    """What draw() asks for, and what the timer then does; how many lists were filled."""
    context = SimpleNamespace(
        scene=bpy.context.scene, view_layer=bpy.context.view_layer, window_manager=bpy.context.window_manager
    )
    light_list.list_of(obj, context)
    filled = light_list.fill_requested()
    return light_list.list_of(obj, context), filled


def check_a_hundred_lights(_work):
    for i in range(100):
        add_light(f"Lamp {i:03}", location=(0.0, 0.0, 1.0 + (i * 37) % 100), energy=0.0 if i % 10 == 0 else 1.0)
    obj = skin()
    lights, _filled = redraw(obj)
    report = {row["name"]: row for row in sb.light_report(obj, depsgraph())}
    assert len(lights.rows) == 100 and {row.name for row in lights.rows} == set(report)
    shares = [row.share for row in lights.rows]
    assert shares == sorted(shares, reverse=True) and shares[0] > 0.1
    np.testing.assert_allclose(sum(shares), 1.0, rtol=1e-5)
    for row in lights.rows:
        np.testing.assert_allclose(row.weight, report[row.name]["weight"], rtol=1e-6)
        assert row.reason == report[row.name]["reason"]
    dark = [row for row in lights.rows if row.reason]
    assert len(dark) == 10 and all("zero power" in row.reason for row in dark)
    assert all(not row.reason for row in lights.rows[:90])


def check_redraws_compute_nothing(_work):
    add_light("Key")
    obj = skin()
    calls = []
    report = light_list.light_report
    light_list.light_report = lambda *given: calls.append(given) or report(*given)
    try:
        redraw(obj)
        assert len(calls) == 1
        looks = SESSION.updates
        depsgraph()
        for _ in range(100):
            assert redraw(obj)[1] == 0
        assert len(calls) == 1
        # Filling a list is no edit: it would call for the next filling without end.
        depsgraph()
        assert SESSION.updates == looks
        bpy.data.objects["Key"].location.z = 2.0
        depsgraph()
        lights, filled = redraw(obj)
        assert filled == 1 and len(calls) == 2
        np.testing.assert_allclose(lights.rows[0].distance, 2.0, rtol=1e-6)
    finally:
        light_list.light_report = report


def check_the_list_follows_edits(_work):
    key = add_light("Key")
    obj = skin()
    assert [row.name for row in redraw(obj)[0].rows] == ["Key"]
    add_light("Bright", color=(5.0, 5.0, 5.0))
    depsgraph()
    lights = redraw(obj)[0]
    assert [row.name for row in lights.rows] == ["Bright", "Key"]
    lights.active = 1
    key.name = "Main"
    bpy.data.objects["Bright"].hide_set(True)
    depsgraph()
    lights = redraw(obj)[0]
    assert [(row.name, row.reason) for row in lights.rows] == [("Main", ""), ("Bright", "hidden in the viewport")]
    assert tuple(lights.rows[0].swatch) == (1.0, 1.0, 1.0)
    bpy.data.objects.remove(key)
    depsgraph()
    lights = redraw(obj)[0]
    assert [row.name for row in lights.rows] == ["Bright"] and lights.active == 0


def check_the_chosen_light_stays_chosen(_work):
    key, rim = add_light("Key"), add_light("Rim", color=(0.1, 0.1, 0.1))
    obj = skin()
    lights = redraw(obj)[0]
    lights.active = 1
    assert lights.rows[1].name == "Rim"
    rim.data.color, key.data.color = (1.0, 1.0, 1.0), (0.1, 0.1, 0.1)
    depsgraph()
    lights = redraw(obj)[0]
    assert lights.rows[0].name == "Rim" and lights.active == 0


def check_a_list_for_each_skin_and_none_for_the_gone(_work):
    add_light("Key")
    first = skin()
    redraw(first)
    second = skin()
    assert first.name != second.name
    redraw(second)
    redraw(first)
    lists = bpy.context.window_manager.skinglow_lists
    assert sorted(one.name for one in lists) == sorted(map(key_of, (first, second)))
    bpy.data.objects.remove(first)
    third = patch("Third")
    sb.make_skin(third, thickness=[1.0] * 4, mode="paper")
    redraw(third)
    assert sorted(one.name for one in lists) == sorted(map(key_of, (second, third)))


def check_unregistering_leaves_no_list(_work):
    add_light("Key")
    redraw(skin())
    sb.unregister()
    try:
        assert not hasattr(bpy.types.WindowManager, "skinglow_lists")
        assert not any(name.startswith("skinglow") for name in bpy.context.window_manager.keys())
    finally:
        sb.register()
    assert len(bpy.context.window_manager.skinglow_lists) == 0


def check_distances_in_units_of_the_scene(_work):
    units = bpy.context.scene.unit_settings
    units.system, units.scale_length = "METRIC", 0.001
    assert length_text(2.516, bpy.context.scene) == "2.516 mm"
    units.scale_length = 1.0
    assert length_text(0.21134567, bpy.context.scene) == "21.13 cm"
    units.system = "NONE"
    assert length_text(0.21134567, bpy.context.scene) == "0.2113"


def check_a_report_takes_what_the_update_read(_work):
    """The scene is read once for both; anew where no update followed a change, and for a skin that is hidden."""
    key = add_light("Key")
    obj = skin()
    reads = []
    read_scene = light_listing.read_scene
    light_listing.read_scene = lambda *given: reads.append(given) or read_scene(*given)

    def told():
        del reads[:]
        (row,) = sb.light_report(obj, depsgraph())
        return row["weight"].tolist(), len(reads)

    try:
        white = [0.5, 0.5, 0.5]
        assert told() == (white, 0)
        key.data.color = (1.0, 0.0, 0.0)
        assert told() == ([0.5, 0.0, 0.0], 0)
        handlers.follows_lights = lambda: False
        key.data.color = (1.0, 1.0, 1.0)
        assert told() == (white, 1)
        handlers.follows_lights = follows_lights
        sb.update(depsgraph())
        assert told() == (white, 0)
        obj.hide_set(True)
        assert told() == (white, 1)
    finally:
        light_listing.read_scene, handlers.follows_lights = read_scene, follows_lights
