"""Takes the first pictures of docs/blender.md: a full Blender in a virtual display, a click on the panel's button.

Usage: python scripts/panel_pictures [BLENDER [FOLDER]]
Needs a full Blender, Xvfb, the core as a folder, made by scripts/build, and the demo's head, which is downloaded; from
Blender 4.2 on also scrot. BLENDER may have options: "blender --gpu-backend opengl" where there is no GPU.
"""

import os
import shlex
import subprocess
import sys
import tempfile
from pathlib import Path

HERE = Path(__file__).resolve().parent
PROJECT = HERE.parents[1]
SCREEN = (1440, 900)
DEMO = HERE.parent / "demo_steps"
#: The scene before the click, the panel after it, and the ear up close.
PICTURES = ("guide_select.png", "panel.png", "guide_ear.png")
sys.path.insert(0, str(DEMO))

from head_source import find  # noqa: E402
from progress import Progress  # noqa: E402


def main(blender: str = "blender", folder: str = str(PROJECT / "docs" / "images")) -> None:
    head = find(None, None, Progress(PROJECT / "build" / "panel_pictures.log"))
    with tempfile.TemporaryDirectory() as profile:
        command = ["xvfb-run", "-a", "-s", "-screen 0 {}x{}x24".format(*SCREEN), *shlex.split(blender)]
        command += ["--factory-startup"]
        command += ["--enable-event-simulate", "--window-geometry", "0", "0", *map(str, SCREEN)]
        command += ["-P", str(HERE / "panel_window.py"), "--", head.mesh, str(DEMO)]
        command += [str(PROJECT / "blender_addon"), str(PROJECT / "build" / "envs" / "site")]
        command += [str(Path(folder).resolve() / name) for name in PICTURES]
        environment = {**os.environ, "BLENDER_USER_RESOURCES": profile}
        done = subprocess.run(
            command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, env=environment, check=False
        )
    if "STEPS DONE" not in done.stdout or "Traceback" in done.stdout:
        sys.exit(f"the pictures were not taken:\n{done.stdout}")
    print("\n".join(str(Path(folder) / name) for name in PICTURES))


main(*sys.argv[1:])
