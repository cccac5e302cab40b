"""Runs in a Blender with a window: thickness in the panel and over the skin; facts as JSON lines, and pictures.

Arguments after "--": the file of facts; the folders of the add-on and the core.
"""

import json
import sys
from pathlib import Path

facts_file, addon_folder, core_folder = sys.argv[sys.argv.index("--") + 1 :]
sys.path[:0] = [str(Path(__file__).parent), addon_folder]
sys.path.append(core_folder)

import bpy  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from panel_scene import build_scene  # noqa: E402
from skinglow_blender.session import SESSION  # noqa: E402
from skinglow_blender.thickness.thickness_attribute import SUMMARY  # noqa: E402
from skinglow_blender.ui import heat_map, main_panel, thickness_panel  # noqa: E402
from window_steps import area_of, in_view, open_sidebar, run_steps, save_picture, wait_for, window  # noqa: E402

FOLDER = Path(facts_file).parent


def tell(name, value):
    with open(facts_file, "a") as facts:
        facts.write(json.dumps({"fact": name, "value": value}) + "\n")


def picture(name):
    for area in bpy.context.window_manager.windows[0].screen.areas:
        area.tag_redraw()
    yield 0.7
    with in_view():
        save_picture(str(FOLDER / f"{name}.png"))


def steps():
    with in_view():
        head = build_scene()
        head.skinglow.unit_mm = 60.0
        sb.make_skin(head, mode="physical")
        bpy.ops.view3d.view_selected()
        bpy.context.space_data.overlay.show_extras = False
    tell("summary", list(head.data[SUMMARY])[:5])
    yield 0.5
    yield from open_sidebar("Skinglow", bpy.types.SKINGLOW_PT_sidebar)
    yield from picture("plain")
    bpy.context.window_manager.skinglow_heat_map = True
    yield from picture("heat_map")
    tell("kept between redraws", [len(heat_map._batches), id(heat_map._batches["Head"][1])])
    yield from picture("heat_map")
    tell("after a redraw", [len(heat_map._batches), id(heat_map._batches["Head"][1])])
    for vertex in head.data.vertices:
        vertex.co.x *= 1.5
    head.data.update()
    yield from picture("reshaped")
    head.select_set(False)
    bpy.context.view_layer.objects.active = None
    yield from picture("nothing_selected")
    head.select_set(True)
    bpy.context.view_layer.objects.active = head
    view = area_of("VIEW_3D").spaces.active
    view.overlay.show_overlays = False
    yield from picture("no_overlays")
    view.overlay.show_overlays = True
    yield from alone(head)
    bpy.context.window_manager.skinglow_heat_map = False
    yield from picture("off")
    tell("off", [len(heat_map._batches), len(heat_map._handles)])
    bpy.context.window_manager.skinglow_heat_map = True
    sb.unregister()
    tell("removed", [len(heat_map._handles), hasattr(bpy.types.WindowManager, "skinglow_heat_map")])
    yield from picture("removed")
    sb.register()
    yield from measuring_elsewhere(head)


def alone(head):
    """Lights in a local view, in which the head stays the active one."""
    for obj in bpy.context.view_layer.objects:
        obj.select_set(obj.type == "LIGHT")
    with in_view():
        bpy.ops.view3d.localview(frame_selected=False)
    bpy.context.view_layer.objects.active = head
    yield from picture("local_view")
    with in_view():
        bpy.ops.view3d.localview(frame_selected=False)
    bpy.context.view_layer.objects.active = head
    head.select_set(True)


def measuring_elsewhere(head):
    """What the status bars say after measuring that is left for another workspace, and turned off with the add-on."""
    said, first = {}, window().workspace.name
    tell_status = bpy.types.WorkSpace.status_text_set

    def listen(workspace, text):
        said[workspace.name] = text
        tell_status(workspace, text)

    bpy.types.WorkSpace.status_text_set = listen
    head.skinglow.rays = 4096
    begin_measuring()
    yield 0.5
    window().workspace = next(each for each in bpy.data.workspaces if each.name != first)
    yield 0.5
    tell("workspaces", [len(said), said[first]])
    SESSION.measuring.canceled = True
    yield from wait_for(lambda: SESSION.measuring is None, 60.0, "the end")
    tell("after measuring", list(said.values()))
    window().workspace = bpy.data.workspaces[first]
    yield 0.5
    begin_measuring()
    yield 0.5
    sb.unregister()
    sb.register()
    with in_view():
        tell("turned off", [SESSION.measuring is None, bpy.ops.skinglow.make.poll(), *said.values()])
        bpy.ops.wm.window_new()
    yield 0.5
    second = bpy.context.window_manager.windows[1]
    area = second.screen.areas[0]
    with bpy.context.temp_override(window=second, area=area, region=area.regions[0]):
        bpy.ops.skinglow.measure_thickness("INVOKE_DEFAULT")
    yield 0.5
    assert SESSION.measuring is not None
    with bpy.context.temp_override(window=second):
        bpy.ops.wm.window_close()
    tell("window closed", SESSION.measuring is None)


def begin_measuring():
    with in_view():
        bpy.ops.skinglow.measure_thickness("INVOKE_DEFAULT")


# Only the thickness, and open.
SHOWN = (thickness_panel.SKINGLOW_PT_sidebar_thickness, thickness_panel.SKINGLOW_PT_sidebar_thickness_image)
for part in main_panel.CLASSES:
    if part is not main_panel.SKINGLOW_PT_sidebar:
        part.bl_options = set() if part in SHOWN else {"DEFAULT_CLOSED"}
sb.register()
run_steps(steps)
