# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs POV-Ray on an exported scene."""

import re
import shutil
import subprocess
from pathlib import Path

from ..errors import SkinError

PROGRAMS = ("povray", "pvengine64", "pvengine")


def povray_program() -> str | None:
    """Path of POV-Ray; None if it is not installed."""
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


def run_povray(folder: Path, *options: str) -> None:
    """Renders scene.ini of a folder. Raises SkinError with POV-Ray's own messages, file and line, if it fails."""
    program = povray_program()
    if program is None:
        raise SkinError(f"POV-Ray is not installed on this computer; its files are in {folder}")
    # A shell of its own: POV-Ray changes the settings of a terminal.
    done = subprocess.run(
        [program, "scene.ini", *options], cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, check=False
    )
    if done.returncode != 0:
        raise SkinError(f"POV-Ray could not render {folder / 'scene.ini'}: {messages(done.stderr)}")


def messages(output: bytes) -> str:
    """What POV-Ray says about errors: the file, the line and the reason, which it breaks at 80 characters."""
    text = re.sub(r"\s+", " ", re.sub(r"=+ \[\w+\.\.\.\] =+", " ", output.decode(errors="replace")))
    found = re.search(r"(File '[^']*' line \d+: )?(Possible )?(Parse |Fatal )?Error: .*", text)
    return (found[0] if found else text[-500:]).strip()
