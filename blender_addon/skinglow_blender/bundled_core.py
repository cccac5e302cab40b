# SPDX-License-Identifier: GPL-3.0-or-later
"""Where the compiled core lies when the add-on's zip brings it: Blender before 4.2 installs no wheels."""

import sys
from pathlib import Path

FOLDER = Path(__file__).parent / "lib"


def register() -> None:
    """Makes the core importable, for the add-on and for scripts, ahead of any other that may be about."""
    if FOLDER.is_dir() and str(FOLDER) not in sys.path:
        sys.path.insert(0, str(FOLDER))


def unregister() -> None:
    """Takes the folder back out of the search path."""
    if str(FOLDER) in sys.path:
        sys.path.remove(str(FOLDER))
