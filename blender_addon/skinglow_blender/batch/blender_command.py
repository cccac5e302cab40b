# SPDX-License-Identifier: GPL-3.0-or-later
"""A command line of the add-on, as Blender starts it."""

import sys
from collections.abc import Callable, Sequence
from typing import Any, NoReturn

import bpy


class BlenderCommand:
    """`blender --command NAME` where Blender has such commands (4.2 and later), and `main` for a script."""

    def __init__(self, name: str, run: Callable[[Sequence[str]], int]) -> None:
        """run: takes the arguments, returns the exit code."""
        self.name, self.run = name, run
        self._handle: Any = None

    @property
    def is_registered(self) -> bool:
        """Whether Blender knows it."""
        return self._handle is not None

    def main(self, arguments: Sequence[str] | None = None) -> NoReturn:
        """Runs with the arguments after `--` on Blender's command line, and quits Blender with the exit code."""
        if arguments is None:
            arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else []
        code = self.run(arguments)
        sys.stdout.flush()
        raise SystemExit(code)

    def register(self) -> None:
        """Makes it known to Blender."""
        if hasattr(bpy.utils, "register_cli_command"):
            self._handle = bpy.utils.register_cli_command(self.name, self.run)

    def unregister(self) -> None:
        """Reverts `register`."""
        if self._handle is not None:
            bpy.utils.unregister_cli_command(self._handle)
            self._handle = None
