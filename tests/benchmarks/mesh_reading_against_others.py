"""Times of reading a mesh of 1e6 triangles as GLB, OBJ and PLY by several readers in one run.

Usage: python mesh_reading_against_others.py MESH_READ_TIMES [PYTHON_WITH_BPY]
"""

import subprocess
import sys
import tempfile
import time
from pathlib import Path

import meshio
import numpy as np
import trimesh

IN_BLENDER = """
import sys, time, bpy
for path in sys.argv[1:]:
    bpy.ops.wm.read_factory_settings(use_empty=True)
    start = time.perf_counter()
    if path.endswith("glb"): bpy.ops.import_scene.gltf(filepath=path)
    elif path.endswith("obj"): bpy.ops.wm.obj_import(filepath=path)
    else: bpy.ops.wm.ply_import(filepath=path)
    print("time", path, time.perf_counter() - start, flush=True)
"""


def best_of(function, times: int = 3) -> float:
    """Seconds of the quickest call; infinite where it fails."""
    best = float("inf")
    for _ in range(times):
        start = time.perf_counter()
        try:
            function()
        except Exception:  # noqa: BLE001  a library that cannot read the format is no rival
            return best
        best = min(best, time.perf_counter() - start)
    return best


def main() -> None:
    n = 708
    u, v = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij")
    vertices = np.stack([u, v, 0.1 * np.sin(9 * u) * np.cos(7 * v)], -1).reshape(-1, 3)
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate(
        [np.stack([first, first + n, first + n + 1], 1), np.stack([first, first + n + 1, first + 1], 1)]
    )
    with tempfile.TemporaryDirectory() as folder:
        files = [Path(folder) / f"mesh.{extension}" for extension in ("glb", "obj", "ply")]
        for path in files:
            trimesh.Trimesh(vertices, faces, process=False).export(path)
        times = {path: {} for path in files}
        for path in files:
            done = subprocess.run([sys.argv[1], path], capture_output=True, text=True, check=True).stdout.split()
            times[path]["ours"] = float(done[2])
            print(f"{path.suffix}: {done[1]} triangles, {path.stat().st_size / 2**20:.0f} MB, our peak {done[3]} MB")
            times[path]["trimesh"] = best_of(lambda path=path: trimesh.load(path))
            times[path]["trimesh, process=False"] = best_of(lambda path=path: trimesh.load(path, process=False))
            times[path]["meshio"] = best_of(lambda path=path: meshio.read(path))
        if len(sys.argv) > 2:
            done = subprocess.run([sys.argv[2], "-c", IN_BLENDER, *files], capture_output=True, text=True, check=True)
            for line in done.stdout.splitlines():
                if line.startswith("time "):
                    times[Path(line.split()[1])]["Blender"] = float(line.split()[2])
        for path, row in times.items():
            fastest = min(value for name, value in row.items() if name != "ours")
            cells = ", ".join(f"{name} {value:.3f} s" for name, value in row.items())
            print(f"{path.suffix}: {cells}; ours is {row['ours'] / fastest:.2f} times the fastest other")


if __name__ == "__main__":
    main()
