# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders frames x light rigs, resumable, with a manifest of the inputs of each picture (docs/batch.md)."""

from .command import main, register, unregister
from .render import BatchResult, BatchStep, render_batch
from .rigs import Rig

__all__ = ["BatchResult", "BatchStep", "Rig", "main", "register", "render_batch", "unregister"]
