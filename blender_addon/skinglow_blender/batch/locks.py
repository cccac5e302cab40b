# SPDX-License-Identifier: GPL-3.0-or-later
"""Locks among the workers that share a folder; a lock ends with the process that holds it."""

import errno
from collections.abc import Callable, Iterator
from contextlib import contextmanager, suppress
from pathlib import Path
from typing import BinaryIO

#: Windows locks bytes, also behind the end of a file; others may read all that is before them.
LOCKED_BYTE = 1 << 30


@contextmanager
def locked(path: Path) -> Iterator[bool]:
    """Context manager that holds the lock of a file, which is made if there is none.

    Yields whether there is a lock: some network folders have none. Raises OSError if the file cannot be opened.
    """
    with path.open("ab", buffering=0) as file:
        unlock = _lock(file)
        try:
            yield unlock is not None
        finally:
            if unlock is not None:
                with suppress(OSError):
                    unlock()


def _lock(file: BinaryIO) -> Callable[[], None] | None:
    """Waits for the lock; returns what ends it, or None if there are no locks here."""
    try:
        import fcntl
    except ImportError:  # Windows
        return _lock_byte(file)
    try:
        fcntl.flock(file, fcntl.LOCK_EX)
    except OSError:
        return None
    return lambda: fcntl.flock(file, fcntl.LOCK_UN)


def _lock_byte(file: BinaryIO) -> Callable[[], None] | None:
    import msvcrt

    def apply(how: int) -> None:
        file.seek(LOCKED_BYTE)
        msvcrt.locking(file.fileno(), how, 1)

    while True:
        try:
            apply(msvcrt.LK_LOCK)
        except OSError as error:
            if error.errno in (errno.EDEADLK, getattr(errno, "EDEADLOCK", errno.EDEADLK)):
                continue  # another worker has held it for the ten seconds that Windows waits
            return None
        return lambda: apply(msvcrt.LK_UNLCK)
