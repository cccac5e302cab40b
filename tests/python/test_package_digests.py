"""What scripts/package takes for made already: nothing that was made by another recipe."""

import shutil
import subprocess
from pathlib import Path

import pytest

PROJECT = Path(__file__).parents[2]
#: Sourced as scripts/package does it, with what it has set by then.
DIGEST = """
set -euo pipefail
project=$PWD steps=$PWD/packaging built=$PWD/built target={target} toolchain=$PWD/packaging/portable_{system}.cmake
source packaging/wheels.sh
build_digest {settings}
"""


def digest(project: Path, target: str = "windows-x64", settings: str = "SKINGLOW_RAYS=ON") -> str:
    script = DIGEST.format(target=target, system=target.partition("-")[0], settings=settings)
    asked = ["bash", "-c", script]
    done = subprocess.run(asked, cwd=project, capture_output=True, text=True, check=True)
    assert done.stderr == ""
    return done.stdout


@pytest.fixture
def project(tmp_path: Path) -> Path:
    shutil.copytree(PROJECT / "packaging", tmp_path / "packaging")
    shutil.copy(PROJECT / "pyproject.toml", tmp_path)
    for name in ("embree", "highway"):
        (tmp_path / "built" / name).mkdir(parents=True)
        (tmp_path / "built" / name / "digest").write_text(name)
    return tmp_path


def test_build_folder_is_kept_while_nothing_changes(project: Path) -> None:
    assert digest(project) == digest(project)


@pytest.mark.parametrize(
    "changed",
    [
        "built/embree/digest",
        "built/highway/digest",
        "packaging/exported_symbols.map",
        "packaging/pins/package.txt",
        "packaging/portable_modules.cmake",
        "packaging/portable_tools.sh",
        "packaging/portable_windows.cmake",
        "packaging/wheels.sh",
        "packaging/windows.sh",
        "pyproject.toml",
    ],
)
def test_another_recipe_asks_for_another_build_folder(project: Path, changed: str) -> None:
    before = digest(project)
    with (project / changed).open("a") as file:
        file.write("\n# changed")
    assert digest(project) != before


def test_another_setting_or_target_asks_for_another_build_folder(project: Path) -> None:
    found = {digest(project), digest(project, settings="SKINGLOW_RAYS=OFF"), digest(project, target="macos-x64")}
    assert len(found) == 3
