"""Run by a Python with bpy: loads heads of files as the demo does, and renders the demo's first picture of the last.

Usage: heads_inside.py RESULTS.json FOLDER FILE...; with "-" for a FOLDER it only loads
"""

import json
import os
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(Path(__file__).parent), str(ROOT), str(ROOT / "blender_addon")]
if os.environ.get("SKINGLOW_SITE"):
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402  isort: skip
import numpy as np  # noqa: E402
from process_end import run_and_exit  # noqa: E402

from studies.heads import hero_job, loading, studio  # noqa: E402
from studies.heads.human_head import HeadError  # noqa: E402


def loaded(path: str) -> dict:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    try:
        head, placed = loading.load({"mesh": path})
    except HeadError as error:
        return {"error": str(error)}
    points = np.empty(3 * len(head.data.vertices), np.float32)
    head.data.vertices.foreach_get("co", points)
    points = points.reshape(-1, 3)
    return {
        "low": points.min(axis=0).tolist(),
        "high": points.max(axis=0).tolist(),
        "nose": points[points[:, 1].argmin()].tolist(),
        "ears": [ear.center.tolist() for ear in placed.ears],
        "said": placed.said,
    }


def write_rigged(head: str, path: str) -> None:
    """The head on a bone, with a shape key: importing it brings a ball that shows bones, 2 m wide."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.import_scene.gltf(filepath=head)
    skin = next(thing for thing in bpy.data.objects if thing.type == "MESH")
    for name in ("Basis", "smile"):
        skin.shape_key_add(name=name)
    rig = bpy.data.objects.new("rig", bpy.data.armatures.new("rig"))
    bpy.context.scene.collection.objects.link(rig)
    bpy.context.view_layer.objects.active = rig
    bpy.ops.object.mode_set(mode="EDIT")
    bone = rig.data.edit_bones.new("neck")
    bone.head, bone.tail = (0.0, 0.0, -0.1), (0.0, 0.0, 0.1)
    bpy.ops.object.mode_set(mode="OBJECT")
    skin.parent, skin.modifiers.new("bones", "ARMATURE").object = rig, rig
    skin.vertex_groups.new(name="neck").add(range(len(skin.data.vertices)), 1.0, "REPLACE")
    bpy.ops.export_scene.gltf(filepath=path)


def main(results: str, folder: str, *files: str) -> None:
    if folder == "-":
        Path(results).write_text(json.dumps({Path(name).name: loaded(name) for name in files}))
        return
    write_rigged(files[-1], files[0])
    found = {Path(name).name: loaded(name) for name in files}
    job = {"mesh": files[-1], "size": 48, "samples": 4, "out": folder, "host": bpy.app.version_string}
    found["hero"] = hero_job.main(job)
    found["error"] = hero_job.main({**job, "unit_mm": 1e5})
    for name in ("broken.glb", "broken.ply", "empty.obj", "head.fbx"):
        Path(folder, name).write_text("")
        found[name] = hero_job.main({**job, "mesh": str(Path(folder, name))})
    found["denoises"] = studio.can_denoise()
    Path(results).write_text(json.dumps(found))


run_and_exit(main, *sys.argv[sys.argv.index("--") + 1 if "--" in sys.argv else 1 :])
