"""Runs inside Blender: the job of a study, for hosts.Host.

Usage: in_blender.py -- MODULE JOB.json     (calls MODULE.main with the job; its result is a line of JSON)
"""

from __future__ import annotations

import importlib
import importlib.util
import json
import os
import sys
import traceback
from pathlib import Path

HERE = Path(__file__).resolve().parent
MARK = "@skinglow "


class Steps:
    """Prints each step as a line for hosts.Host."""

    def __init__(self, of: int) -> None:
        self.done, self.of = 0, of

    def __call__(self, text: str) -> None:
        self.done += 1
        print(MARK + json.dumps({"step": text, "done": self.done, "of": self.of}), flush=True)


def run(module: str, job: str) -> None:
    """Runs a job, prints its result and ends the process."""
    code = 1
    try:
        sys.path[:] = [path for path in sys.path if Path(path) != HERE]
        sys.path[:0] = [str(HERE.parent), str(HERE.parent / "blender_addon")]
        if importlib.util.find_spec("skinglow") is None:
            from studies.paths import SITE

            sys.path.append(str(SITE))  # last: a full Blender has its own numpy
        import bpy  # noqa: F401  first: it makes bmesh and mathutils importable in the wheels
        import numpy as np

        result = importlib.import_module(module).main(json.loads(Path(job).read_text()))
        print(MARK + json.dumps({"result": result}, default=np.ndarray.tolist), flush=True)
        code = 0
    except BaseException:  # any error: on a normal exit the 4.5 wheel would hang in a destructor
        traceback.print_exc()
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)


if __name__ == "__main__":
    run(*sys.argv[-2:])
