"""Takes docs/images/panel.png: a full Blender in a virtual display, and a click on the panel's button.

Usage: python scripts/panel_pictures [BLENDER [PICTURE]]
Needs Xvfb and the core as a folder, made by scripts/build. Only for Blender before 4.2: later versions take black
screenshots in Xvfb.
"""

import os
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[1]
SCREEN = (1440, 900)


def main(blender: str = "blender", picture: str = str(PROJECT / "docs" / "images" / "panel.png")) -> None:
    with tempfile.TemporaryDirectory() as profile:
        command = ["xvfb-run", "-a", "-s", "-screen 0 {}x{}x24".format(*SCREEN), blender, "--factory-startup"]
        command += ["--enable-event-simulate", "--window-geometry", "0", "0", *map(str, SCREEN)]
        command += ["-P", str(HERE / "panel_window.py"), "--", str(Path(picture).resolve())]
        command += [str(PROJECT / "blender_addon"), str(PROJECT / "build" / "envs" / "site")]
        environment = {**os.environ, "BLENDER_USER_RESOURCES": profile}
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, check=False
        )
    if "STEPS DONE" not in done.stdout or "Traceback" in done.stdout:
        sys.exit(f"the picture was not taken:\n{done.stdout}")
    print(picture)


main(*sys.argv[1:])
