"""Bodies with a known thickness, mm, wound counter-clockwise from outside."""

from __future__ import annotations

import sys
from pathlib import Path

sys.path.append(str(Path(__file__).resolve().parents[1] / "python"))
from shape_bodies import ball, plate
from shape_bodies import lobe as _lobe

__all__ = ["ball", "lobe", "plate"]


def lobe(levels: int):  # noqa: ANN201  as in shape_bodies
    return _lobe(levels=levels)
