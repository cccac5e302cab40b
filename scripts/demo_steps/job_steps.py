"""Runs inside Blender: reports progress to blender_host."""

from __future__ import annotations

import json


class Steps:
    """Prints each step as a line for blender_host."""

    def __init__(self, of: int) -> None:
        self.done, self.of = 0, of

    def __call__(self, text: str) -> None:
        self.done += 1
        print("@skinglow " + json.dumps({"step": text, "done": self.done, "of": self.of}), flush=True)
