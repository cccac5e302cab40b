"""Runs inside Blender: writes the head's mesh, as it is rendered, to a file."""

from __future__ import annotations

import json
import sys
from pathlib import Path
from typing import Any

STEPS = Path(__file__).resolve().parent
sys.path[:0] = [str(STEPS), str(STEPS.parent / "ear_steps"), str(STEPS.parent / "demo_steps")]
JOB: dict[str, Any] = json.loads(Path(sys.argv[-1]).read_text())

import bpy  # noqa: E402, F401  isort: skip  (importing it makes the others importable)
import blender_scene as stage  # noqa: E402
import numpy as np  # noqa: E402
from job_steps import run  # noqa: E402


def main() -> dict[str, Any]:
    stage.empty_scene()
    mesh = stage.load_head(JOB).data
    count = len(mesh.vertices)
    points, normals = np.empty((count, 3), np.float32), np.empty((count, 3), np.float32)
    mesh.vertices.foreach_get("co", points.ravel())
    mesh.vertex_normals.foreach_get("vector", normals.ravel())
    mesh.calc_loop_triangles()
    triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles.ravel())
    np.savez(JOB["mesh_file"], vertices_mm=1000.0 * points.astype(np.float64), normals=normals, triangles=triangles)
    return {"vertices": count, "triangles": len(triangles)}


run(main)
