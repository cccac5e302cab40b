"""Runs in Blender: rays of the core's and of Cycles' in one process, which then ends as a user's does."""

import os
import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[2] / "blender_addon")]
if os.environ.get("SKINGLOW_SITE"):
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
import skinglow_blender as sb  # noqa: E402

sb.register()
order, picture = sys.argv[sys.argv.index("--") + 1 :]
scene = bpy.context.scene
scene.render.engine = "CYCLES"
scene.cycles.samples, scene.cycles.use_denoising = 1, False
scene.render.resolution_x = scene.render.resolution_y = 8
scene.render.filepath = picture
if order == "cycles first":
    bpy.ops.render.render(write_still=True)
obj = bpy.data.objects["Cube"]
state = sb.make_skin(obj, mode="physical", unit_mm=1.0)
assert abs(state.thickness_mm[0] - 2.0) < 0.6, state
scene.skinglow.occlusion = True
bpy.ops.mesh.primitive_plane_add(size=9.0, location=(0.0, 0.0, 3.0))
report = sb.light_report(obj, bpy.context.evaluated_depsgraph_get())
(row,) = (row for row in report if row["name"] == "Light")
assert row["visible"] < 1.0, row
bpy.ops.render.render(write_still=True)
print("traced and rendered", flush=True)
