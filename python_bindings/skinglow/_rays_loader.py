"""Loads the compiled module with Embree, on the first call and not before."""

from __future__ import annotations

import importlib
import os
import sys
from functools import cache
from types import ModuleType

__all__ = ["load_rays"]


@cache
def load_rays() -> ModuleType:
    """Import skinglow._rays so that its Embree answers its calls.

    Blender's full programs load an Embree for everybody. Version 4 has the names of version 3 but not
    its calling conventions, and the first one loaded takes all calls: rays then miss without a word.
    RTLD_DEEPBIND makes the module look in its own libraries first.
    """
    deep = getattr(os, "RTLD_DEEPBIND", 0)
    if not deep or _is_sanitized() or _same_embree_is_loaded():
        return importlib.import_module("skinglow._rays")
    flags = sys.getdlopenflags()
    sys.setdlopenflags(os.RTLD_NOW | os.RTLD_LOCAL | deep)
    try:
        return importlib.import_module("skinglow._rays")
    finally:
        sys.setdlopenflags(flags)


def _same_embree_is_loaded() -> bool:
    """Debian's Blender brings the very library that this module uses, and crashes at its end if it is bound deeply."""
    try:
        with open("/proc/self/maps") as maps:
            return "libembree3" in maps.read()
    except OSError:
        return False


def _is_sanitized() -> bool:
    """Sanitizers put functions of their own before everybody's and refuse RTLD_DEEPBIND."""
    return "libasan" in os.environ.get("LD_PRELOAD", "")
