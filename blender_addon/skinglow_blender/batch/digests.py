# SPDX-License-Identifier: GPL-3.0-or-later
"""Digests of input files, of which each is read once for all workers that render to a folder.

They are kept in the folder with size, times and inode of the file. A file that was changed moments before its digest
was taken is read again the next time: times may be too coarse to tell another change.
"""

import json
import os
import time
from collections.abc import Iterable
from contextlib import suppress
from pathlib import Path
from typing import Any

from .locks import locked
from .manifest import append_line, file_digest

NAME = ".skinglow_digests"
#: Seconds after which another change has another time, in every file system; FAT has the coarsest times.
COARSEST_TIME = 2.0


def file_digests(paths: Iterable[Path], folder: Path | None = None) -> dict[Path, str]:
    """SHA-256 of files in hexadecimal, "" for those that cannot be read; folder: where they are kept, None: nowhere.

    Other workers wait for the one that reads the files, and take what it found. Where nothing can be kept, each reads.
    """
    paths = list(paths)
    if folder is not None:
        with suppress(OSError), locked(folder / NAME):
            return _kept_digests(paths, folder / NAME)
    return {path: _digest(path) for path in paths}


def _kept_digests(paths: Iterable[Path], file: Path) -> dict[Path, str]:
    kept = _read(file)
    found = {}
    for path in paths:
        state = _state(path)
        digest = kept.get((str(path), *state)) if state else ""
        if digest is None:
            digest = _digest(path)
            if digest and _state(path) == state and time.time_ns() - max(state[1:3]) > COARSEST_TIME * 1e9:
                append_line(file, json.dumps([str(path), *state, digest]))
        found[path] = digest
    return found


def _read(file: Path) -> dict[tuple[Any, ...], str]:
    kept = {}
    for line in file.read_bytes().split(b"\n"):
        try:
            *state, digest = json.loads(line)
            kept[tuple(state)] = digest
        except (ValueError, TypeError):  # cut short by a worker that died
            continue
    return kept


def _state(path: Path) -> tuple[int, ...]:
    """Size, time of the last change of content and of anything, and inode; () if the file is gone."""
    try:
        found = os.stat(path)
    except OSError:
        return ()
    return found.st_size, found.st_mtime_ns, found.st_ctime_ns, found.st_ino


def _digest(path: Path) -> str:
    try:
        return file_digest(path)
    except OSError:  # Blender cannot read it either
        return ""
