"""What a task of a farm costs beside its pictures: starting Blender, the add-on, opening the file, checking inputs.

Usage: batch_start.py SCENE.blend COMMAND...      such as: batch_start.py head.blend blender -b -y
COMMAND is Blender with the add-on, or a Python with bpy and studies/batch/in_wheel.py. Prints processor
seconds of a task whose ten pictures are all there, the best of seven runs, and the frames a task needs for 5 %.
"""

import math
import os
import subprocess
import sys
import tempfile

RUNS, SHARE = 7, 0.05
EXPRESSION = "import skinglow_blender as sb; sb.batch_main()"


def seconds(command: list[str]) -> float:
    before = os.times()
    subprocess.run(command, check=True, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL)
    after = os.times()
    return after.children_user + after.children_system - before.children_user - before.children_system


def main(scene: str, command: list[str]) -> None:
    is_wheel = command[-1].endswith(".py")
    start = [*command, "--blend", scene] if is_wheel else [*command, scene, "--python-expr", EXPRESSION, "--"]
    with tempfile.TemporaryDirectory() as folder:
        task = [*start, "--frames", "1-10", "--out", folder]
        pictures = seconds(task)
        cost = min(seconds(task) for _ in range(RUNS))
    picture = max(pictures - cost, 1e-3) / 10
    frames = math.ceil(cost * (1.0 / SHARE - 1.0) / picture)
    print(f"start {cost:.2f} s, a picture {picture:.2f} s: {frames} frames a task and core keep the start below 5 %")


if __name__ == "__main__":
    main(sys.argv[1], sys.argv[2:])
