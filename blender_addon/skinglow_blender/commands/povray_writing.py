# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes POV-Ray scenes, still or animated, as a whole or not at all."""

import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager
from errno import EISDIR
from pathlib import Path

import numpy as np

from ..errors import SkinError, core
from .exr_writing import write_exr

#: What an earlier export may have left in a scene's folder.
SCENE_FILE = re.compile(
    r"(camera|columns|lights|lut|mesh|thickness|tiles)(_\d{4,})?\.(inc|exr)|surface\.\w+|scene\.(pov|ini)|skinglow\.inc"
)


class SceneFiles:
    """The files of one scene; of an animation each file is written once for every span of frames with the same one."""

    def __init__(self, folder: Path, *, animated: bool) -> None:
        self.folder, self.animated = folder, animated
        self.versions: dict[str, list[tuple[int, str]]] = {}  #: by name: (first frame, file), in their order
        self.latest: dict[str, bytes] = {}
        folder.mkdir(parents=True, exist_ok=True)

    def write(self, name: str, content: bytes, frame: int) -> str:
        """Writes a file of a frame, if it is not the same as before; the name that it has."""
        versions = self.versions.setdefault(name, [])
        if not versions or self.latest[name] != content:
            stem, dot, suffix = name.partition(".")
            versions.append((frame, f"{stem}_{frame:04}{dot}{suffix}" if self.animated else name))
            (self.folder / versions[-1][1]).write_bytes(content)
            self.latest[name] = content
        return versions[-1][1]

    def finish(self) -> None:
        """Gives files that never change their plain name, and lets the others choose by the frame."""
        for name, versions in self.versions.items() if self.animated else ():
            if not name.endswith((".inc", ".pov", ".ini")):
                continue  # pictures are named in the texts
            if len(versions) == 1 or name.endswith(".ini"):
                os.replace(self.folder / versions[0][1], self.folder / name)
            else:
                (self.folder / name).write_text(core().povray_frame_choice(versions), encoding="utf-8")


@contextmanager
def staged(directory: Path) -> Iterator[Path]:
    """Context manager with a folder to write to, whose files come to `directory` only if nothing fails.

    They replace those of an earlier export in the same folders; other files stay. Raises SkinError if writing fails.
    """
    home = next(folder for folder in (directory, *directory.absolute().parents) if folder.exists())
    stage = None
    try:
        stage = Path(tempfile.mkdtemp(prefix=".skinglow_", dir=home))
        (stage / "new").mkdir()
        yield stage / "new"
        _move(stage / "new", directory, stage / "old")
    except OSError as error:
        raise SkinError(f"Cannot write to {directory}: {error.strerror or error}") from error
    finally:
        if stage is not None:
            shutil.rmtree(stage, ignore_errors=True)


def _move(new: Path, directory: Path, old: Path) -> None:
    """Moves the files of a tree, and the obsolete ones away; undoes all of it if one cannot be moved."""
    done: list[tuple[Path, Path]] = []  # from, to
    made: list[Path] = []

    def move(source: Path, target: Path) -> None:
        made.extend(folder for folder in reversed((target.parent, *target.parent.parents)) if not folder.exists())
        target.parent.mkdir(parents=True, exist_ok=True)
        os.replace(source, target)
        done.append((source, target))

    files = [path.relative_to(new) for path in sorted(new.rglob("*")) if path.is_file()]
    obsolete = [
        path for folder in {file.parent for file in files} for path in _earlier(directory, folder) if path not in files
    ]
    try:
        for file in [file for file in files if (directory / file).exists()] + obsolete:
            if (directory / file).is_dir():
                raise IsADirectoryError(EISDIR, f"'{file}' is a folder")
            move(directory / file, old / file)
        for file in files:
            move(new / file, directory / file)
    except OSError:
        for source, target in reversed(done):
            os.replace(target, source)
        for folder in reversed(made):
            if directory in (folder, *folder.parents):
                folder.rmdir()
        raise


def _earlier(directory: Path, folder: Path) -> list[Path]:
    """The files of an earlier export in a folder, if there was one."""
    if not (directory / folder / "skinglow.inc").is_file():
        return []
    paths = (directory / folder).iterdir()
    return [path.relative_to(directory) for path in paths if path.is_file() and SCENE_FILE.fullmatch(path.name)]


def float_image(colors: np.ndarray, folder: Path) -> bytes:
    """Colors (height, width, 3) as a float32 EXR by Blender's own writer; exact."""
    path = folder / ".lut.exr"
    try:
        write_exr(path, colors)
        return path.read_bytes()
    finally:
        path.unlink(missing_ok=True)
