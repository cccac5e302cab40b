# SPDX-License-Identifier: GPL-3.0-or-later
"""The manifest: one JSON line for each picture that was completed, in files that several workers may write at once.

A line is one write to a file opened for appending, under a lock where the system has one: lines of several workers on
one machine, or on a network folder with locks, never mix. Where a network folder has no locks, give each worker a name:
each then writes a file of its own, and all of a folder's manifests are read together.
"""

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..errors import SkinError

#: Of the lines; a reader that does not know a version ignores the line.
VERSION = 1
_CHUNK = 1 << 20


def file_digest(path: Path) -> str:
    """SHA-256 of a file's bytes, in hexadecimal."""
    digest = hashlib.sha256()
    with path.open("rb") as file:
        while chunk := file.read(_CHUNK):
            digest.update(chunk)
    return digest.hexdigest()


def data_digest(data: Any) -> str:  # noqa: ANN401
    """SHA-256 of plain data, in hexadecimal; equal data, equal digest, in every process."""
    text = json.dumps(data, sort_keys=True, separators=(",", ":"), default=str)
    return hashlib.sha256(text.encode()).hexdigest()


class Manifest:
    """The manifests of one folder: reads all, appends to this worker's."""

    def __init__(self, folder: Path, worker: str = "") -> None:
        if any(c in '/\\:*?"<>|' for c in worker):
            raise SkinError(f"The worker's name '{worker}' cannot be part of a file name: use letters, digits, - and _")
        self.folder = folder
        self.path = folder / (f"manifest-{worker}.jsonl" if worker else "manifest.jsonl")

    def entries(self) -> list[dict[str, Any]]:
        """All whole lines of the folder's manifests; what a worker that died left half-written is passed over."""
        found = []
        for path in sorted(self.folder.glob("manifest*.jsonl")):
            for line in path.read_bytes().split(b"\n"):
                try:
                    entry = json.loads(line)
                except ValueError:
                    continue
                if isinstance(entry, dict) and entry.get("skinglow_manifest") == VERSION:
                    found.append(entry)
        return found

    def check_writable(self) -> None:
        """Raises OSError where this worker could not append."""
        with self.path.open("ab"):
            pass

    def append(self, entry: dict[str, Any]) -> None:
        """Adds a line, whole; raises OSError where it cannot, and ValueError on what JSON has not (NaN)."""
        line = json.dumps({"skinglow_manifest": VERSION, **entry}, allow_nan=False, ensure_ascii=False)
        with self.path.open("a+b", buffering=0) as file, _locked(file):
            size = file.seek(0, os.SEEK_END)
            cut_short = size > 0 and (file.seek(size - 1), file.read(1))[1] != b"\n"
            file.write(b"\n" * cut_short + line.encode() + b"\n")
            os.fsync(file.fileno())


@contextmanager
def _locked(file: Any) -> Iterator[None]:  # noqa: ANN401
    """Alone with a file, where the system and its file system have locks; they end with the process."""
    try:
        import fcntl
    except ImportError:  # Windows
        yield
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX)
    except OSError:  # a network folder without locks: appending alone has to do
        yield
        return
    try:
        yield
    finally:
        fcntl.flock(file, fcntl.LOCK_UN)
