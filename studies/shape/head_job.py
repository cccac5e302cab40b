"""Runs inside Blender: writes the head's mesh, as it is rendered, to a file."""

from __future__ import annotations

from typing import Any

import numpy as np

from studies import scenes as stage


def main(job: dict[str, Any]) -> dict[str, Any]:
    stage.empty_scene()
    mesh = stage.load_head(job).data
    count = len(mesh.vertices)
    points, normals = np.empty((count, 3), np.float32), np.empty((count, 3), np.float32)
    mesh.vertices.foreach_get("co", points.ravel())
    mesh.vertex_normals.foreach_get("vector", normals.ravel())
    mesh.calc_loop_triangles()
    triangles = np.empty((len(mesh.loop_triangles), 3), np.int32)
    mesh.loop_triangles.foreach_get("vertices", triangles.ravel())
    np.savez(job["mesh_file"], vertices_mm=1000.0 * points.astype(np.float64), normals=normals, triangles=triangles)
    return {"vertices": count, "triangles": len(triangles)}
