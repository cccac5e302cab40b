# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders frames x light rigs, resumable, with a manifest of the inputs of each picture (docs/batch.md)."""

from . import command, povray_command
from .render import BatchResult, BatchStep, render_batch
from .rigs import Rig

__all__ = ["COMMANDS", "BatchResult", "BatchStep", "Rig", "render_batch"]

#: The command lines: their `register` and `unregister` are called with those of the add-on.
COMMANDS = (command.COMMAND, povray_command.COMMAND)
