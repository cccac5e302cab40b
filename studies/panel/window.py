"""Runs in a Blender with a window: makes a skin by clicking the panel's button, and takes pictures on the way.

Arguments after "--": "guide" or "thickness"; the head, as JSON of sources.head_job; the folder of the core; picture
files: of the guide the scene before the click, the panel after it, and the ear, of the thickness one.
"""

import json
import sys
from collections.abc import Iterator
from pathlib import Path

subject, head_job, core_folder, *pictures = sys.argv[sys.argv.index("--") + 1 :]
PROJECT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(PROJECT / name) for name in (".", "blender_addon", "tests/blender/window")]
sys.path.append(core_folder)

import bpy  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from skinglow_blender.ui import main_panel, thickness_panel  # noqa: E402
from window_steps import (  # noqa: E402
    area_of,
    click,
    in_view,
    open_sidebar,
    region_of,
    run_steps,
    save_picture,
    wait_for,
)

from studies.heads import studio  # noqa: E402
from studies.panel.guide_scene import build_guide_scene  # noqa: E402

#: Seconds for the viewport's render by software.
RENDERED = 240.0
#: Seconds for measuring, and for solving light, on a machine that does other things too.
MEASURED = SOLVED = 900
#: The viewport: its center off the ear, degrees off the front, and from how far.
VIEW_CENTER, VIEW_AZIMUTH, VIEW_DISTANCE_M = (-0.05, -0.03, -0.005), 35.0, 0.42
#: Of the picture of thickness: panels that are open.
OPEN = (thickness_panel.SKINGLOW_PT_sidebar_thickness, thickness_panel.SKINGLOW_PT_sidebar_thickness_image)


def guide() -> Iterator[float | None]:
    before, after, close = pictures
    yield from _begin()
    with in_view():
        save_picture(before)
    sidebar = region_of(area_of("VIEW_3D"), "UI")
    yield from click(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - 52)
    yield from wait_for(lambda: bpy.data.objects["Head"].skinglow.enabled, MEASURED, "the button to make a skin")
    lists = bpy.context.window_manager.skinglow_lists
    yield from wait_for(lambda: len(lists) and lists[0].rows, 60, "the list of lights")
    yield from wait_for(_is_solved, SOLVED, "the light through the shape")
    yield 1.0
    space = area_of("VIEW_3D").spaces.active
    space.shading.type = "RENDERED"
    area_of("VIEW_3D").tag_redraw()
    yield RENDERED
    with in_view():
        save_picture(after)
    space.shading.type = "SOLID"
    bpy.context.scene.render.filepath = close
    bpy.ops.render.render(write_still=True)


def thickness() -> Iterator[float | None]:
    yield from _begin()
    with in_view():
        sb.make_skin(bpy.data.objects["Head"], mode="physical", unit_mm=1000.0)
    bpy.context.window_manager.skinglow_heat_map = True
    area_of("VIEW_3D").tag_redraw()
    yield 2.0
    area_of("VIEW_3D").tag_redraw()  # Blender 5.2 shows panels that are new in a region when it is drawn again
    yield 2.0
    with in_view():
        save_picture(pictures[0])


def _begin() -> Iterator[float | None]:
    with in_view():
        ear = build_guide_scene(json.loads(head_job))
    yield 0.5
    area_of("VIEW_3D").spaces.active.overlay.show_extras = False  # lines of lights and of the camera cross the head
    region = area_of("VIEW_3D").spaces.active.region_3d
    region.view_perspective = "PERSP"
    region.view_location = studio.from_ear(ear, VIEW_CENTER)
    region.view_rotation = studio.outward(ear, VIEW_AZIMUTH).to_track_quat("Z", "Y")
    region.view_distance = VIEW_DISTANCE_M
    yield from open_sidebar("Skinglow", bpy.types.SKINGLOW_PT_sidebar)


def _is_solved() -> bool:
    report = sb.state_of(bpy.data.objects["Head"], bpy.context.evaluated_depsgraph_get()).shape
    return report is not None and report.progress is None and report.shown != "TABLE"


bpy.context.preferences.view.show_splash = False  # it would take the first click
if subject == "thickness":
    for part in main_panel.CLASSES:
        if part is not main_panel.SKINGLOW_PT_sidebar:
            part.bl_options = set() if part in OPEN else {"DEFAULT_CLOSED"}
sb.register()
run_steps({"guide": guide, "thickness": thickness}[subject])
