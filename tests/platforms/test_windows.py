"""The extension for Windows in Blender's Python module under Wine: installed from its zip into a clean profile.
scripts/test_windows runs this; SKINGLOW_WINDOWS_PYTHON is the Windows Python that has bpy.
"""

import json
import os
import shutil
import subprocess
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).parents[2]
PACKAGES = Path(os.environ.get("SKINGLOW_PACKAGES", PROJECT / "build" / "packages"))


def test_installed_by_blender_for_windows_and_used(tmp_path: Path) -> None:
    folder = tmp_path / "Größe und имя"  # by any name that a person may choose
    (folder / "profile").mkdir(parents=True)
    shutil.copy(PROJECT / "tests" / "blender" / "installed_package.py", folder)
    (package,) = PACKAGES.glob("skinglow_blender-*-windows-x64.zip")
    shutil.copy(package, folder / "package.zip")

    def run(*task: str) -> dict:
        command = ["wine", os.environ["SKINGLOW_WINDOWS_PYTHON"], "installed_package.py", "found.json", *task]
        own = {"BLENDER_USER_RESOURCES": windows_name(folder / "profile"), "PYTHONUTF8": "1"}
        ours = ("PYTHON", "SKINGLOW", "BLENDER_")
        environment = {name: value for name, value in os.environ.items() if not name.startswith(ours)} | own
        done = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            stdin=subprocess.DEVNULL,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            errors="replace",
            timeout=300,
            check=False,
        )
        # The module's exit crashes under Wine after all is done and written.
        assert (folder / "found.json").exists(), done.stdout[-6000:]
        found = json.loads((folder / "found.json").read_text())
        (folder / "found.json").unlink()
        return found

    name = "bl_ext.user_default.skinglow_blender"
    assert run("install", windows_name(folder / "package.zip"))["enabled"] == name
    found = run("use")
    assert found["enabled"] == name and found["functions"] == []
    for part in ("skinglow", "core", "rays", "addon"):
        assert found[part].startswith(windows_name(folder / "profile")), found[part]
    np.testing.assert_allclose(found["thickness_mm"], 20.0, rtol=0.03)
    np.testing.assert_allclose(found["shown"], found["expected"], rtol=1e-6)
    visible = found["visible"]
    assert visible["off"][0] == visible["alone"][0] == 1.0 and visible["wall"] == [0.0, 0.0], visible
    assert 0.3 < visible["half"][0] < 0.7, visible
    assert found["refused"]["thickness"][0] == "ValueError" and "triangles" in found["refused"]["thickness"][1]
    assert found["refused"]["cancelled"][0] == "ThicknessCancelled"
    assert found["refused"]["raised by progress"][0] == "ZeroDivisionError"
    assert 0.0 < found["render"] < 100.0
    assert found["batch"] == {"counts": [[2, 0, 0], [0, 2, 0]], "lines": ["rig", "rig"]}
    assert found["handlers_left"] == []


def windows_name(path: Path) -> str:
    """As Wine shows this machine's files."""
    return "Z:" + str(path).replace("/", "\\")
