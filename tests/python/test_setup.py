"""scripts/setup on a system that is not Debian."""

import os
import shutil
import subprocess
from pathlib import Path

PROJECT = Path(__file__).parents[2]


def system_without(*names: str, folder: Path) -> dict[str, str]:
    """An environment whose PATH has this machine's programs but those and dpkg's."""
    for directory in ("/usr/sbin", "/sbin", "/usr/bin", "/bin"):
        for program in os.scandir(directory):
            link = folder / program.name
            if not program.name.startswith("dpkg") and program.name not in names and not link.is_symlink():
                link.symlink_to(program.path)
    return {**os.environ, "PATH": str(folder)}


def test_names_what_another_system_lacks_and_installs_nothing(tmp_path: Path) -> None:
    environment = system_without("ninja", "povray", "apt-get", folder=tmp_path)
    assert shutil.which("g++", path=environment["PATH"])
    done = subprocess.run(
        ["bash", PROJECT / "scripts" / "setup"],
        env=environment,
        capture_output=True,
        text=True,
        timeout=60,
        check=False,
    )
    assert done.returncode == 1 and done.stdout == "", done.stdout
    (line,) = done.stderr.splitlines()
    assert "not Debian" in line
    told = line.partition("run this again: ")[2].split()
    assert {"ninja-build", "povray"} <= set(told) and not {"g++", "libglm-dev", "libembree-dev"} & set(told), line
