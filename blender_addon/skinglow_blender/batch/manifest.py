# SPDX-License-Identifier: GPL-3.0-or-later
"""The manifest: one JSON line per completed picture, in files that several workers may write at once.

A line is a single write to a file opened for appending, under the folder's lock: lines of several workers never
interleave, and of two workers that made the same picture only one writes a line. In a folder without locks each worker
writes a file of its own. All manifests of a folder are read together.
"""

import hashlib
import json
import os
import platform
from collections.abc import Callable
from pathlib import Path
from typing import Any

from ..errors import SkinError
from .locks import locked

#: Version of the lines; readers ignore lines of an unknown version.
VERSION = 1
#: The file whose lock is the folder's.
LOCK_NAME = ".skinglow_lock"
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


def this_process() -> str:
    """A name for this process among all machines that share a folder."""
    return f"{platform.node()}-{os.getpid()}"


def append_line(path: Path, line: str) -> None:
    """Appends a line to a file, after the end of one that a worker that died did not finish."""
    with path.open("a+b", buffering=0) as file:
        size = file.seek(0, os.SEEK_END)
        truncated = size > 0 and (file.seek(size - 1), file.read(1))[1] != b"\n"
        file.write(b"\n" * truncated + line.encode() + b"\n")
        os.fsync(file.fileno())


class Manifest:
    """The manifests of one folder: reads all, appends to that of this worker."""

    def __init__(self, folder: Path, worker: str = "") -> None:
        if any(c in '/\\:*?"<>|' for c in worker):
            raise SkinError(f"The worker's name '{worker}' is not allowed in file names: use letters, digits, - and _")
        self.folder, self.worker = folder, worker
        self.path = folder / (f"manifest-{worker}.jsonl" if worker else "manifest.jsonl")
        self._entries: list[dict[str, Any]] = []
        self._read: dict[Path, int] = {}  #: bytes of each file

    def entries(self) -> list[dict[str, Any]]:
        """All complete lines of the folder's manifests; lines truncated by a worker that died are skipped."""
        paths = sorted(self.folder.glob("manifest*.jsonl"))
        if any(not path.exists() or path.stat().st_size < size for path, size in self._read.items()):
            self._entries, self._read = [], {}
        for path in paths:
            start = self._read.get(path, 0)
            if path.stat().st_size == start:
                continue
            with path.open("rb") as file:
                file.seek(start)
                # The rest, without an end, may still be written.
                lines = file.read().rpartition(b"\n")
            self._read[path] = start + len(lines[0]) + len(lines[1])
            self._entries += [entry for line in lines[0].split(b"\n") if (entry := _entry(line)) is not None]
        return list(self._entries)

    def check_writable(self) -> None:
        """Raises OSError if this worker cannot append."""
        with locked(self.folder / LOCK_NAME), self.path.open("ab"):
            pass

    def append(self, entry: dict[str, Any], publish: Callable[[], bool] | None = None) -> bool:
        """Appends a line atomically; raises OSError if that fails, and ValueError on values that JSON lacks (NaN).

        publish  called before, under the folder's lock; returns whether to append
        Returns whether the line was appended.
        """
        line = json.dumps({"skinglow_manifest": VERSION, **entry}, allow_nan=False, ensure_ascii=False)
        with locked(self.folder / LOCK_NAME) as is_locked:
            if not is_locked and not self.worker:
                self.worker = this_process()
                self.path = self.folder / f"manifest-{self.worker}.jsonl"
            if publish is not None and not publish():
                return False
            append_line(self.path, line)
            return True


def _entry(line: bytes) -> dict[str, Any] | None:
    try:
        entry = json.loads(line)
    except ValueError:
        return None
    return entry if isinstance(entry, dict) and entry.get("skinglow_manifest") == VERSION else None
