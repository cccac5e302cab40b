# SPDX-License-Identifier: GPL-3.0-or-later
"""Writes POV-Ray scenes, still or animated, as a whole or not at all."""

import os
import re
import shutil
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager, suppress
from errno import EISDIR
from pathlib import Path

import numpy as np

from ..errors import SkinError, core
from ..whole_file import exchange
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

    They replace those of an earlier export in the same folders; other files stay. Also where Blender is killed each
    scene's folder holds one export, or the other: the new folder takes the old one's place in one step. Where that
    cannot be, files are moved one by one: on other systems than Linux, at the root of a disk, and where a scene's
    folder has folders within. Raises SkinError if writing fails.
    """
    directory, stage = directory.resolve(), None
    try:
        stage = _stage_for(directory)
        (stage / "new").mkdir()
        yield stage / "new"
        if not _exchange(stage / "new", directory):
            _move(stage / "new", directory, stage / "old")
    except OSError as error:
        raise SkinError(f"Cannot write to {directory}: {error.strerror or error}") from error
    finally:
        if stage is not None:
            shutil.rmtree(stage, ignore_errors=True)


def _stage_for(directory: Path) -> Path:
    """A folder beside `directory`, which may take its place; within it where that is not possible."""
    home = next(folder for folder in (directory, *directory.parents) if folder.exists())
    if home == directory and home.stat().st_dev == home.parent.stat().st_dev:
        with suppress(OSError):  # a folder of somebody else's
            return Path(tempfile.mkdtemp(prefix=".skinglow_", dir=home.parent))
    return Path(tempfile.mkdtemp(prefix=".skinglow_", dir=home))


def _exchange(new: Path, directory: Path) -> bool:
    """Puts each scene's folder in its place, in one step each; False where that cannot be, with nothing changed."""
    scenes = sorted({path.parent.relative_to(new) for path in new.rglob("*") if path.is_file()})
    targets = [directory / scene for scene in scenes]
    if any(new.parent in target.iterdir() or not _has_files_alone(target) for target in targets if target.exists()):
        return False
    done: list[tuple[Path, Path]] = []
    try:
        for scene, target in zip(scenes, targets, strict=True):
            fresh = new / scene
            if not target.exists():
                target.parent.mkdir(parents=True, exist_ok=True)
                os.rename(fresh, target)
            else:
                _link_others(target, fresh, {directory / path for path in _earlier(directory, scene)})
                shutil.copymode(target, fresh)
                if not exchange(fresh, target):
                    raise OSError(f"'{target}' cannot be exchanged")
            done.append((fresh, target))
    except OSError:
        for fresh, target in reversed(done):
            if not (fresh.exists() and exchange(fresh, target)):
                os.rename(target, fresh)
        return False
    return True


def _has_files_alone(folder: Path) -> bool:
    """Whether a folder consists of files, and nobody stands in it, who would be left in one that is gone."""
    with suppress(OSError):
        if Path.cwd().samefile(folder):
            return False
    return all(path.is_symlink() or path.is_file() for path in folder.iterdir())


def _link_others(old: Path, fresh: Path, obsolete: set[Path]) -> None:
    """Gives the files that are not of an earlier export a name in the new folder, too."""
    for path in old.iterdir():
        if path not in obsolete and not (fresh / path.name).exists():
            os.link(path, fresh / path.name, follow_symlinks=False)


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
