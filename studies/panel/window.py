"""Runs in a Blender with a window: makes a skin by clicking the panel's button, and takes pictures on the way.

Arguments after "--": the head's mesh, the folder of the core, and three picture files: before the click, after it, and
the ear.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

head_mesh, core_folder, before, after, close = sys.argv[sys.argv.index("--") + 1 :]
PROJECT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(PROJECT / name) for name in (".", "blender_addon", "tests/blender/window")]
sys.path.append(core_folder)

import bpy  # noqa: E402
import skinglow_blender as sb  # noqa: E402
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

from studies.panel.guide_scene import build_guide_scene  # noqa: E402
from studies.scenes import views_of  # noqa: E402

#: Seconds for the viewport's render by software.
RENDERED = 120.0
#: Seconds for measuring, and for solving light, on a machine that does other things too.
MEASURED = SOLVED = 900


def steps() -> Iterator[float | None]:
    with in_view():
        head = build_guide_scene(head_mesh)
    yield 0.5
    _look_at(head, *views_of(head)[""])
    yield from open_sidebar("Skinglow", bpy.types.SKINGLOW_PT_sidebar)
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


def _is_solved() -> bool:
    report = sb.state_of(bpy.data.objects["Head"], bpy.context.evaluated_depsgraph_get()).shape
    return report is not None and report.progress is None and report.shown != "TABLE"


def _look_at(head: bpy.types.Object, point: object, height: float) -> None:
    """From the front and a little from the ear's side."""
    region = area_of("VIEW_3D").spaces.active.region_3d
    region.view_perspective = "PERSP"
    region.view_location = head.matrix_world @ point
    region.view_rotation = (0.66, 0.63, 0.29, 0.29)
    region.view_distance = 1.6 * height


bpy.context.preferences.view.show_splash = False  # it would take the first click
sb.register()
run_steps(steps)
