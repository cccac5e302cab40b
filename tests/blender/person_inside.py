"""Run by a Python with bpy: what comes through the person's skin, alone, under a table that lights all thin skin.

Usage: person_inside.py RESULTS.json FOLDER-OF-SHAPES PICTURES.npz
"""

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(Path(__file__).parent), str(ROOT), str(ROOT / "blender_addon")]

import bpy  # noqa: E402  isort: skip
import numpy as np  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from bpy_extras.object_utils import world_to_camera_view  # noqa: E402
from mathutils import Vector  # noqa: E402
from process_end import run_and_exit  # noqa: E402

from studies import rendering  # noqa: E402
from studies import scenes as stage  # noqa: E402
from studies.heads import loading, portrait, studio  # noqa: E402

SIZE, SAMPLES = 240, 4


def main(results: str, shapes: str, pictures: str) -> None:
    scene = stage.empty_scene()
    head, placed = loading.load({"mesh": "person", "folder": shapes})
    eyes = [thing for thing in bpy.data.objects if thing.name.endswith("-eye")]
    at = {eye.name: sum((Vector(corner) for corner in eye.bound_box), Vector()) / 8.0 for eye in eyes}
    ear = studio.ear_of(placed)
    at["ear"] = Vector(ear.center)
    rendering.linear_render(scene, SIZE)
    camera = scene.camera = studio.portrait_camera(scene, ear)
    bpy.context.view_layer.update()
    sb.register()
    glow = {}
    for name, group in (("masked", True), ("everywhere", False)):
        if group:
            portrait.mask_glow(head)
        else:
            head.data.materials[0].skinglow.mask = "NONE"
        sb.make_skin(head, slots=[0], mode="existing", strength=20.0, unit_mm=1000.0)
        with stage.transmitted_light_only(head):
            glow[name] = rendering.render(scene, SAMPLES, 0, Path(results).parent).pixels[:, :, :3].max(axis=2)
    np.savez(pictures, **glow)
    pixels = {}
    for name, point in at.items():
        x, y, _depth = world_to_camera_view(scene, camera, point)
        pixels[name] = [SIZE * x, SIZE * (1.0 - y)]
    Path(results).write_text(json.dumps(pixels))


run_and_exit(main, *sys.argv[1:])
