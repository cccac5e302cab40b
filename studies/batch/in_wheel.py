"""The batch command for a Python with bpy, instead of a Blender program.

Usage: python in_wheel.py OPTIONS, as after `--` of blender -b ... (docs/batch.md)
"""

import os
import sys
from pathlib import Path


def main(options: list[str]) -> None:
    sys.path.insert(0, str(Path(__file__).resolve().parents[2] / "blender_addon"))
    import bpy  # noqa: F401  first: it makes mathutils importable
    import skinglow_blender as sb

    code = 1
    try:
        sb.batch_main(options)
    except SystemExit as end:
        code = end.code if isinstance(end.code, int) else 1
    sys.stdout.flush()
    sys.stderr.flush()
    # The 4.5 wheel hangs on a normal exit.
    os._exit(code)


if __name__ == "__main__":
    main(sys.argv[1:])
