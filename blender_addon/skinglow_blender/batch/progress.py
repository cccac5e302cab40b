# SPDX-License-Identifier: GPL-3.0-or-later
"""How a batch tells its progress: a line to standard error for each picture, and lines that farm managers parse."""

import faulthandler
import sys

import bpy

from .render import BatchResult, BatchStep

#: Managers whose lines can be written to standard output.
MANAGERS = ("openjd", "flamenco")


class Progress:
    """The progress of a batch.

    manager  one of MANAGERS; "": none
    timeout  seconds without progress after which the process ends with exit code 1; 0: never
    """

    def __init__(self, manager: str = "", timeout: float = 0.0) -> None:
        self.manager, self.timeout = manager, timeout
        self.stopped = False
        self._wait()

    def stop(self, *_signal: object) -> None:
        """Makes the batch end after the current picture."""
        self.stopped = True

    def end(self) -> None:
        """Ends the watch over the time."""
        if self.timeout:
            faulthandler.cancel_dump_traceback_later()

    def __call__(self, step: BatchStep) -> None:
        self._wait()
        if step.state == "RENDERING":
            if self.stopped:
                raise KeyboardInterrupt
            return
        what = {
            "KEPT": "kept",
            "RENDERED": f"rendered in {step.seconds:.1f} s ({step.reason})",
            "FAILED": f"FAILED: {step.reason}",
        }[step.state]
        left = "" if step.seconds_left is None else f"; {_clock(step.seconds_left)} left"
        line = f"[{step.done}/{step.total}] {step.rig}, frame {step.frame}: {what}{left}"
        say(line)
        if self.manager == "openjd":
            _print(f"openjd_progress: {100.0 * step.done / step.total:.1f}", f"openjd_status: {line}")
        elif self.manager == "flamenco":
            _print(*_flamenco_lines(step))
        if self.stopped and step.done < step.total:
            raise KeyboardInterrupt

    def fraction(self, done: float, what: str) -> None:
        """Tells how much of something other than pictures is done, 0 to 1."""
        self._wait()
        if self.stopped:
            raise KeyboardInterrupt
        say(f"{what}: {done:.0%}")
        if self.manager == "openjd":
            _print(f"openjd_progress: {100.0 * done:.1f}", f"openjd_status: {what}")

    def failed(self, reason: str) -> None:
        """Tells the manager why the command will have failed."""
        if self.manager == "openjd":
            _print(f"openjd_fail: {reason}")

    def _wait(self) -> None:
        # In C: works while Blender renders, and also if the graphics driver hangs.
        if self.timeout:
            faulthandler.dump_traceback_later(self.timeout, exit=True)


def _flamenco_lines(step: BatchStep) -> tuple[str, ...]:
    """What the worker counts as a picture, and the file that it shows."""
    if step.state == "KEPT":
        return (f'skipping existing frame "{step.file}"',)
    if step.state == "FAILED":
        return ()
    saved = f"Saved: '{step.file}'"
    # 4.5 prints such a time for each picture itself, 3.4 with a space before it, 5.0 none.
    if (4, 5) <= bpy.app.version < (5, 0):
        return (saved,)
    return saved, f"Time: {int(step.seconds) // 60:02d}:{step.seconds % 60:05.2f}"


def why_failed(result: BatchResult) -> str:
    """The first failure, and how many more there are."""
    path, reason = result.failed[0]
    more = len(result.failed) - 1
    return f"{path.name}: {reason}" + (f" (and {more} more)" if more else "")


def _clock(seconds: float) -> str:
    minutes, rest = divmod(int(seconds + 0.5), 60)
    return f"{minutes // 60}:{minutes % 60:02d}:{rest:02d}"


def say(text: str) -> None:
    """Prints to standard error."""
    print(text, file=sys.stderr, flush=True)


def _print(*lines: str) -> None:
    for line in lines:
        print(line, flush=True)
