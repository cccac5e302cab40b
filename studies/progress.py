"""Progress of a study on the terminal; everything else goes to a log."""

from __future__ import annotations

import time
from pathlib import Path


class StudyError(Exception):
    """An error message with a remedy, in one sentence."""


class Progress:
    def __init__(self, log: Path) -> None:
        self.log = log
        self._log = log.open("w")
        self._started = time.monotonic()

    def say(self, text: str, done: int | None = None, of: int | None = None) -> None:
        far = f" {done:>2}/{of}" if done is not None and of is not None else ""
        print(f"[{time.monotonic() - self._started:5.0f} s]{far} {text}", flush=True)
        self.note(text)

    def note(self, text: str) -> None:
        self._log.write(text.rstrip("\n") + "\n")
        self._log.flush()
