# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of a batch: rendered to a temporary file and renamed when it is complete."""

import os
import platform
import re
import time
from collections.abc import Callable, Iterable
from contextlib import suppress
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import bpy

from .. import blender_version
from ..errors import SkinError, core
from ..live.waiting import require_uninterrupted
from .inputs import engine_settings
from .manifest import file_digest, this_process
from .rigs import ReadyRig, check_lights
from .shown import Shown, watching

#: Temporary files exist only while a picture is written. One this old was left by a worker that died.
STALE_SECONDS = 600.0


def make_picture(
    scene: bpy.types.Scene, frame: int, path: Path, ready: ReadyRig, publish: Callable[[Path, dict[str, Any]], bool]
) -> bool:
    """Renders a frame to a temporary file beside its path.

    publish  called with that file and the manifest's fields on how it was made; renames it and returns True, or
             returns False if it is not wanted any more
    Returns what publish did. Raises SkinError, RuntimeError or OSError with the reason if the frame could not be
    rendered with that rig.
    """
    started = time.perf_counter()
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.stem}.{this_process()}.part{path.suffix}")
    try:
        shown = _render(scene, frame, partial)
        if shown.faults:
            raise SkinError("; ".join(dict.fromkeys(shown.faults)))
        check_lights(ready, scene, shown.lights)
        with partial.open("rb+") as file:
            os.fsync(file.fileno())
        fields = {
            "bytes": partial.stat().st_size,
            "sha256": file_digest(partial),
            "rig_file": str(ready.rig.file) if ready.rig.file else None,
            **_made_with(scene),
            "host": platform.node(),
            "seconds": round(time.perf_counter() - started, 3),
            "time": datetime.now(timezone.utc).isoformat(timespec="seconds"),
            "skins": shown.skins,
        }
        return publish(partial, fields)
    finally:
        partial.unlink(missing_ok=True)


def _render(scene: bpy.types.Scene, frame: int, partial: Path) -> Shown:
    scene.frame_set(frame)
    require_uninterrupted()
    scene.render.filepath = blender_version.literal_path(str(partial))
    with watching(scene) as shown:
        bpy.ops.render.render(write_still=True, scene=scene.name)
    require_uninterrupted()
    if not partial.is_file() or partial.stat().st_size == 0:
        raise RuntimeError("Blender wrote no picture: the render was canceled or failed (see Blender's own output)")
    return shown


def _made_with(scene: bpy.types.Scene) -> dict[str, Any]:
    render = scene.render
    percent = render.resolution_percentage
    engine = engine_settings(scene)
    return {
        "engine": render.engine,
        "resolution": [render.resolution_x * percent // 100, render.resolution_y * percent // 100],
        "samples": getattr(engine, "samples", getattr(engine, "taa_render_samples", None)),
        "camera": scene.camera.name_full if scene.camera else None,
        "blender": bpy.app.version_string,
        "skinglow": core().__version__,
        "blend": bpy.data.filepath,
    }


def clear_leftovers(folders: Iterable[Path]) -> None:
    """Removes temporary files of pictures that workers left which died: here, or some time ago elsewhere."""
    ours = re.compile(rf"\..+\.{re.escape(platform.node())}-(\d+)\.part(\.\w+)?")
    for folder in folders:
        for leftover in folder.glob(".*.part*"):
            found = ours.fullmatch(leftover.name)
            with suppress(OSError):
                is_old = time.time() - leftover.stat().st_mtime > STALE_SECONDS
                if is_old or (found is not None and _has_ended(int(found[1]))):
                    leftover.unlink()


def _has_ended(process: int) -> bool:
    """Whether a process of this machine is known to be no more."""
    if os.name == "nt":  # where os.kill would end it
        return False
    try:
        os.kill(process, 0)
    except ProcessLookupError:
        return True
    except OSError:
        return False
    return False
