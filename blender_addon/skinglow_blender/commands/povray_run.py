# SPDX-License-Identifier: GPL-3.0-or-later
"""Runs POV-Ray on an exported scene, and the programs that compare pictures: the only ones that the add-on starts."""

import re
import shutil
import subprocess
from pathlib import Path
from typing import NamedTuple

from ..errors import SkinError


class Ran(NamedTuple):
    """What a program did."""

    succeeded: bool
    output: str
    errors: str


PROGRAMS = ("povray", "pvengine64", "pvengine")


def povray_program() -> str | None:
    """Path of POV-Ray; None if it is not installed."""
    return next(filter(None, map(shutil.which, PROGRAMS)), None)


def run_program(command: list[str], folder: Path, environment: dict[str, str] | None = None) -> Ran:
    """Runs a program in a folder; what it wrote."""
    done = subprocess.run(
        command, cwd=folder, capture_output=True, stdin=subprocess.DEVNULL, check=False, env=environment
    )
    return Ran(done.returncode == 0, done.stdout.decode(errors="replace"), done.stderr.decode(errors="replace"))


def run_povray(folder: Path, *options: str) -> None:
    """Renders scene.ini of a folder. Raises SkinError with POV-Ray's own messages, file and line, if it fails."""
    program = povray_program()
    if program is None:
        raise SkinError(f"POV-Ray is not installed on this computer; its files are in {folder}")
    done = run_program([program, "scene.ini", *options], folder)
    if not done.succeeded:
        raise SkinError(f"POV-Ray could not render {folder / 'scene.ini'}: {messages(done.errors)}")


def messages(output: str) -> str:
    """What POV-Ray says about errors: the file, the line and the reason, which it breaks at 80 characters."""
    text = re.sub(r"\s+", " ", re.sub(r"=+ \[\w+\.\.\.\] =+", " ", output))
    found = re.search(r"(File '[^']*' line \d+: )?(Possible )?(Parse |Fatal )?Error: .*", text)
    return (found[0] if found else text[-500:]).strip()
