"""Run by a Python with bpy: loads heads of files as the demo does, and renders the demo's first picture of the last.

Usage: heads_inside.py RESULTS.json FOLDER FILE...
"""

import json
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parents[2]
sys.path[:0] = [str(Path(__file__).parent), str(ROOT), str(ROOT / "blender_addon")]

import bpy  # noqa: E402  isort: skip
import numpy as np  # noqa: E402
from process_end import run_and_exit  # noqa: E402

from studies.heads import hero_job, loading, studio  # noqa: E402


def loaded(path: str) -> dict:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    head, placed = loading.load({"mesh": path})
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


def main(results: str, folder: str, *files: str) -> None:
    found = {Path(name).name: loaded(name) for name in files}
    job = {"mesh": files[-1], "size": 48, "samples": 4, "out": folder, "host": bpy.app.version_string}
    found["hero"] = hero_job.main(job)
    found["error"] = hero_job.main({**job, "unit_mm": 1e5})
    for name in ("broken.glb", "broken.ply", "empty.obj", "head.stl"):
        Path(folder, name).write_text("")
        found[name] = hero_job.main({**job, "mesh": str(Path(folder, name))})
    found["denoises"] = studio.can_denoise()
    Path(results).write_text(json.dumps(found))


run_and_exit(main, *sys.argv[1:])
