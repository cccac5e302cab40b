"""Runs inside Blender: reports progress and the result to blender_host."""

from __future__ import annotations

import json
import os
import sys
import traceback
from collections.abc import Callable
from typing import Any, NoReturn

import numpy as np


class Steps:
    """Prints each step as a line for blender_host."""

    def __init__(self, of: int) -> None:
        self.done, self.of = 0, of

    def __call__(self, text: str) -> None:
        self.done += 1
        print("@skinglow " + json.dumps({"step": text, "done": self.done, "of": self.of}), flush=True)


def run(job: Callable[[], dict[str, Any]]) -> NoReturn:
    """Runs a job, prints its result as a line for blender_host, and ends the process."""
    try:
        print("@skinglow " + json.dumps({"result": job()}, default=np.ndarray.tolist), flush=True)
        code = 0
    except BaseException:  # any error: on a normal exit the 4.5 wheel would hang in a destructor
        traceback.print_exc()
        code = 1
    sys.stdout.flush()
    sys.stderr.flush()
    os._exit(code)
