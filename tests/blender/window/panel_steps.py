"""Runs in a Blender with a window: what people do with the panel, by real clicks and keys; facts as JSON lines.

Arguments after "--": the file of facts, the picture; the folders of the add-on and the core.
"""

import json
import sys
import time
from pathlib import Path

facts_file, picture, addon_folder, core_folder = sys.argv[sys.argv.index("--") + 1 :]
sys.path[:0] = [str(Path(__file__).parent), addon_folder]
sys.path.append(core_folder)

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from panel_scene import build_scene  # noqa: E402
from skinglow_blender import blender_version  # noqa: E402
from skinglow_blender.commands.health import quick_faults  # noqa: E402
from skinglow_blender.session import SESSION  # noqa: E402
from skinglow_blender.thickness import thickness_attribute  # noqa: E402
from skinglow_blender.ui import light_list, main_panel  # noqa: E402
from window_steps import (  # noqa: E402
    area_of,
    click,
    in_view,
    open_sidebar,
    press,
    region_of,
    run_steps,
    save_picture,
    wait_for,
)

PATIENCE = 120.0


def tell(name, value):
    with open(facts_file, "a") as facts:
        facts.write(json.dumps({"fact": name, "value": value}) + "\n")


def head():
    return bpy.data.objects["Head"]


def is_skin():
    return head().skinglow.enabled


def thickness():
    attribute = head().data.attributes[thickness_attribute.THICKNESS_ATTRIBUTE]
    values = np.empty(len(attribute.data), np.float32)
    attribute.data.foreach_get("value", values)
    return values


def shown():
    return sb.lut(head(), bpy.context.view_layer.depsgraph)


def redraw():
    for area in bpy.context.window_manager.windows[0].screen.areas:
        area.tag_redraw()


def measuring():
    return SESSION.measuring is not None


def press_in_view(key, **with_keys):
    area = area_of("VIEW_3D")
    yield from press(key, area.x + 300, area.y + 300, **with_keys)


def steps():
    with in_view():
        build_scene()
        bpy.ops.ed.undo_push(message="scene")
    yield 0.5
    yield from open_sidebar("Skinglow", bpy.types.SKINGLOW_PT_sidebar)
    with in_view():
        save_picture(picture.replace(".png", "_before.png"))
    yield from the_button_and_undo()
    yield from the_list()
    yield from a_canceled_measuring()
    yield from a_measuring_to_its_end()
    yield from a_moved_light()
    yield from every_part_of_the_panel()
    yield from every_part_of_the_material()
    with in_view():
        save_picture(picture)


def the_button_and_undo():
    sidebar = region_of(area_of("VIEW_3D"), "UI")
    yield from click(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - 52)
    yield from wait_for(is_skin, PATIENCE, "the button")
    tell("the button made a skin", [float(thickness().min()), float(thickness().max())])
    table = shown()
    yield from press_in_view("Z", ctrl=True)
    yield from wait_for(lambda: not is_skin(), PATIENCE, "undo")
    tell("undo left", [is_skin(), len(bpy.data.node_groups), head().data.attributes.keys().count("skinglow_thickness")])
    yield from press_in_view("Z", ctrl=True, shift=True)
    yield from wait_for(is_skin, PATIENCE, "redo")
    yield 1.0
    tell("redo shows the same table", bool(np.array_equal(shown(), table)))


def the_list():
    lists = bpy.context.window_manager.skinglow_lists
    redraw()
    yield from wait_for(lambda: len(lists) and len(lists[0].rows), PATIENCE, "the list of lights")
    # What a thread finds of the light through the shape is shown as it comes.
    yield from wait_for(lambda: not (SESSION.shape_worker and SESSION.shape_worker.is_busy), PATIENCE, "the light")
    yield 1.0
    tell("rows", [[row.name, round(row.share, 3), row.reason] for row in lists[0].rows])
    drawn, computed = [], []
    list_of, report = light_list.list_of, light_list.light_report
    light_list.list_of = lambda *given: drawn.append(1) or list_of(*given)
    light_list.light_report = lambda *given: computed.append(1) or report(*given)
    looks = SESSION.updates
    for _ in range(10):
        redraw()
        yield 0.2
    light_list.list_of, light_list.light_report = list_of, report
    tell("redraws, computed, looks", [len(drawn), len(computed), SESSION.updates - looks])


