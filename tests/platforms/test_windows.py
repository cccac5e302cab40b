"""The packages for Windows under Wine, by Pythons that prepare_windows.sh makes: the Python tests with each
wheel, and the extension in Blender's module, installed from its zip into a clean profile.
"""

import json
import os
import re
import shutil
import subprocess
import zipfile
from pathlib import Path

import numpy as np
import pytest
from installation import PACKAGES

PROJECT = Path(__file__).parents[2]
WINDOWS = PROJECT / "build" / "windows"
#: What starts the C++ program, which is not built for Windows, POSIX's programs, or this machine's Python.
LEFT_OUT = (
    "command_line", "command_line_killed", "command_line_outputs", "docs", "files", "flamenco_job", "house",
    "mesh_formats", "package_digests", "setup", "skin_command", "stubs", "studies", "thickness_heads",
)  # fmt: skip
#: By Python, what pytest runs.
TESTS = dict.fromkeys(
    ("3.11", "3.13"), ["tests/python", *(f"--ignore=tests/python/test_{name}.py" for name in LEFT_OUT)]
)
#: The functions of Windows' C runtime, and what Windows 10 brings besides.
SYSTEM_LIBRARIES = re.compile(r"(KERNEL32|ADVAPI32|ntdll)\.dll|api-ms-win-crt-[\w-]+\.dll", re.IGNORECASE)


def windows_name(path: Path) -> str:
    """As Wine shows this machine's files."""
    return "Z:" + str(path).replace("/", "\\")


def run(python: str, arguments: list[str], folder: Path, seconds: float, **more: str) -> tuple[int, str]:
    """Of a Python for Windows, without this machine's settings: its exit code and what it says."""
    ours = ("PYTHON", "SKINGLOW", "BLENDER_", "DISPLAY")
    environment = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
    environment |= {"WINEPREFIX": str(WINDOWS / "prefix"), "WINEDEBUG": "-all", "PYTHONUTF8": "1"}
    environment |= {"PYTHONDONTWRITEBYTECODE": "1", **more}
    program = WINDOWS / f"python-{python}" / "python.exe"
    assert program.exists(), "tests/platforms/prepare_windows.sh makes it"
    done = subprocess.run(
        ["wine", program, *arguments],
        cwd=folder,
        env=environment,
        stdin=subprocess.DEVNULL,
        stdout=subprocess.PIPE,
        stderr=subprocess.STDOUT,
        text=True,
        errors="replace",
        timeout=seconds,
        check=False,
    )
    return done.returncode, done.stdout


@pytest.fixture(params=TESTS)
def wheel(request: pytest.FixtureRequest) -> tuple[str, Path]:
    tag = f"cp{request.param.replace('.', '')}"
    (path,) = PACKAGES.glob(f"skinglow-*-{tag}-{tag}-win_amd64.whl")
    return request.param, path


def test_modules_need_python_and_windows_alone(wheel: tuple[str, Path], tmp_path: Path) -> None:
    python, path = wheel
    with zipfile.ZipFile(path) as archive:
        modules = [Path(archive.extract(name, tmp_path)) for name in archive.namelist() if name.endswith(".pyd")]
    tag = f"cp{python.replace('.', '')}"
    assert sorted(module.name for module in modules) == [f"{name}.{tag}-win_amd64.pyd" for name in ("_core", "_rays")]
    for module in modules:
        told = subprocess.run(["objdump", "-p", module], capture_output=True, text=True, check=True).stdout
        needed = set(re.findall(r"DLL Name: (\S+)", told))
        own = f"python{python.replace('.', '')}.dll"
        assert own in needed and not [name for name in needed - {own} if not SYSTEM_LIBRARIES.fullmatch(name)], needed
        exported = re.search(r"\[Ordinal/Name Pointer\] Table.*?\n((?:\s+\[.*\n)*)", told)[1]
        assert [line.split()[-1] for line in exported.splitlines()] == [f"PyInit_{module.name.split('.')[0]}"]


def test_python_tests_pass(wheel: tuple[str, Path], tmp_path: Path) -> None:
    python, path = wheel
    with zipfile.ZipFile(path) as archive:
        archive.extractall(tmp_path)
    arguments = ["-m", "pytest", "-p", "no:cacheprovider", "-q", "-k", "not of_the_program", *TESTS[python]]
    code, told = run(python, arguments, PROJECT, 3000, PYTHONPATH=windows_name(tmp_path))
    assert code == 0 and re.search(r"^[1-9]\d* passed", told, re.MULTILINE), told[-6000:]
    print(told[-300:])


def test_installed_by_blender_for_windows_and_used(tmp_path: Path) -> None:
    folder = tmp_path / "Größe und имя"  # by any name that a person may choose
    (folder / "profile").mkdir(parents=True)
    shutil.copy(PROJECT / "tests" / "blender" / "installed_package.py", folder)
    (package,) = PACKAGES.glob("skinglow_blender-*-windows-x64.zip")
    shutil.copy(package, folder / "package.zip")

    def task(*arguments: str) -> dict:
        profile = windows_name(folder / "profile")
        asked = ["installed_package.py", "found.json", *arguments]
        _, told = run("3.11", asked, folder, 600, BLENDER_USER_RESOURCES=profile)
        # The module's exit crashes under Wine after all is done and written.
        assert (folder / "found.json").exists(), told[-6000:]
        found = json.loads((folder / "found.json").read_text())
        (folder / "found.json").unlink()
        return found

    name = "bl_ext.user_default.skinglow_blender"
    assert task("install", windows_name(folder / "package.zip"))["enabled"] == name
    found = task("use")
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
