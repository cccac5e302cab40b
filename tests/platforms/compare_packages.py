"""Tells whether two builds made the same packages, byte by byte, and if not, which files in them differ.

Usage: compare_packages.py FOLDER AGAIN     (packages that AGAIN lacks do not count)
"""

import hashlib
import sys
import tarfile
import zipfile
from pathlib import Path


def main(folder: Path, again: Path) -> None:
    others = sorted(path for path in again.iterdir() if path.suffix in (".whl", ".zip", ".gz"))
    if not others:
        sys.exit(f"there are no packages in {again}")
    different = 0
    for other in others:
        path = folder / other.name
        if not path.exists():
            print(f"{other.name}: is not in {folder}")
        elif path.read_bytes() == other.read_bytes():
            print(
                f"{other.name}: {hashlib.sha256(path.read_bytes()).hexdigest()}, {path.stat().st_size:,} bytes, equal"
            )
            continue
        else:
            print(f"{other.name}: differs")
            for line in differences(path, other):
                print(f"    {line}")
        different += 1
    if different:
        sys.exit(f"{different} of {len(others)} packages differ")


def differences(path: Path, other: Path) -> list[str]:
    """What differs between two archives: files, their order, or what is told of them."""
    mine, theirs = members(path), members(other)
    lines = [f"{name}: only once" for name in sorted(mine.keys() ^ theirs.keys())]
    for name in mine.keys() & theirs.keys():
        (data, told), (other_data, other_told) = mine[name], theirs[name]
        if data != other_data:
            count = sum(a != b for a, b in zip(data, other_data, strict=False))
            lines.append(f"{name}: {len(data)} and {len(other_data)} bytes, {count} differ in the common part")
        if told != other_told:
            lines.append(f"{name}: {told} and {other_told}")
    if not lines and list(mine) != list(theirs):
        lines.append("the files have another order")
    return lines or ["the same files: packed in another way"]


def members(path: Path) -> dict[str, tuple[bytes, str]]:
    """By name, the bytes, and the date and the mode."""
    if path.suffix == ".gz":
        with tarfile.open(path) as archive:
            found = {}
            for entry in archive:
                data = archive.extractfile(entry).read() if entry.isfile() else b""
                found[entry.name] = data, f"{entry.mtime}, {entry.mode:o}"
            return found
    with zipfile.ZipFile(path) as archive:
        return {
            entry.filename: (archive.read(entry), f"{entry.date_time}, {entry.external_attr:x}")
            for entry in archive.infolist()
        }


main(Path(sys.argv[1]), Path(sys.argv[2]))
