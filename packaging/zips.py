"""Packs the Blender add-on: an extension for Blender 4.2 and later, and an older sort of add-on for 3.4.

Usage: zips.py PROJECT PACKAGES SCRIPT_ACCESS_WHEEL MANUAL PARTS   (by a Python that has bpy 4.2 or later)
"""

import ast
import re
import shutil
import subprocess
import sys
import sysconfig
import tempfile
import zipfile
from pathlib import Path

ADDON = "skinglow_blender"
#: Pythons of the Blenders that take extensions, and of those that only take the add-on's zip.
EXTENSION_PYTHONS = ("cp311", "cp313")
LEGACY_PYTHONS = ("cp310", "cp311")


def main(project: Path, packages: Path, script_access: Path, manual: Path, parts: Path) -> None:
    version = project_version(project)
    if addon_version(project) != version:
        sys.exit(f"the add-on's bl_info says {addon_version(project)}, the project is {version}: make them equal")
    wheels = {w.name.split("-")[2]: w for w in sorted(packages.glob(f"skinglow-{version}-*.whl"))}
    with tempfile.TemporaryDirectory() as folder:
        extension_wheels = [wheels[tag] for tag in EXTENSION_PYTHONS if tag in wheels] + [script_access]
        copy_addon(project, manual, parts, Path(folder) / "extension")
        pack_extension(project, Path(folder) / "extension", version, extension_wheels, packages)
        legacy_wheels = [wheels[tag] for tag in LEGACY_PYTHONS if tag in wheels]
        if legacy_wheels:
            copy_addon(project, manual, parts, Path(folder) / "legacy" / ADDON)
            pack_legacy(Path(folder) / "legacy", version, legacy_wheels, packages)


def project_version(project: Path) -> str:
    return re.search(r"project\(skinglow VERSION ([0-9.]+)", (project / "CMakeLists.txt").read_text())[1]


def addon_version(project: Path) -> str:
    """The version in bl_info, read as Blender reads it: without running the add-on."""
    tree = ast.parse((project / "blender_addon" / ADDON / "__init__.py").read_text())
    for node in tree.body:
        if isinstance(node, ast.Assign) and getattr(node.targets[0], "id", "") == "bl_info":
            return ".".join(str(part) for part in ast.literal_eval(node.value)["version"])
    sys.exit("the add-on has no bl_info")


def copy_addon(project: Path, manual: Path, parts: Path, folder: Path) -> None:
    leave_out = shutil.ignore_patterns("__pycache__", "*.pyc", "lib")
    shutil.copytree(project / "blender_addon" / ADDON, folder, ignore=leave_out)
    shutil.copy(project / "blender_addon" / "LICENSE", folder)
    shutil.copytree(manual, folder / "manual")
    shutil.copytree(parts / "licenses", folder / "licenses" / "third_party")
    shutil.copy(project / "LICENSE", folder / "licenses" / "skinglow.txt")
    shutil.copy(parts / "skinglow_blender.cdx.json", folder)


def pack_extension(project: Path, folder: Path, version: str, wheels: list[Path], packages: Path) -> None:
    """By Blender's own builder, which checks the manifest and each wheel's name."""
    (folder / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy(wheel, folder / "wheels")
    names = ",\n".join(f'    "./wheels/{wheel.name}"' for wheel in wheels)
    manifest = (project / "blender_addon" / "blender_manifest.toml.in").read_text()
    manifest = manifest.replace("@VERSION@", version).replace("@WHEELS@", f"[\n{names},\n]")
    (folder / "blender_manifest.toml").write_text(manifest)
    target = packages / f"{ADDON}-{version}-linux-x64.zip"
    site = Path(sysconfig.get_path("purelib"))
    builder = next(site.glob("bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    paths = ["--source-dir", str(folder), "--output-filepath", str(target)]
    command = [sys.executable, str(builder), "build", *paths]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode:
        sys.exit(f"Blender's builder refused the extension:\n{done.stdout}")


def pack_legacy(folder: Path, version: str, wheels: list[Path], packages: Path) -> None:
    """The add-on's folder, with the core unpacked into `lib`: modules of several Pythons lie side by side."""
    for wheel in wheels:
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(folder / ADDON / "lib")
    target = packages / f"{ADDON}-{version}-legacy-linux-x64.zip"
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                archive.write(path, path.relative_to(folder))


main(*(Path(argument) for argument in sys.argv[1:]))
