# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders frames of a scene whose skins are frozen, in any Blender: the add-on is not needed, and not imported.

Usage: blender -b SCENE.blend -P frozen_frames.py -- FRAMES FOLDER SCENE SECONDS
This is what a task of the job does that openjd.py writes. SECONDS is what a frame may take, 0: any. Exit codes are
those of a batch: 1 if another try may help, 2 if not.
"""

import faulthandler
import os
import platform
import re
import sys
from pathlib import Path

import bpy


def main(frames: str, folder: Path, scene_name: str, seconds: float) -> int:
    """Renders the frames, each complete under its name or not at all; returns the exit code."""
    scene = bpy.data.scenes.get(scene_name)
    missing = [path for path in map(frozen_folder, bpy.data.images) if path and not path.is_dir()]
    if scene is None or missing:
        reason = f"no folder {missing[0]} with the frozen light" if missing else f"no scene '{scene_name}'"
        print(f"openjd_fail: {reason}", flush=True)
        return 2
    numbers = frame_numbers(frames)
    for done, frame in enumerate(numbers, start=1):
        if seconds:
            faulthandler.dump_traceback_later(seconds, exit=True)
        path = folder / f"{frame:04d}{scene.render.file_extension}"
        try:
            render(scene, frame, path)
        except (RuntimeError, OSError) as error:
            print(f"openjd_fail: frame {frame}: {error}", flush=True)
            return 1
        print(f"openjd_progress: {100.0 * done / len(numbers):.1f}", flush=True)
        print(f"openjd_status: [{done}/{len(numbers)}] frame {frame}", flush=True)
    faulthandler.cancel_dump_traceback_later()
    return 0


def frozen_folder(image: bpy.types.Image) -> Path | None:
    """Where the light of a frozen skin is."""
    if image.source != "SEQUENCE" or not image.name.startswith(".Skinglow "):
        return None
    return Path(bpy.path.abspath(image.filepath, library=image.library)).parent


def frame_numbers(text: str) -> list[int]:
    """The frames of a chunk: 3, 1-5 or 1-9:2, separated by commas."""
    found = []
    for part in text.split(","):
        first, last, step = re.fullmatch(r"\s*(-?\d+)(?:-(-?\d+)(?::(\d+))?)?\s*", part).groups()
        found += range(int(first), int(last or first) + 1, int(step or 1))
    return found


def render(scene: bpy.types.Scene, frame: int, path: Path) -> None:
    """Renders one frame."""
    path.parent.mkdir(parents=True, exist_ok=True)
    for leftover in path.parent.glob(f".{path.stem}.*.part*"):
        leftover.unlink()
    partial = path.with_name(f".{path.stem}.{platform.node()}-{os.getpid()}.part{path.suffix}")
    scene.frame_set(frame)
    # Since 4.5 braces in it are template variables.
    brace, end = "{", "}"
    double = 1 if bpy.app.version < (4, 5, 0) else 2
    scene.render.filepath = str(partial).replace(brace, brace * double).replace(end, end * double)
    try:
        bpy.ops.render.render(write_still=True, scene=scene.name)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


if __name__ == "__main__":
    chosen = sys.argv[sys.argv.index("--") + 1 :]
    # Names as a batch gives them.
    code = main(chosen[0], Path(chosen[1]) / "scene", chosen[2], float(chosen[3]))
    sys.stdout.flush()
    sys.exit(code)
