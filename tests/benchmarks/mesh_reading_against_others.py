"""Times of reading a mesh of 1e6 triangles as GLB, OBJ and PLY by several readers in one run.

By the clock and of the processor, which other work on the machine does not change. Each reading is one in a process of
its own, as programs read, after that of a small file: neither the start nor the loading of code is counted. Each reader
hands out its vertices as float64 and its triangles as whole numbers. trimesh joins equal vertices of a PLY unless it is
told process=False; ours reads what the file has, and checks each position and index.

Usage: python mesh_reading_against_others.py MESH_READ_TIMES [PYTHON_WITH_BPY]
"""

import subprocess
import sys
import tempfile
from pathlib import Path

import numpy as np
import trimesh

TIMED = """
import sys, time
import numpy as np
{imports}
def read(path):
    {read}
read(sys.argv[1])
{between}
start, cpu_start = time.perf_counter(), time.process_time()
vertices, triangles = read(sys.argv[2])
assert vertices.dtype == np.float64 and triangles.dtype.kind in "iu"
seconds = time.perf_counter() - start, time.process_time() - cpu_start
print("took", len(triangles), *seconds)
"""
TRIMESH = """
    found = trimesh.load(path{option})
    mesh = next(iter(found.geometry.values())) if isinstance(found, trimesh.Scene) else found
    return np.asarray(mesh.vertices, np.float64), np.asarray(mesh.faces)
"""
MESHIO = """
    mesh = meshio.read(path)
    return mesh.points.astype(np.float64), mesh.cells_dict["triangle"]
"""
BLENDER = """
    if path.endswith("glb"): bpy.ops.import_scene.gltf(filepath=path)
    elif path.endswith("obj"): bpy.ops.wm.obj_import(filepath=path)
    else: bpy.ops.wm.ply_import(filepath=path)
    mesh = bpy.data.meshes[0]
    vertices = np.empty(3 * len(mesh.vertices), np.float32)
    mesh.attributes["position"].data.foreach_get("vector", vertices)
    corners = np.empty(len(mesh.loops), np.int32)
    mesh.loops.foreach_get("vertex_index", corners)
    return vertices.astype(float).reshape(-1, 3), corners.reshape(-1, 3)
"""
EMPTY = "bpy.ops.wm.read_factory_settings(use_empty=True)"
READERS = {
    "trimesh": TIMED.format(imports="import trimesh", read=TRIMESH.format(option=""), between=""),
    "trimesh, process=False": TIMED.format(
        imports="import trimesh", read=TRIMESH.format(option=", process=False"), between=""
    ),
    "meshio": TIMED.format(imports="import meshio", read=MESHIO, between=""),
}
IN_BLENDER = TIMED.format(imports=f"import bpy\n{EMPTY}", read=BLENDER, between=EMPTY)


def fastest(command: list, times: int) -> tuple[float, float]:
    """Seconds by the clock and of the processor of the quickest calls; infinite where it cannot read the format."""
    runs = []
    for _ in range(times):
        done = subprocess.run(command, capture_output=True, text=True, check=False)
        if done.returncode != 0:
            return float("inf"), float("inf")
        line = next(line for line in done.stdout.splitlines() if line.startswith("took "))
        runs.append(tuple(map(float, line.split()[2:4])))
    return tuple(map(min, zip(*runs, strict=True)))


def write_meshes(folder: Path, n: int) -> list[Path]:
    u, v = np.meshgrid(np.linspace(0, 1, n), np.linspace(0, 1, n), indexing="ij")
    vertices = np.stack([u, v, 0.1 * np.sin(9 * u) * np.cos(7 * v)], -1).reshape(-1, 3)
    first = (np.arange(n - 1)[:, None] * n + np.arange(n - 1)).ravel()
    faces = np.concatenate(
        [np.stack([first, first + n, first + n + 1], 1), np.stack([first, first + n + 1, first + 1], 1)]
    )
    files = [folder / f"mesh{n}.{extension}" for extension in ("glb", "obj", "ply")]
    for path in files:
        trimesh.Trimesh(vertices, faces, process=False).export(path)
    return files


def main() -> None:
    with tempfile.TemporaryDirectory() as folder:
        small, large = write_meshes(Path(folder), 3), write_meshes(Path(folder), 708)
        for warm, path in zip(small, large, strict=True):
            repeats = 2 if path.suffix == ".obj" else 10
            runs = [
                list(map(float, subprocess.check_output([sys.argv[1], warm, path], text=True).split()))
                for _ in range(repeats)
            ]
            count, clock, cpu, peak = map(min, zip(*runs, strict=True))
            times = {"ours": (clock, cpu)}
            size = path.stat().st_size / 2**20
            print(
                f"{path.suffix}: {count:.0f} triangles, {size:.0f} MB, our peak {peak:.0f} MB ({peak / size:.1f} times)"
            )
            for name, code in READERS.items():
                times[name] = fastest([sys.executable, "-c", code, warm, path], repeats)
            if len(sys.argv) > 2:
                times["Blender"] = fastest([sys.argv[2], "-c", IN_BLENDER, warm, path], 2)
            for column, what in enumerate(("clock", "processor")):
                best = min(value[column] for name, value in times.items() if name != "ours")
                cells = ", ".join(f"{name} {value[column]:.3f} s" for name, value in times.items())
                print(f"  {what}: {cells}; ours takes {times['ours'][column] / best:.2f} times the fastest other")


if __name__ == "__main__":
    main()
