# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports the compiled core from the add-on's own zip: Blender before 4.2 installs no wheels."""

import sys
from pathlib import Path

FOLDER = Path(__file__).parent / "lib"


def register() -> None:
    """Makes the core importable for the add-on and for scripts, with priority over any other copy."""
    if FOLDER.is_dir() and str(FOLDER) not in sys.path:
        sys.path.insert(0, str(FOLDER))


def unregister() -> None:
    """Removes the folder from the search path."""
    if str(FOLDER) in sys.path:
        sys.path.remove(str(FOLDER))
