# SPDX-License-Identifier: GPL-3.0-or-later
"""Batches as jobs of render farms (docs/farm.md)."""

from .openjd import write_openjd

__all__ = ["write_openjd"]
