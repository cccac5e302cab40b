"""Gives all files of a wheel one mode, and folders no entry: both would tell the umask of who built it.

Usage: wheel_modes.py WHEEL...
"""

import stat
import sys
import zipfile
from pathlib import Path

MODE = stat.S_IFREG | 0o644


def main(wheel: Path) -> None:
    with zipfile.ZipFile(wheel) as archive:
        held = [(entry, archive.read(entry)) for entry in archive.infolist() if not entry.is_dir()]
    with zipfile.ZipFile(wheel, "w", zipfile.ZIP_DEFLATED) as archive:
        for entry, data in held:
            entry.external_attr = MODE << 16
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)


for argument in sys.argv[1:]:
    main(Path(argument))