def a_canceled_measuring():
    before = thickness()
    head().skinglow.rays = 4096
    with in_view():
        bpy.ops.ed.undo_push(message="rays")
        tell("bake began as", list(bpy.ops.skinglow.measure_thickness("INVOKE_DEFAULT")))
    yield from wait_for(lambda: SESSION.measuring.done > 0.0, PATIENCE, "progress")
    redraw()
    yield 0.5
    with in_view():
        save_picture(picture.replace(".png", "_measuring.png"))
    asked = time.monotonic()
    yield from press_in_view("ESC")
    yield from wait_for(lambda: not measuring(), PATIENCE, "Esc")
    tell("seconds to cancel", time.monotonic() - asked)
    tell("canceling kept the thickness", bool(np.array_equal(thickness(), before)))
    yield from press_in_view("Z", ctrl=True)
    yield 1.0
    # The step before is undone, and not one that canceling left.
    tell("rays after canceling and undo", head().skinglow.rays)


def a_measuring_to_its_end():
    attribute = head().data.attributes[thickness_attribute.THICKNESS_ATTRIBUTE]
    attribute.data.foreach_set("value", np.full(len(attribute.data), 3.0, np.float32))
    with in_view():
        bpy.ops.ed.undo_push(message="by hand")
        bpy.ops.skinglow.measure_thickness("INVOKE_DEFAULT")
    yield from wait_for(lambda: not measuring(), PATIENCE, "measuring")
    yield 0.5
    tell("measured in the window", [float(thickness().min()), float(thickness().max())])
    yield from press_in_view("Z", ctrl=True)
    yield from wait_for(lambda: (thickness() == 3.0).all(), PATIENCE, "undo of measuring")
    yield from press_in_view("Z", ctrl=True, shift=True)
    yield from wait_for(lambda: not (thickness() == 3.0).all(), PATIENCE, "redo of measuring")
    tell("measuring undone and redone", True)


def a_moved_light():
    table = shown()
    bpy.data.objects["Rim red"].location.x = -1.0
    yield from wait_for(lambda: not np.array_equal(shown(), table), PATIENCE, "the moved lamp")
    tell("the lookup followed a moved lamp", True)


def every_part_of_the_panel():
    settings = head().skinglow
    for mode, more in (
        ("EXISTING", {}),
        ("PHYSICAL", {"reference": "POINT"}),
        ("PAPER", {"base": "SKIN"}),
        ("PAPER", {"base": "IMAGE"}),  # without one: the fault stands in the panel
    ):
        settings.mode = mode
        for name, value in more.items():
            setattr(settings, name, value)
        yield 0.5
        redraw()
        yield 0.5
    tell("faults shown", list(SESSION.faults.values()))
    settings.base = "BUILTIN"
    lists = bpy.context.window_manager.skinglow_lists
    for i in range(len(lists[0].rows)):
        lists[0].active = i
        redraw()
        yield 0.3
    light = bpy.data.objects["Rim red"]
    bpy.context.view_layer.objects.active = light
    redraw()
    yield 0.5
    bpy.context.view_layer.objects.active = head()
    redraw()
    yield 1.0


def every_part_of_the_material():
    obj = head()
    obj.data.materials.append(bpy.data.materials.new("Eyes"))
    skin = obj.material_slots[0].material
    obj.vertex_groups.new(name="Ears")
    principled = next(n for n in skin.node_tree.nodes if n.bl_idname == "ShaderNodeBsdfPrincipled")
    blender_version.socket_named(principled.inputs, "Subsurface Weight", "Subsurface").default_value = 0.5
    area_of("PROPERTIES").spaces.active.context = "MATERIAL"
    for mask in ("VERTEX_GROUP", "IMAGE", "NONE"):
        skin.skinglow.mask, skin.skinglow.mask_group = mask, "Ears"
        redraw()
        yield 0.5
    with in_view():
        save_picture(picture.replace(".png", "_material.png"))
    tell("hints", [fault.what for fault in quick_faults(obj) if fault.is_hint])
    for i in (1, 0):
        obj.active_material_index = i
        redraw()
        yield 0.5


# Closed parts are not drawn.
for part in main_panel.CLASSES:
    part.bl_options = set()
sb.register()
run_steps(steps)
