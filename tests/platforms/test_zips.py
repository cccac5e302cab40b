"""The extensions for each system, and the one for all of them: what they hold, what their names and manifests tell."""

import json
import re
import zipfile
from pathlib import Path

import pytest
import tomllib
from hosts import host_named
from installation import PACKAGES
from package_in_use import check_installed_and_used

#: By Blender's name of a system: how the wheels for it are tagged. No Blender for Intel's Macs has Python 3.13.
WHEELS = {
    "linux-x64": [r"cp311-manylinux_2_\d+_x86_64", r"cp313-manylinux_2_\d+_x86_64"],
    "windows-x64": ["cp311-win_amd64", "cp313-win_amd64"],
    "macos-arm64": ["cp311-macosx_11_0_arm64", "cp313-macosx_11_0_arm64"],
    "macos-x64": ["cp311-macosx_11_0_x86_64"],
}


def extension(name: str) -> Path:
    (package,) = [path for path in PACKAGES.glob(f"skinglow_blender-*-{name}.zip") if "-legacy-" not in path.name]
    return package


@pytest.mark.parametrize("name", [*WHEELS, "all-platforms"])
def test_holds_the_wheels_of_its_systems(name: str) -> None:
    systems = [name] if name in WHEELS else list(WHEELS)
    with zipfile.ZipFile(extension(name)) as archive:
        manifest = tomllib.loads(archive.read("blender_manifest.toml").decode())
        held = sorted(entry for entry in archive.namelist() if entry.startswith("wheels/"))
    assert manifest["platforms"] == systems
    assert sorted(path.removeprefix("./") for path in manifest["wheels"]) == held
    tags = [re.sub(r".*-(cp\d+)-cp\d+-(.*)\.whl$", r"\1-\2", entry) for entry in held if "-none-any" not in entry]
    wanted = [tag for system in systems for tag in WHEELS[system]]
    assert len(tags) == len(wanted) and all(any(re.fullmatch(tag, each) for each in tags) for tag in wanted), tags


def test_repository_has_one_for_each_system() -> None:
    index = json.loads((PACKAGES / "repository" / "index.json").read_text())
    told = {entry["archive_url"]: entry["platforms"] for entry in index["data"]}
    assert told == {f"./{extension(system).name}": [system] for system in WHEELS}


@pytest.mark.parametrize("version", ["4.5", "5.2"])
def test_one_for_all_is_installed_by_blender_and_used(version: str, tmp_path: Path) -> None:
    check_installed_and_used(host_named(version), extension("all-platforms"), tmp_path)
