"""Renders povray_macros/example.pov with its warm and with its blue light: the picture of docs/povray.md."""

from __future__ import annotations

import argparse
import subprocess
import tempfile
from pathlib import Path

from PIL import Image

from studies.paths import IMAGES, PROJECT
from studies.progress import StudyError

SIZE = (480, 360)
LIGHTS = ("Blue=0", "Blue=1")


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m studies povray", description=__doc__)
    parser.add_argument("--picture", type=Path, default=IMAGES / "povray_example.png", help="(default %(default)s)")
    picture: Path = parser.parse_args(arguments).picture.resolve()
    width, height = SIZE
    sheet = Image.new("RGB", (len(LIGHTS) * width, height))
    with tempfile.TemporaryDirectory() as folder:
        for column, light in enumerate(LIGHTS):
            out = Path(folder, f"{column}.png")
            options = [f"+O{out}", f"+W{width}", f"+H{height}", "-D", "+A0.1", f"Declare={light}"]
            command = ["povray", "example.pov", *options]
            done = subprocess.run(command, cwd=PROJECT / "povray_macros", capture_output=True, text=True)
            if done.returncode != 0:
                raise StudyError(f"POV-Ray could not render example.pov: {done.stderr.strip()[-300:]}")
            sheet.paste(Image.open(out), (column * width, 0))
    sheet.save(picture)
    print(picture)
