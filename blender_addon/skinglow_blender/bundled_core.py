# SPDX-License-Identifier: GPL-3.0-or-later
"""Imports the compiled core from the add-on's own zip: Blender before 4.2 installs no wheels."""

import platform
import re
import sys
from importlib.machinery import EXTENSION_SUFFIXES
from pathlib import Path

FOLDER = Path(__file__).parent / "lib"


def register() -> None:
    """Makes the core importable for the add-on and for scripts, with priority over any other copy."""
    if not FOLDER.is_dir():
        return
    package = FOLDER / "skinglow"
    if not any((package / f"_core{suffix}").exists() for suffix in EXTENSION_SUFFIXES):
        found = sorted(re.findall(r"cpython-3(\d+)", " ".join(path.name for path in package.glob("_core.*"))))
        held = " and ".join(f"3.{minor}" for minor in found)
        own = f"{sys.version_info.major}.{sys.version_info.minor} on {platform.system()} ({platform.machine()})"
        asked = f"this package of Skinglow is for Python {held} on Linux (x86_64)"
        raise RuntimeError(f"{asked}; this Blender brings Python {own}")
    if str(FOLDER) not in sys.path:
        sys.path.insert(0, str(FOLDER))


def unregister() -> None:
    """Removes the folder from the search path."""
    if str(FOLDER) in sys.path:
        sys.path.remove(str(FOLDER))
