"""Runs in a Blender with a window: light through the shape while a light moves; facts as JSON lines, and pictures.

Arguments after "--": the file of facts; the folders of the add-on and the core.
"""

import json
import sys
import time
from pathlib import Path

facts_file, addon_folder, core_folder = sys.argv[sys.argv.index("--") + 1 :]
sys.path[:0] = [str(Path(__file__).parent), addon_folder]
sys.path.append(core_folder)

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from skinglow_blender.identity import key_of  # noqa: E402
from skinglow_blender.live import shape_update  # noqa: E402
from skinglow_blender.session import SESSION  # noqa: E402
from skinglow_blender.ui import lights_panel, main_panel  # noqa: E402
from window_steps import area_of, in_view, open_sidebar, press, run_steps, save_picture, wait_for  # noqa: E402

PATIENCE = 120.0
FOLDER = Path(facts_file).parent
seen = []


def tell(name, value):
    with open(facts_file, "a") as facts:
        facts.write(json.dumps({"fact": name, "value": value}) + "\n")


def lobe():
    """A bent flat ellipsoid of 12 x 10 x 3 units."""
    bpy.ops.mesh.primitive_ico_sphere_add(subdivisions=4, radius=1.0)
    obj = bpy.context.object
    obj.name = "Lobe"
    points = np.empty(3 * len(obj.data.vertices), np.float32)
    obj.data.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3) * (6.0, 5.0, 1.5)
    points[:, 2] += 1.8 * np.sin(points[:, 0] / 3.6)
    obj.data.vertices.foreach_set("co", points.ravel())
    obj.data.update()
    return obj


def report():
    return sb.state_of(bpy.data.objects["Lobe"], bpy.context.view_layer.depsgraph).shape


def look():
    kind = report().shown
    if seen[-1:] != [kind]:
        seen.append(kind)
    return kind


def is_solved():
    return look() == "FULL" and not SESSION.shape_worker.is_busy


def light():
    return bpy.data.objects["Light"]


def picture(name):
    for area in bpy.context.window_manager.windows[0].screen.areas:
        area.tag_redraw()
    yield 0.7
    with in_view():
        save_picture(str(FOLDER / f"{name}.png"))


def cancel_a_render():
    """Esc while a render waits; it is sent to add-ons only, not to Blender, which therefore goes on."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.samples, scene.cycles.use_denoising = 1, False
    scene.render.resolution_x = scene.render.resolution_y = 16
    waited = []

    def wait(_fraction):
        started = time.monotonic()
        while not SESSION.interrupted and time.monotonic() - started < PATIENCE:
            time.sleep(0.01)
        waited.append(time.monotonic() - started)
        return not SESSION.interrupted

    shape_update.may_go_on = wait
    bpy.context.preferences.view.render_display_type = "NONE"
    light().rotation_euler = (0.3, 0.9, 0.0)
    with in_view():
        bpy.ops.render.render("INVOKE_DEFAULT")
    yield from wait_for(lambda: SESSION.waiting > 0, PATIENCE, "a render that waits")
    yield 1.0
    area = area_of("VIEW_3D")
    yield from press("ESC", area.x + area.width // 2, area.y + area.height // 2)
    yield from wait_for(lambda: not SESSION.rendering, PATIENCE, "the end of the render")
    key = key_of(bpy.data.objects["Lobe"])
    tell("canceled", [SESSION.waiting, max(waited), shape_update.state_of(key, "RENDER").fault])


def steps():
    for obj in list(bpy.data.objects):
        if obj.type == "MESH":
            bpy.data.objects.remove(obj)
    with in_view():
        lobe().skinglow.unit_mm = 1.0
        light().data.type, light().data.energy = "SUN", 5.0
        bpy.ops.view3d.view_selected()
        started = time.perf_counter()
        bpy.ops.skinglow.make("EXEC_DEFAULT", True)
    tell("lighting", bpy.data.objects["Lobe"].skinglow.weights)
    look()
    yield 0.1
    yield from open_sidebar("Skinglow", bpy.types.SKINGLOW_PT_sidebar)
    yield from wait_for(is_solved, PATIENCE, "the first light")
    tell("first", [seen[0], seen[-1], time.perf_counter() - started])
    yield from picture("solved")
    del seen[:]
    for i in range(15):
        light().rotation_euler = (0.2 * i, 0.1 * i, 0.0)
        look()
        yield 0.03
    yield from wait_for(is_solved, PATIENCE, "the moved light")
    tell("moved", seen)
    yield from picture("moved")
    with in_view():
        bpy.ops.ed.undo_push(message="moved")
        light().data.color = (1.0, 0.2, 0.1)
        bpy.ops.ed.undo_push(message="colored")
        yield 0.2
    yield from wait_for(is_solved, PATIENCE, "the color")
    with in_view():
        bpy.ops.ed.undo()
    yield 0.3
    yield from wait_for(is_solved, PATIENCE, "undo")
    tell("faults", list(SESSION.faults.values()))
    report_now = report()
    tell(
        "report", [report_now.parts, report_now.ready_parts, report_now.cells, report_now.bytes, len(report_now.error)]
    )
    yield from cancel_a_render()
    sb.unregister()
    tell("after", [SESSION.shape_worker is None, len(SESSION.shapes)])


# Only the lights, and open.
for part in main_panel.CLASSES:
    if part is not main_panel.SKINGLOW_PT_sidebar:
        part.bl_options = set() if part is lights_panel.SKINGLOW_PT_sidebar_lights else {"DEFAULT_CLOSED"}
sb.register()
run_steps(steps)
