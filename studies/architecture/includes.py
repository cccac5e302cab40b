"""The floors of the C++ core, and which of them includes which: read from the build files and the #include lines."""

from __future__ import annotations

import re
from collections import Counter
from collections.abc import Iterator
from pathlib import Path

#: The floor of each public header: the folder of core/src that implements it.
PUBLIC = {
    "angular_weight.h": "radiometry",
    "box.h": "geometry",
    "environment.h": "radiometry",
    "face_tiles.h": "tiles",
    "light.h": "light",
    "light_weights.h": "light",
    "lut.h": "skin",
    "mesh.h": "geometry",
    "occlusion.h": "rays",
    "povray.h": "povray",
    "rig.h": "rig",
    "shape.h": "shape",
    "slab.h": "slab",
    "spectrum.h": "color",
    "surface_lighting.h": "rig",
    "thickness.h": "rays",
    "tissue.h": "skin",
}
_INCLUDE = re.compile(r'^\s*#\s*include\s+(<skinglow/([\w/]+\.h)>|"([\w/]+\.(?:h|inc))")', re.MULTILINE)


def floors(core: Path) -> list[str]:
    """The folders of core/src from the ground up, in the order in which core/CMakeLists.txt names them."""
    text = (core / "CMakeLists.txt").read_text()
    text = re.sub(
        r"foreach\(folder ([^)]*)\)\s*add_subdirectory\(src/\$\{folder\}\)",
        lambda found: "".join(f"add_subdirectory(src/{name})\n" for name in found[1].split()),
        text,
    )
    return re.findall(r"add_subdirectory\(src/(\w+)\)", text)


def sources(folder: Path) -> list[Path]:
    return sorted(path for path in folder.rglob("*") if path.suffix in (".h", ".cpp"))


def included(path: Path) -> Iterator[tuple[str, bool]]:
    """Each of a file's includes from this project: its path or name, and whether it is a public header."""
    for _, public, private in _INCLUDE.findall(path.read_text()):
        yield public or private, bool(public)


def arrows(core: Path) -> Counter[tuple[str, str]]:
    """How often files of one folder, its public headers among them, include headers of another: {(from, to): count}."""
    found: Counter[tuple[str, str]] = Counter()
    for floor in floors(core):
        headers = [core / "include" / "skinglow" / name for name in PUBLIC if PUBLIC[name] == floor]
        for path in [*sources(core / "src" / floor), *filter(Path.exists, headers)]:
            for name, is_public in included(path):
                to = PUBLIC[name] if is_public else name.split("/")[0] if "/" in name else floor
                if to != floor:
                    found[floor, to] += 1
    return found


def arrows_text(core: Path) -> str:
    """The floors and arrows on one line, which the picture carries: it is out of date when they differ."""
    return "; ".join(floors(core)) + " | " + "; ".join(f"{a} > {b}" for a, b in sorted(arrows(core)))
