"""Meshes as files, for `python -m skinglow`: numpy's own, and what meshio reads."""

from __future__ import annotations

import contextlib
import importlib
import io
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

Array = NDArray[np.float64]


def read_mesh(path: Path) -> tuple[Array, NDArray[np.integer]]:
    """Vertices and triangles: arrays of those names in an .npz, any other format by meshio."""
    # A pipe without a writer would wait for ever.
    if path.exists() and not path.is_file():
        raise ValueError(f"file {path}: is not a file: give the name of one")
    if path.suffix == ".npz":
        return read_npz(path)
    try:
        # By name: type checkers look into what is imported otherwise, which nobody needs for .npz.
        meshio = importlib.import_module("meshio")
    except ImportError:
        raise ValueError(
            f"file {path}: only .npz is read without meshio: pip install 'skinglow[meshes]', or "
            "numpy.savez(FILE, vertices=..., triangles=...)"
        ) from None
    if not path.is_file():
        raise FileNotFoundError(2, "No such file", str(path))
    # Of what is no mesh meshio tells on both streams, and then raises or exits.
    said = io.StringIO()
    try:
        with contextlib.redirect_stdout(said), contextlib.redirect_stderr(said):
            mesh = meshio.read(path)
    except (Exception, SystemExit) as error:
        reason = " ".join(said.getvalue().split()) or error
        raise ValueError(f"file {path}: meshio cannot read it: {reason}") from None
    triangles = [mesh.cells_dict["triangle"]] if "triangle" in mesh.cells_dict else []
    if "quad" in mesh.cells_dict:
        quads = mesh.cells_dict["quad"]
        triangles += [quads[:, [0, 1, 2]], quads[:, [0, 2, 3]]]
    if not triangles:
        raise ValueError(f"file {path}: has no triangles or quads: give the surface of a body")
    return np.asarray(mesh.points, np.float64), np.concatenate(triangles)


def read_npz(path: Path) -> tuple[Array, NDArray[np.integer]]:
    """Arrays `vertices` and `triangles` of a file of numpy.savez. Raises ValueError naming the file."""
    # What numpy raises on damaged archives is of a dozen types, of zipfile, zlib, ast and its own.
    try:
        with path.open("rb") as file, np.load(file, allow_pickle=False) as held:
            missing = [name for name in ("vertices", "triangles") if name not in held]
            if not missing:
                return held["vertices"], held["triangles"]
    except OSError:
        raise
    except Exception as error:
        raise ValueError(f"file {path}: is damaged, or not of numpy.savez: {' '.join(str(error).split())}") from None
    raise ValueError(f"file {path}: has no array {missing[0]}: give vertices (n, 3) and triangles (m, 3)")
