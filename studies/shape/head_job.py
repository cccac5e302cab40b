"""Runs inside Blender: writes the head's mesh, as it is rendered, to a file."""

from __future__ import annotations

from typing import Any

import numpy as np

from studies import rendering
from studies import scenes as stage


def main(job: dict[str, Any]) -> dict[str, Any]:
    stage.empty_scene()
    points, normals, triangles = rendering.mesh_arrays(stage.load_head(job).data)
    np.savez(job["mesh_file"], vertices_mm=1000.0 * points, normals=normals.astype(np.float32), triangles=triangles)
    return {"vertices": len(points), "triangles": len(triangles)}
