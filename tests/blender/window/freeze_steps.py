"""Runs in a Blender with a window: freezing as people do it, with Esc, undo and redo; facts as JSON lines.

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
from skinglow_blender.commands.freezing import frozen_state  # noqa: E402
from skinglow_blender.session import SESSION  # noqa: E402
from skinglow_blender.ui import freeze_panel, main_panel  # noqa: E402
from window_steps import area_of, in_view, open_sidebar, press, run_steps, save_picture, wait_for  # noqa: E402

PATIENCE = 300  # a busy machine took more than 120
FOLDER = Path(facts_file).parent


def tell(name, value):
    with open(facts_file, "a") as facts:
        facts.write(json.dumps({"fact": name, "value": value}) + "\n")


def ball():
    return bpy.data.objects["Ball"]


def is_frozen():
    return frozen_state(ball()) is not None


def press_in_view(key, **with_keys):
    area = area_of("VIEW_3D")
    yield from press(key, area.x + 300, area.y + 300, **with_keys)


def build():
    for obj in list(bpy.data.objects):
        if obj.type == "MESH":
            bpy.data.objects.remove(obj)
    bpy.ops.mesh.primitive_uv_sphere_add(radius=1.0)
    bpy.context.object.name = "Ball"
    light = bpy.data.objects["Light"]
    for frame in (1, 40):
        light.location.x = 0.1 * frame
        light.keyframe_insert("location", frame=frame)
    bpy.context.scene.frame_end = 40
    bpy.context.scene.frame_set(7)
    sb.make_skin(ball(), mode="physical", unit_mm=10.0)
    bpy.ops.wm.save_as_mainfile(filepath=str(FOLDER / "ball.blend"))
    bpy.ops.ed.undo_push(message="scene")


def freeze():
    with in_view():
        tell("began as", list(bpy.ops.skinglow.freeze("INVOKE_DEFAULT", True)))
    yield 0.1


def folders():
    return sorted(path.name for path in (FOLDER / "skinglow_frozen").iterdir())


def picture(name):
    for area in bpy.context.window_manager.windows[0].screen.areas:
        area.tag_redraw()
    yield 0.7
    with in_view():
        save_picture(str(FOLDER / f"{name}.png"))


def steps():
    with in_view():
        build()
    yield 0.5
    yield from open_sidebar("Skinglow", bpy.types.SKINGLOW_PT_sidebar)
    yield from picture("live")
    yield from freeze()
    yield from wait_for(lambda: SESSION.freezing and SESSION.freezing.done > 0.1, PATIENCE, "progress")
    yield from press_in_view("ESC")
    yield from wait_for(lambda: SESSION.freezing is None, PATIENCE, "Esc")
    tell("after Esc", [is_frozen(), folders(), bpy.context.scene.frame_current, bpy.context.scene.render.engine])
    yield from freeze()
    yield from wait_for(lambda: SESSION.freezing is None, PATIENCE, "freezing")
    tell("frozen", [is_frozen(), folders(), bpy.context.scene.frame_current, bpy.context.scene.render.engine])
    yield from picture("frozen")
    yield from press_in_view("Z", ctrl=True)
    yield from wait_for(lambda: not is_frozen(), PATIENCE, "undo")
    yield from press_in_view("Z", ctrl=True, shift=True)
    yield from wait_for(is_frozen, PATIENCE, "redo")
    bpy.data.objects["Light"].data.color = (1.0, 0.0, 0.0)
    yield 0.5
    yield from picture("changed")
    tell("health", [str(fault) for fault in sb.health(ball())])
    with in_view():
        bpy.ops.skinglow.unfreeze("EXEC_DEFAULT", True)
    tell("unfrozen", is_frozen())


# Only what freezing shows, and open.
for part in main_panel.CLASSES:
    if part is not main_panel.SKINGLOW_PT_sidebar:
        part.bl_options = set() if part is freeze_panel.SKINGLOW_PT_sidebar_freeze else {"DEFAULT_CLOSED"}
sb.register()
run_steps(steps)
