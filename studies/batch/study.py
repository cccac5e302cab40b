"""The example of docs/batch.md: a turning head, two light rigs, three frames, and a contact sheet of the pictures.

Another run renders only what is missing.
"""

from __future__ import annotations

import argparse
import shutil
import subprocess
from pathlib import Path

from studies import hosts
from studies.batch import contact_sheet, in_wheel
from studies.paths import IMAGES, PROJECT
from studies.progress import Progress, StudyError


def main(arguments: list[str]) -> None:
    parser = argparse.ArgumentParser(prog="python -m studies batch", description=__doc__)
    parser.add_argument("--out", type=Path, default=Path("out/batch"), help="output folder (default %(default)s)")
    parser.add_argument("--scene", action="store_true", help="only write scene.blend")
    parser.add_argument("--blender", metavar="PROGRAM", help="that writes the scene (default: the bpy wheel)")
    parser.add_argument("--docs", action="store_true", help="the picture of docs/batch.md is then that of this run")
    options = parser.parse_args(arguments)
    if options.scene and options.docs:
        parser.error("--scene makes no picture, which --docs is about: leave one of them out")
    out: Path = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    progress = Progress(out / "batch.log")
    scene = out / "scene.blend"
    # An existing scene is kept: writing it again would change the file and make all pictures out of date.
    if not scene.is_file():
        hosts.Host.find(options.blender).run("studies.batch.scene", {"blend": str(scene)}, progress)
    if options.scene:
        progress.say(f"{scene} is there")
        return
    command = [hosts.Host.find(None).program, in_wheel.__file__, "--blend", scene, "--frames", "1-3"]
    command += ["--rigs", "sunset", PROJECT / "tests" / "data" / "table1.json", "--onto", "head"]
    if subprocess.run([*command, "--out", out / "pictures"], check=False).returncode != 0:
        raise StudyError("the batch failed: see above")
    contact_sheet.draw(out / "pictures", out / "sheet.png")
    if options.docs:
        shutil.copy(out / "sheet.png", IMAGES / "batch_example.png")
    progress.say(f"open {out / 'sheet.png'}; the inputs of each picture are in {out / 'pictures' / 'manifest.jsonl'}")
