# SPDX-License-Identifier: GPL-3.0-or-later
"""The pictures of a batch, their file names, and which of them are up to date."""

from pathlib import Path, PurePath
from typing import Any, NamedTuple

import bpy

from ..errors import SkinError
from .manifest import file_digest

PATTERN = "{rig}/{frame:04d}"
#: File formats of movies; all others are of single images.
MOVIES = frozenset(("AVI_JPEG", "AVI_RAW", "FFMPEG"))


class Picture(NamedTuple):
    """One picture of a batch."""

    rig: int  #: index in the list of rigs
    rig_name: str
    frame: int
    name: str  #: relative to the folder, with / as the separator, as in the manifest


def plan_pictures(scene: bpy.types.Scene, rig_names: list[str], frames: list[int], pattern: str) -> list[Picture]:
    """All pictures, rig by rig; raises SkinError if the pattern or the scene's output is not supported."""
    settings = scene.render.image_settings
    if settings.file_format in MOVIES:
        raise SkinError(f"The scene's output is a movie ({settings.file_format}): select an image format for a batch")
    if scene.render.use_multiview and settings.views_format != "STEREO_3D":
        raise SkinError("The scene renders each eye to its own file: set Views Format to Stereo 3D for a batch")
    pictures: dict[str, Picture] = {}
    for index, rig in enumerate(rig_names):
        for frame in frames:
            name = _file_name(pattern, scene, rig, frame)
            if name in pictures:
                raise SkinError(
                    f"The file name pattern '{pattern}' gives several pictures the name '{name}': it needs "
                    "{rig} and {frame}, as in '" + PATTERN + "'"
                )
            pictures[name] = Picture(index, rig, frame, name)
    return list(pictures.values())


def _file_name(pattern: str, scene: bpy.types.Scene, rig: str, frame: int) -> str:
    try:
        name = pattern.format(rig=rig, frame=frame, scene=bpy.path.clean_name(scene.name))
    except (KeyError, IndexError, ValueError, AttributeError) as error:
        raise SkinError(
            f"The file name pattern '{pattern}' is not valid ({type(error).__name__}: {error}): it may use "
            "{rig}, {frame} or {frame:04d}, and {scene}"
        ) from error
    parts = PurePath(name).parts
    if not parts or PurePath(name).is_absolute() or ".." in parts or name.endswith(("/", "\\")):
        raise SkinError(f"The file name pattern '{pattern}' gives '{name}', which is not a file inside the folder")
    extension = scene.render.file_extension
    return "/".join(parts) + ("" if name.lower().endswith(extension) else extension)


def why_not_kept(folder: Path, picture: Picture, entries: list[dict[str, Any]], inputs: dict[str, str]) -> str:
    """Why a picture has to be rendered; "" if it is complete and was made from the same inputs.

    entries  the manifest's entries for this file
    """
    path = folder / picture.name
    if not entries:
        return "not rendered yet"
    if not path.is_file():
        return "its file is missing"
    size = path.stat().st_size
    candidates = [entry for entry in entries if entry.get("bytes") == size]
    digest = file_digest(path) if candidates else ""
    same_file = [entry for entry in candidates if entry.get("sha256") == digest]
    if not same_file:
        return "its file was modified"
    changes = [_changed(entry.get("inputs"), inputs) for entry in same_file]
    return "" if not all(changes) else changes[-1]


def _changed(before: Any, now: dict[str, str]) -> str:  # noqa: ANN401
    if not isinstance(before, dict):
        return "its manifest has no inputs"
    changed = [part for part in now if before.get(part) != now[part]]
    return f"changed since: {', '.join(changed)}" if changed else ""
