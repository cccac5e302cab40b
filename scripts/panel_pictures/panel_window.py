"""Runs in a Blender with a window: makes a skin by clicking the panel's button, and takes a picture of the panel.

Arguments after "--": the picture's file, the add-on's folder, the core's folder.
"""

import sys
from collections.abc import Iterator
from pathlib import Path

picture, addon_folder, core_folder = sys.argv[sys.argv.index("--") + 1 :]
sys.path[:0] = [str(Path(__file__).parent), addon_folder]
sys.path.append(core_folder)

import bpy  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from panel_scene import build_scene  # noqa: E402
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


def steps() -> Iterator[float | None]:
    with in_view():
        head = build_scene()
    bpy.context.scene.render.engine = "CYCLES"
    bpy.context.scene.cycles.use_denoising = False
    bpy.context.scene.cycles.use_preview_denoising = False
    bpy.context.scene.cycles.preview_samples = 8
    yield 0.5
    with in_view():
        bpy.ops.view3d.view_axis(type="FRONT")
        bpy.ops.view3d.view_selected()
    yield from open_sidebar("Skinglow", bpy.types.SKINGLOW_PT_sidebar)
    sidebar = region_of(area_of("VIEW_3D"), "UI")
    yield from click(sidebar.x + sidebar.width // 2, sidebar.y + sidebar.height - 52)
    yield from wait_for(lambda: bpy.data.objects["Head"].skinglow.enabled, 120, "the button to make a skin")
    head = bpy.data.objects["Head"]
    yield from wait_for(
        lambda: len(bpy.context.window_manager.skinglow_lists) and bpy.context.window_manager.skinglow_lists[0].rows,
        30,
        "the list of lights",
    )
    area_of("VIEW_3D").spaces.active.shading.type = "RENDERED"
    area_of("VIEW_3D").tag_redraw()
    yield 25.0
    with in_view():
        save_picture(picture)
    print("MADE", head.name, flush=True)


sb.register()
run_steps(steps)
