"""Blender with a clean profile, far from the project, for packages to be installed into."""

import json
import os
import shutil
import subprocess
from pathlib import Path

from hosts import HERE, Host

#: Where scripts/package put what is tested; SKINGLOW_PACKAGES says otherwise.
PACKAGES = Path(os.environ.get("SKINGLOW_PACKAGES", HERE.parents[1] / "build" / "packages"))
SECONDS = 120


def own_python(host: Host, folder: Path) -> Path:
    """An environment outside of the project's folder: all that the host's has but the project's package."""
    program = Path(host.path)
    subprocess.run([program, "-m", "venv", "--without-pip", str(folder)], check=True)
    (theirs,) = program.parents[1].glob("lib/python3*/site-packages")
    (ours,) = folder.glob("lib/python3*/site-packages")
    for entry in theirs.iterdir():
        if not entry.name.startswith(("skinglow", "pip", "__pycache__")):
            (ours / entry.name).symlink_to(entry)
    return folder / "bin" / "python"


class Installation:
    """A clean profile of one host, far from the project, and runs of Blender in it."""

    def __init__(self, host: Host, folder: Path) -> None:
        host.require()
        self.profile, self.work = folder / "profile", folder / "work"
        self.work.mkdir()
        self.script = Path(shutil.copy(HERE / "installed_package.py", self.work))
        if host.is_program:
            self.command = [host.path, "-b", "-P", str(self.script), "--"]
        else:
            self.command = [str(own_python(host, folder / "python")), str(self.script)]
        own = {"HOME": folder / "home", "BLENDER_USER_RESOURCES": self.profile}
        for part in ("CONFIG", "SCRIPTS", "DATAFILES"):  # before 4.2
            own[f"BLENDER_USER_{part}"] = self.profile / part.lower()
        for directory in own.values():
            directory.mkdir(parents=True)
        ours = ("PYTHON", "SKINGLOW", "XDG_", "BLENDER_")
        self.environment = {name: value for name, value in os.environ.items() if not name.startswith(ours)}
        self.environment |= {name: str(directory) for name, directory in own.items()} | {"PYTHONNOUSERSITE": "1"}

    def run(self, *task: str) -> dict:
        result, log = self.work / f"{task[0]}.json", self.work / f"{task[0]}.txt"
        with log.open("w") as out:
            process = subprocess.Popen(
                [*self.command, str(result), *task],
                cwd=self.work,
                env=self.environment,
                stdout=out,
                stderr=subprocess.STDOUT,
            )
            try:
                ending = f"exit code {process.wait(SECONDS)}"
            except subprocess.TimeoutExpired:
                process.kill()
                ending = f"killed after {SECONDS} s, exit code {process.wait()}"
        told = f"{task[0]} with {self.command[0]}: {ending}\n{log.read_text()[-6000:]}"
        assert ending == "exit code 0" and result.exists(), told
        return json.loads(result.read_text())
