"""A static repository of extensions, by Blender's own program, in PACKAGES/repository: one package a platform.

Usage: repository.py PACKAGES TARGET...    (by a Python whose environment holds bpy 4.2 or later)
"""

import shutil
import subprocess
import sys
import sysconfig
from pathlib import Path


def main(packages: Path, targets: list[str]) -> None:
    folder = packages / "repository"
    shutil.rmtree(folder, ignore_errors=True)
    folder.mkdir()
    for target in targets:
        (package,) = (path for path in packages.glob(f"skinglow_blender-*-{target}.zip") if "-legacy-" not in path.name)
        shutil.copy(package, folder)
    (program,) = Path(sysconfig.get_path("purelib")).glob("bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py")
    command = [sys.executable, str(program), "server-generate", "--repo-dir", str(folder), "--html"]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode or "WARN" in done.stdout:
        sys.exit(f"Blender could not make the repository:\n{done.stdout}")


main(Path(sys.argv[1]), sys.argv[2:])
