"""Names a wheel, built on this machine for another system, for that one.

Usage: name_wheel.py WHEEL FOLDER PLATFORM   (the result is written into FOLDER)
"""

import base64
import hashlib
import re
import sys
import zipfile
from pathlib import Path


def main(wheel: Path, folder: Path, platform: str) -> None:
    name, version, python, abi, _ = wheel.stem.split("-")
    info = f"{name}-{version}.dist-info"
    with zipfile.ZipFile(wheel) as archive:
        held = [(entry, archive.read(entry)) for entry in archive.infolist() if not entry.is_dir()]
    target = folder / f"{name}-{version}-{python}-{abi}-{platform}.whl"
    record = []
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for entry, data in held:
            if entry.filename == f"{info}/WHEEL":
                data = re.sub(rb"Tag: .*", f"Tag: {python}-{abi}-{platform}".encode(), data)
            elif entry.filename == f"{info}/RECORD":
                continue
            digest = base64.urlsafe_b64encode(hashlib.sha256(data).digest()).rstrip(b"=").decode()
            record.append(f"{entry.filename},sha256={digest},{len(data)}\n")
            archive.writestr(entry, data, zipfile.ZIP_DEFLATED)
        entry = zipfile.ZipInfo(f"{info}/RECORD", held[0][0].date_time)
        archive.writestr(entry, "".join(record) + f"{info}/RECORD,,\n", zipfile.ZIP_DEFLATED)


main(Path(sys.argv[1]), Path(sys.argv[2]), sys.argv[3])
