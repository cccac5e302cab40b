"""Times of reading a mesh of 1e6 triangles as GLB, OBJ and PLY by several readers in one run, by the clock and of the
processor, which other work on the machine does not change. Each reader hands out its vertices as float64 and its
triangles as whole numbers; the start of its process is not counted. trimesh joins equal vertices of a PLY unless it is
told process=False; ours reads what the file has, and checks each position and index.

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
import numpy as np
for path in sys.argv[1:]:
    best = cpu = float("inf")
    for _ in range(2):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        start, cpu_start = time.perf_counter(), time.process_time()
        if path.endswith("glb"): bpy.ops.import_scene.gltf(filepath=path)
        elif path.endswith("obj"): bpy.ops.wm.obj_import(filepath=path)
        else: bpy.ops.wm.ply_import(filepath=path)
        mesh = bpy.data.meshes[0]
        vertices = np.empty(3 * len(mesh.vertices), np.float32)
        mesh.attributes["position"].data.foreach_get("vector", vertices)
        corners = np.empty(len(mesh.loops), np.int32)
        mesh.loops.foreach_get("vertex_index", corners)
        vertices = vertices.astype(float)
        best, cpu = min(best, time.perf_counter() - start), min(cpu, time.process_time() - cpu_start)
    print("time", path, best, cpu, flush=True)
"""


def arrays_of(loaded) -> tuple[np.ndarray, np.ndarray]:
    if isinstance(loaded, meshio.Mesh):
        return loaded.points.astype(np.float64), loaded.cells_dict["triangle"]
    mesh = next(iter(loaded.geometry.values())) if isinstance(loaded, trimesh.Scene) else loaded
    return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces)


def best_of(function, times: int) -> tuple[float, float]:
    """Seconds by the clock and of the processor of the quickest calls; infinite where it fails."""
    best = best_cpu = float("inf")
    for _ in range(times):
        start, cpu_start = time.perf_counter(), time.process_time()
        try:
            vertices, triangles = arrays_of(function())
        except Exception:  # noqa: BLE001  a library that cannot read the format is no rival
            return best, best_cpu
        best = min(best, time.perf_counter() - start)
        best_cpu = min(best_cpu, time.process_time() - cpu_start)
        assert vertices.dtype == np.float64 and triangles.shape[1] == 3
    return best, best_cpu


def write_meshes(folder: Path) -> list[Path]:
    n = 708
    u, v = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij")
    vertices = np.stack([u, v, 0.1 * np.sin(9 * u) * np.cos(7 * v)], -1).reshape(-1, 3)
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate(
        [np.stack([first, first + n, first + n + 1], 1), np.stack([first, first + n + 1, first + 1], 1)]
    )
    files = [folder / f"mesh.{extension}" for extension in ("glb", "obj", "ply")]
    for path in files:
        trimesh.Trimesh(vertices, faces, process=False).export(path)
    return files


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        files = write_meshes(Path(folder))
        times = {path: {} for path in files}
        for path in files:
            repeats = 2 if path.suffix == ".obj" else 10
            done = subprocess.run([sys.argv[1], path], capture_output=True, text=True, check=True).stdout.split()
            times[path]["ours"] = float(done[2]), float(done[3])
            size, peak = path.stat().st_size / 2**20, int(done[4])
            print(
                f"{path.suffix}: {done[1]} triangles, {size:.0f} MB, our peak {peak} MB, {peak / size:.1f} times that"
            )
            readers = {
                "trimesh": lambda path=path: trimesh.load(path),
                "trimesh, process=False": lambda path=path: trimesh.load(path, process=False),
                "meshio": lambda path=path: meshio.read(path),
            }
            for name, reader in readers.items():
                times[path][name] = best_of(reader, repeats)
        if len(sys.argv) > 2:
            done = subprocess.run([sys.argv[2], "-c", IN_BLENDER, *files], capture_output=True, text=True, check=True)
            for line in done.stdout.splitlines():
                if line.startswith("time "):
                    _, path, *seconds = line.split()
                    times[Path(path)]["Blender"] = tuple(map(float, seconds))
        for path, row in times.items():
            for column, what in enumerate(("clock", "processor")):
                fastest = min(value[column] for name, value in row.items() if name != "ours")
                cells = ", ".join(f"{name} {value[column]:.3f} s" for name, value in row.items())
                ratio = row["ours"][column] / fastest
                print(f"{path.suffix}, {what}: {cells}; ours is {ratio:.2f} times the fastest other")


if __name__ == "__main__":
    main()
