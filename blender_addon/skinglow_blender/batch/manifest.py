# SPDX-License-Identifier: GPL-3.0-or-later
"""The manifest: one JSON line per completed picture, in files that several workers may write at once.

A line is a single write to a file opened for appending, under a lock if the system has one: lines of several workers on
one machine, or on a network folder with locks, never interleave. On a network folder without locks, give each worker a
name: each then writes its own file, and all manifests of a folder are read together.
"""

import hashlib
import json
import os
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

from ..errors import SkinError

#: Version of the lines; readers ignore lines of an unknown version.
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
    """SHA-256 of plain data, in hexadecimal; stable across processes."""
    text = json.dumps(data, sort_keys=True, separators=(",", ":"), default=str)
    return hashlib.sha256(text.encode()).hexdigest()


class Manifest:
    """The manifests of one folder: reads all, appends to that of this worker."""

    def __init__(self, folder: Path, worker: str = "") -> None:
        if any(c in '/\\:*?"<>|' for c in worker):
            raise SkinError(f"The worker's name '{worker}' is not allowed in file names: use letters, digits, - and _")
        self.folder = folder
        self.path = folder / (f"manifest-{worker}.jsonl" if worker else "manifest.jsonl")

    def entries(self) -> list[dict[str, Any]]:
        """All complete lines of the folder's manifests; lines truncated by a worker that died are skipped."""
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
        """Raises OSError if this worker cannot append."""
        with self.path.open("ab"):
            pass

    def append(self, entry: dict[str, Any]) -> None:
        """Appends a line atomically; raises OSError if that fails, and ValueError on values that JSON lacks (NaN)."""
        line = json.dumps({"skinglow_manifest": VERSION, **entry}, allow_nan=False, ensure_ascii=False)
        with self.path.open("a+b", buffering=0) as file, _locked(file):
            size = file.seek(0, os.SEEK_END)
            truncated = size > 0 and (file.seek(size - 1), file.read(1))[1] != b"\n"
            file.write(b"\n" * truncated + line.encode() + b"\n")
            os.fsync(file.fileno())


@contextmanager
def _locked(file: Any) -> Iterator[None]:  # noqa: ANN401
    """Locks a file if the system and its file system support it; the lock ends with the process."""
    try:
        import fcntl
    except ImportError:  # Windows
        yield
        return
    try:
        fcntl.flock(file, fcntl.LOCK_EX)
    except OSError:  # a network folder without locks: rely on appending
        yield
        return
    try:
        yield
    finally:
        fcntl.flock(file, fcntl.LOCK_UN)
