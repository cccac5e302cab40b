"""Runs inside Blender: writes a head's mesh, as it is rendered, to a file."""

from __future__ import annotations

from typing import Any

# isort: off  (importing bpy is what makes the others importable in the wheels)
import bpy
import numpy as np

# isort: on
from studies import rendering
from studies.heads import loading
from studies.heads.human_head import HeadError


def main(job: dict[str, Any]) -> dict[str, Any]:
    """job: of loading.load, and "mesh_file". Returns {"error": in words} where the head cannot be used."""
    bpy.ops.wm.read_factory_settings(use_empty=True)
    try:
        head, _placed = loading.load(job)
    except HeadError as error:
        return {"error": str(error)}
    points, normals, triangles = rendering.mesh_arrays(head.data)
    np.savez(job["mesh_file"], vertices_mm=1000.0 * points, normals=normals.astype(np.float32), triangles=triangles)
    return {"vertices": len(points), "triangles": len(triangles)}
