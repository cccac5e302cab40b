# SPDX-License-Identifier: GPL-3.0-or-later
"""Files and folders that are written whole or not at all, also where Blender is killed meanwhile."""

import ctypes
import os
import sys
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path

#: Of renameat2 (Linux 3.15, glibc 2.28, both older than what Blender asks for).
AT_FDCWD, RENAME_EXCHANGE = -100, 2


@contextmanager
def whole_file(path: Path) -> Iterator[Path]:
    """Context manager with a file to write, which takes the place of `path` when it is complete and on the disk.

    It lies beside it, with a dot before its name; where something fails nothing is left of it.
    """
    partial = path.with_name(f".{path.stem}.{os.getpid()}.part{path.suffix}")
    try:
        yield partial
        with partial.open("rb+") as file:
            os.fsync(file.fileno())
        os.replace(partial, path)
    finally:
        partial.unlink(missing_ok=True)


def exchange(first: Path, second: Path) -> bool:
    """Exchanges the names of two folders of one file system, in one step; returns whether the system could."""
    if not sys.platform.startswith("linux"):
        return False
    call = getattr(ctypes.CDLL(None), "renameat2", None)
    return call is not None and not call(
        AT_FDCWD, os.fsencode(first), AT_FDCWD, os.fsencode(second), ctypes.c_uint(RENAME_EXCHANGE)
    )
