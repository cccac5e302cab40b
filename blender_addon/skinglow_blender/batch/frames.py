# SPDX-License-Identifier: GPL-3.0-or-later
"""Frame ranges as used by render farms: "1-10,15" or "1-100x5", and in Open Job Description "1-100:5"."""

import re
from collections.abc import Iterable

from ..errors import SkinError

#: Blender's own limits of a frame number (MINAFRAME and MAXFRAME in its DNA_scene_types.h).
FIRST, LAST = -1048574, 1048574
_PART = re.compile(r"\s*(-?\d+)\s*(?:-\s*(-?\d+)\s*(?:[x:]\s*(\d+)\s*)?)?")


def parse_frames(frames: str | int | Iterable[int]) -> list[int]:
    """Frame numbers in the order given, each once.

    frames  "1-10,15", "1-100x5" or "1-100:5" (every fifth), "-5--1"; one number; or any iterable of integers
    Raises SkinError naming the invalid part.
    """
    if isinstance(frames, str):
        found = [frame for part in frames.split(",") for frame in _range(part, frames)]
    elif isinstance(frames, int):
        found = [frames]
    else:
        found = list(frames)
    for frame in found:
        if not isinstance(frame, int) or isinstance(frame, bool) or not FIRST <= frame <= LAST:
            raise SkinError(f"Frame {frame!r} is not allowed: frames are integers from {FIRST} to {LAST}")
    if not found:
        raise SkinError("No frames given: use a range such as 1-10,15")
    return list(dict.fromkeys(found))


def _range(part: str, whole: str) -> range:
    match = _PART.fullmatch(part)
    where = "" if part == whole else f" in '{whole}'"
    if match is None:
        raise SkinError(f"'{part}'{where} is not a frame range: write 7, 1-10 or 1-100x5, separated by commas")
    start, end, step = (int(number) if number else None for number in match.groups())
    if end is None:
        return range(start, start + 1)
    if end < start:
        raise SkinError(f"The frame range '{part}'{where} is reversed: write {end}-{start}")
    if step == 0:
        raise SkinError(f"The frame range '{part}'{where} has step 0: write 1 or more after the x")
    if not (FIRST <= start and end <= LAST):
        raise SkinError(f"The frame range '{part}'{where} exceeds Blender's frames, {FIRST} to {LAST}")
    return range(start, end + 1, step or 1)
