"""Loads the compiled module with Embree, on the first call and not before."""

from __future__ import annotations

import importlib
from functools import cache
from types import ModuleType

from skinglow._pickled import refuse_others

__all__ = ["load_rays"]


@cache
def load_rays() -> ModuleType:
    """Import skinglow._rays.

    Not with RTLD_DEEPBIND, which would keep an Embree of another version that the host shows to everybody from taking
    the module's calls: its malloc and free would be the C library's. A whole Blender brings others (jemalloc, or
    TBB's), from which strdup and the core have memory that the module frees. require_embree refuses such an Embree.
    """
    module = importlib.import_module("skinglow._rays")
    refuse_others(module)
    return module
