# SPDX-License-Identifier: GPL-3.0-or-later
"""One picture of a batch: rendered to a temporary file and renamed when it is complete."""

import glob
import os
import platform
import time
from datetime import datetime, timezone
from pathlib import Path
from typing import Any

import bpy

from .. import blender_version
from ..errors import SkinError, core
from .inputs import engine_settings
from .manifest import file_digest
from .rigs import ReadyRig, check_lights
from .shown import Shown, watching

#: Temporary files exist only while a picture is written. One this old was left by a worker that died.
STALE_SECONDS = 3600.0


def make_picture(scene: bpy.types.Scene, frame: int, path: Path, ready: ReadyRig) -> dict[str, Any]:
    """Renders a frame atomically; returns the manifest's fields on how it was made.

    Raises SkinError, RuntimeError or OSError with the reason if it could not be rendered with that rig.
    """
    started = time.perf_counter()
    path.parent.mkdir(parents=True, exist_ok=True)
    partial = path.with_name(f".{path.stem}.{platform.node()}-{os.getpid()}.part{path.suffix}")
    try:
        shown = _render(scene, frame, partial)
        if shown.faults:
            raise SkinError("; ".join(dict.fromkeys(shown.faults)))
        check_lights(ready, scene, shown.lights)
        with partial.open("rb+") as file:
            os.fsync(file.fileno())
        size, digest = partial.stat().st_size, file_digest(partial)
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)
    _clear_stale(path)
    return {
        "bytes": size,
        "sha256": digest,
        "rig_file": str(ready.rig.file) if ready.rig.file else None,
        **_made_with(scene),
        "host": platform.node(),
        "seconds": round(time.perf_counter() - started, 3),
        "time": datetime.now(timezone.utc).isoformat(timespec="seconds"),
        "skins": shown.skins,
    }


def _render(scene: bpy.types.Scene, frame: int, partial: Path) -> Shown:
    scene.frame_set(frame)
    scene.render.filepath = blender_version.literal_path(str(partial))
    with watching(scene) as shown:
        bpy.ops.render.render(write_still=True, scene=scene.name)
    if not partial.is_file() or partial.stat().st_size == 0:
        raise SkinError("Blender wrote no picture: the render was canceled or failed (see Blender's own output)")
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


def _clear_stale(path: Path) -> None:
    """Removes temporary files of this picture left by workers that died."""
    for leftover in path.parent.glob(f".{glob.escape(path.stem)}.*.part{path.suffix}"):
        try:
            if time.time() - leftover.stat().st_mtime > STALE_SECONDS:
                leftover.unlink()
        except OSError:
            continue
