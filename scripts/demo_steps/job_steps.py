"""Runs inside Blender: tells blender_host what is done and how far it is."""

from __future__ import annotations

import json


class Steps:
    """Says each step in a line that blender_host understands."""

    def __init__(self, of: int) -> None:
        self.done, self.of = 0, of

    def __call__(self, text: str) -> None:
        self.done += 1
        print("@skinglow " + json.dumps({"step": text, "done": self.done, "of": self.of}), flush=True)
