"""The options of the demo, checked; with the standard library alone, so that scripts/demo asks before it sets up."""

from __future__ import annotations

import argparse
import math
import re
import sys
from pathlib import Path

#: Heads that are no files: studies/heads/sources.py.
NAMED = ("person", "makehuman", "suzanne")


def parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/demo",
        description="Lights a head from behind; in Blender and POV-Ray it glows in the color of the lights.",
        epilog="examples: scripts/demo --quick; scripts/demo scan.ply --up=Y --facing=-Z --unit 10",
    )
    parser.add_argument("mesh", nargs="?", help="GLB, OBJ, PLY or STL file of a head (default: a CC0 person)")
    parser.add_argument(
        "--mesh", dest="named_mesh", metavar="FILE|suzanne", help="the same; `suzanne` is Blender's monkey"
    )
    parser.add_argument("--quick", action="store_true", help="the first picture alone")
    parser.add_argument(
        "--unit", type=above_zero, metavar="MM", help="millimeters per unit of the file (default: guessed)"
    )
    axes = "+X, -X, +Y, -Y, +Z or -Z; write --{0}=-Z with the sign (default: by the format, or guessed)"
    parser.add_argument("--up", type=axis, metavar="AXIS", help="of the file that points up: " + axes.format("up"))
    parser.add_argument(
        "--facing", type=axis, metavar="AXIS", help="of the file along which the face looks: " + axes.format("facing")
    )
    parser.add_argument(
        "--ear", type=point, metavar="X,Y,Z", help="where the ear is, in the file (default: looked for)"
    )
    parser.add_argument("--rig", type=file, metavar="FILE", help="light rig instead of Blender's rim.sl: .json or .sl")
    parser.add_argument(
        "--color-map", type=file, metavar="FILE", help="base color texture of the skin, in the UVs of the mesh"
    )
    parser.add_argument(
        "--normal-map", type=file, metavar="FILE", help="tangent-space normal map, in the UVs of the mesh"
    )
    parser.add_argument(
        "--blender",
        metavar="PROGRAM",
        help="Blender program or Python with bpy, instead of the default",
    )
    parser.add_argument(
        "--size",
        type=at_least_one,
        default=720,
        metavar="PIXELS",
        help="of the first picture (default 720); the others have two thirds",
    )
    parser.add_argument(
        "--samples",
        type=at_least_one,
        default=32,
        help="Cycles samples per pixel of the first picture, denoised (default 32); the others have a quarter",
    )
    parser.add_argument("--out", type=Path, default=Path("out"), help="output folder (default out/)")
    parser.add_argument(
        "--docs", action="store_true", help="the pictures of README and docs are then those of this run"
    )
    options = parser.parse_args(arguments)
    if options.mesh and options.named_mesh:
        parser.error(f"two heads are given, {options.mesh} and {options.named_mesh}; give one")
    if options.quick and (options.rig or options.docs):
        parser.error("--quick makes the first picture alone, which --rig and --docs would not change: leave them out")
    mesh = options.mesh or options.named_mesh
    if mesh and mesh not in NAMED and not Path(mesh).is_file():
        parser.error(f"{mesh}: no such file; give a GLB, OBJ, PLY or STL mesh, or `--mesh suzanne`")
    if options.out.exists() and not options.out.is_dir():
        parser.error(f"--out {options.out}: is a file; give a folder")
    return options


def point(text: str) -> tuple[float, float, float]:
    """Of "X,Y,Z"."""
    try:
        x, y, z = (float(number) for number in text.split(","))
        if all(math.isfinite(number) for number in (x, y, z)):
            return x, y, z
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"{text!r} is no point; give three numbers, as 8.1,4.5,-1")


def axis(text: str) -> str:
    if re.fullmatch("[+-]?[XYZ]", text.strip().upper()):
        return text
    raise argparse.ArgumentTypeError(f"{text!r} is no axis; give +X, -X, +Y, -Y, +Z or -Z")


def above_zero(text: str) -> float:
    try:
        if 0.0 < float(text) < math.inf:
            return float(text)
    except ValueError:
        pass
    raise argparse.ArgumentTypeError(f"{text!r} is no number above 0")


def at_least_one(text: str) -> int:
    if text.isdecimal() and int(text) > 0:
        return int(text)
    raise argparse.ArgumentTypeError(f"{text!r} is no whole number from 1 on")


def file(text: str) -> Path:
    if Path(text).is_file():
        return Path(text)
    raise argparse.ArgumentTypeError(f"{text}: no such file")


if __name__ == "__main__":
    parsed(sys.argv[1:])
