# SPDX-License-Identifier: GPL-3.0-or-later
"""The command line of comparisons with POV-Ray (docs/povray.md)."""

import argparse
from collections.abc import Sequence
from pathlib import Path

import bpy

from ..errors import SkinError
from .blender_command import BlenderCommand
from .command import BAD_ARGUMENTS
from .povray_comparison import MODES, compare_with_povray
from .progress import say

#: Exit codes.
WITHIN, TOO_FAR = 0, 1


def parser() -> argparse.ArgumentParser:
    """The options, as listed by --help."""
    found = argparse.ArgumentParser(
        prog="skinglow_povray",
        description="Renders the light through a skin by Cycles and by POV-Ray, and reports how far they are apart. "
        "Exit code: 0; 1 if an RMS is above 1/255 or a comparison failed; 2 if nothing could be compared.",
    )
    found.add_argument("--blend", type=Path, metavar="FILE", help="blend file, if Blender was started without one")
    found.add_argument("--skin", metavar="NAME", help="object (default: the first skin of the scene)")
    found.add_argument("--out", metavar="FOLDER", required=True, help="folder of report, pictures and scenes")
    found.add_argument("--modes", nargs="+", choices=MODES, default=MODES, help="(default: all)")
    found.add_argument("--all-lights", action="store_true", help="only under all lights, not under each alone")
    return found


def run(arguments: Sequence[str]) -> int:
    """Runs the command line; returns the exit code."""
    try:
        options = parser().parse_args(list(arguments))
    except SystemExit as end:  # argparse has printed the error or the help
        return end.code if isinstance(end.code, int) else BAD_ARGUMENTS
    try:
        if options.blend is not None:
            bpy.ops.wm.open_mainfile(filepath=str(options.blend.absolute()), load_ui=False)
        done = compare_with_povray(_skin(options.skin), options.out, options.modes, not options.all_lights)
    except (SkinError, ValueError, RuntimeError) as error:
        say(f"skinglow_povray: {error}")
        return BAD_ARGUMENTS
    for note in done.notes:
        say(f"skinglow_povray: {note}")
    for entry in done.entries:
        result = f"RMS {entry['rms']:.2e}" if "rms" in entry else entry.get("error", "not compared")
        say(f"{entry['mode']}, {entry['light']}: {result}")
    say(str(done.report))
    if not any("rms" in entry for entry in done.entries):
        return BAD_ARGUMENTS
    return WITHIN if all(entry.get("within") for entry in done.entries) else TOO_FAR


def _skin(name: str | None) -> bpy.types.Object:
    skins = [obj for obj in bpy.context.scene.objects if obj.type == "MESH" and obj.skinglow.enabled]
    for obj in skins:
        if name in (None, obj.name):
            return obj
    raise SkinError(
        f"There is no skin {name or 'in the scene'}; there are: {', '.join(o.name for o in skins) or 'none'}"
    )


COMMAND = BlenderCommand("skinglow_povray", run)
