"""A display for windows of Blender on a machine that has none."""

from __future__ import annotations

import os
import shutil
import subprocess
import tempfile
from collections.abc import Iterator
from contextlib import contextmanager

from studies.progress import StudyError


@contextmanager
def virtual_display(width: int = 1280, height: int = 1024) -> Iterator[str]:
    """Xvfb with one screen of that many pixels, 24 bits deep, while the block runs; the name for DISPLAY, as ":99".

    The server itself takes the first free number: xvfb-run -a looks for one before it starts, and of two that start
    together one fails.
    Raises StudyError where Xvfb is not installed or does not start.
    """
    if shutil.which("Xvfb") is None:
        raise StudyError("a window of Blender needs a display: install xvfb (scripts/setup --tests does)")
    read, write = os.pipe()
    command = ["Xvfb", "-displayfd", str(write), "-screen", "0", f"{width}x{height}x24", "-nolisten", "tcp"]
    with tempfile.TemporaryFile("w+") as log:
        server = subprocess.Popen(command, pass_fds=[write], stderr=log)
        os.close(write)
        try:
            with os.fdopen(read) as answer:
                number = answer.readline().strip()
            if not number:
                server.wait()
                log.seek(0)
                raise StudyError(f"Xvfb did not start: {log.read()[-500:]}")
            yield f":{number}"
        finally:
            server.terminate()
            server.wait()
