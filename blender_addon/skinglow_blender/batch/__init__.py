# SPDX-License-Identifier: GPL-3.0-or-later
"""Frames x light rigs as pictures, resumable, with a manifest of what each picture was made with (docs/batch.md)."""

from .command import main, register, unregister
from .render import BatchResult, BatchStep, render_batch
from .rigs import Rig

__all__ = ["BatchResult", "BatchStep", "Rig", "main", "register", "render_batch", "unregister"]
