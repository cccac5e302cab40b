# SPDX-License-Identifier: GPL-3.0-or-later
"""What an update computed anew, and why."""

from typing import NamedTuple

from ..read.scene_lights import FIELDS
from ..table.skin_tables import Signature


class Rebuilt(NamedTuple):
    """One skin's table that was recomputed."""

    skin: str  #: name of the object
    mode: str  #: 'VIEWPORT' or 'RENDER': the depsgraph mode it was computed for
    before: Signature | None  #: signature of the previous table; None: there was none
    after: Signature  #: signature of the new table
    key: str = ""  #: identity.key_of the object

    @property
    def why(self) -> str:
        """What changed, as text."""
        return why_changed(self.before, self.after)


#: Fields of a signature as text.
REASONS = {
    "base": "base lookup",
    "blood_weight": "blood weight",
    "attenuation": "attenuation",
    "point": "reference point",
    "weights": "lighting",
    "surface": "its position or shape",
    "shape": "its position, size, cells or medium",
    "mesh": "its mesh",
    "world": "world",
}


def _by_name(signature: Signature) -> dict[str, list[tuple]]:
    """The lights of a signature; instances, and lights of libraries, may have one name."""
    found: dict[str, list[tuple]] = {}
    for light in signature.lights:
        found.setdefault(light[0], []).append(light)
    return found


def why_changed(before: Signature | None, after: Signature) -> str:
    """The difference between two signatures, as text."""
    if before is None:
        return "first computed"
    if before.mode != after.mode:
        return f"mode {before.mode.lower()} to {after.mode.lower()}"
    reasons = [words for name, words in REASONS.items() if getattr(before, name) != getattr(after, name)]
    old, new = _by_name(before), _by_name(after)
    reasons += [f"light '{name}' added" for name in new if len(new[name]) > len(old.get(name, ()))]
    reasons += [f"light '{name}' removed" for name in old if len(old[name]) > len(new.get(name, ()))]
    for name in new:
        if len(old.get(name, ())) == len(new[name]) and old[name] != new[name]:
            pairs = zip(zip(*old[name], strict=True), zip(*new[name], strict=True), strict=True)
            changed = [field for field, (a, b) in zip(FIELDS, pairs, strict=True) if a != b]
            reasons.append(f"light '{name}': {', '.join(changed)}")
    return "; ".join(reasons) or "its row in the image"
