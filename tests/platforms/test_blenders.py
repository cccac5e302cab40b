"""The extension in versions of Blender that no other test runs; prepare_blenders.sh makes their environments."""

from pathlib import Path

import pytest
from hosts import Host
from installation import PACKAGES
from package_in_use import check_installed_and_used

ENVIRONMENTS = Path(__file__).parents[2] / "build" / "envs"


@pytest.mark.parametrize("version", ["4.2", "4.3", "4.4", "5.1", "5.3"])
def test_installed_by_blender_and_used_without_the_project(
    version: str, tmp_path: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    (package,) = [path for path in PACKAGES.glob("skinglow_blender-*-linux-x64.zip") if "-legacy-" not in path.name]
    variable = f"SKINGLOW_BLENDER_{version.replace('.', '')}"
    monkeypatch.setenv(variable, str(ENVIRONMENTS / f"bpy-{version}" / "bin" / "python"))
    check_installed_and_used(Host(version, variable), package, tmp_path)
