"""Packs the Blender add-on: an extension for Blender 4.2 and later, and an older sort of add-on for 3.4.

Usage: zips.py PROJECT PACKAGES SCRIPT_ACCESS_WHEEL MANUAL PARTS TARGET
(by a Python whose environment holds bpy 4.2 or later; TARGET: a key of PLATFORMS, or "all", one extension for all)
"""

import ast
import json
import os
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
#: How a wheel's name ends that is for a target, whose name is Blender's own.
PLATFORMS = {
    "linux-x64": "manylinux*_x86_64",
    "windows-x64": "win_amd64",
    "macos-arm64": "macosx_*_arm64",
    "macos-x64": "macosx_*_x86_64",
}


def main(project: Path, packages: Path, script_access: Path, manual: Path, parts: Path, target: str) -> None:
    version = project_version(project)
    if addon_version(project) != version:
        sys.exit(f"the add-on's bl_info says {addon_version(project)}, the project is {version}: make them equal")
    targets = list(PLATFORMS) if target == "all" else [target]
    wheels = {each: wheels_of(packages, version, each) for each in targets}
    if lacking := [each for each, found in wheels.items() if not found]:
        sys.exit(f"there are no wheels for {' and '.join(lacking)} in {packages}: scripts/package makes them")
    with tempfile.TemporaryDirectory() as folder:
        extension = Path(folder) / "extension"
        copy_addon(project, manual, parts, extension)
        leave_out_old_ways(extension)
        held = {each: [found[tag] for tag in EXTENSION_PYTHONS if tag in found] for each, found in wheels.items()}
        name = "all-platforms" if target == "all" else target
        pack_extension(project, parts, extension, version, name, held, script_access, packages)
        legacy = {tag: wheels[target][tag] for tag in LEGACY_PYTHONS if target == "linux-x64" and tag in wheels[target]}
        if legacy:
            copy_addon(project, manual, parts, Path(folder) / "legacy" / ADDON)
            pack_legacy(Path(folder) / "legacy", version, legacy, packages)


def wheels_of(packages: Path, version: str, target: str) -> dict[str, Path]:
    found = sorted(packages.glob(f"skinglow-{version}-*{PLATFORMS[target]}.whl"))
    return {wheel.name.split("-")[2]: wheel for wheel in found}


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


def leave_out_old_ways(folder: Path) -> None:
    """What Blender before 4.2 needs and an extension must not have: bl_info, a folder of its own in the search path."""
    (folder / "bundled_core.py").unlink()
    module = folder / "__init__.py"
    text = module.read_text()
    lines = text.splitlines(keepends=True)
    (info,) = (
        node
        for node in ast.parse(text).body
        if isinstance(node, ast.Assign) and "bl_info" in ast.unparse(node.targets[0])
    )
    del lines[info.lineno - 1 : info.end_lineno + 1]
    text, count = re.subn(r"\bbundled_core,\s+", "", "".join(lines))
    if count != 2:
        sys.exit("blender_addon/skinglow_blender/__init__.py names bundled_core otherwise than zips.py expects")
    module.write_text(text)


def pack_extension(
    project: Path,
    parts: Path,
    folder: Path,
    version: str,
    name: str,
    held: dict[str, list[Path]],
    script_access: Path,
    packages: Path,
) -> None:
    """By Blender's own builder, which checks the manifest and each wheel's name."""
    wheels = [wheel for each in held.values() for wheel in each] + [script_access]
    (folder / "wheels").mkdir()
    for wheel in wheels:
        shutil.copy(wheel, folder / "wheels")
    names = ",\n".join(f'    "./wheels/{wheel.name}"' for wheel in wheels)
    manifest = (project / "blender_addon" / "blender_manifest.toml.in").read_text()
    manifest = manifest.replace("@VERSION@", version).replace("@PLATFORMS@", json.dumps(list(held)))
    told = json.loads((parts / "holders.json").read_text())
    for key, own in (("license", "SPDX:GPL-3.0-or-later"), ("copyright", "2026 Skinglow contributors")):
        manifest = manifest.replace(f"@{key.upper()}@", json.dumps([own, *told[key]], indent=4))
    (folder / "blender_manifest.toml").write_text(manifest.replace("@WHEELS@", f"[\n{names},\n]"))
    package = packages / f"{ADDON}-{version}-{name}.zip"
    set_dates_and_modes(folder)
    site = Path(sysconfig.get_path("purelib"))
    builder = next(site.glob("bpy/*/scripts/addons_core/bl_pkg/cli/blender_ext.py"))
    paths = ["--source-dir", str(folder), "--output-filepath", str(package)]
    command = [sys.executable, str(builder), "build", *paths]
    done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, check=False)
    if done.returncode:
        sys.exit(f"Blender's builder refused the extension:\n{done.stdout}")


def set_dates_and_modes(folder: Path) -> None:
    """The one date and mode of all that is packed, whoever packs it, so that the same files make the same zip."""
    when = int(os.environ["SOURCE_DATE_EPOCH"])
    for path in folder.rglob("*"):
        path.chmod(0o755 if path.is_dir() else 0o644)
        os.utime(path, (when, when))


def pack_legacy(folder: Path, version: str, wheels: dict[str, Path], packages: Path) -> None:
    """The add-on's folder, with the core unpacked into `lib`: modules of several Pythons lie side by side."""
    for wheel in wheels.values():
        with zipfile.ZipFile(wheel) as archive:
            archive.extractall(folder / ADDON / "lib")
    set_dates_and_modes(folder)
    target = packages / f"{ADDON}-{version}-legacy-{'-'.join(wheels)}-linux-x64.zip"
    with zipfile.ZipFile(target, "w", zipfile.ZIP_DEFLATED) as archive:
        for path in sorted(folder.rglob("*")):
            if path.is_file():
                archive.write(path, path.relative_to(folder))


main(*(Path(argument) for argument in sys.argv[1:6]), target=sys.argv[6])
