"""A Blender with the add-on installed for a farm's workers, a scene, and `openjd`."""

import json
import os
import subprocess
from pathlib import Path

from hosts import ADDON_FOLDER, HERE, host_named

SECONDS = 600
#: Runs with the checks' scenes at hand.
START = f"""
import sys
sys.path[:0] = [{str(HERE)!r}]
import bpy
import skinglow_blender as sb
sb.register()
"""


def require(variable: str) -> str:
    """The program that a variable names; raises AssertionError if there is none."""
    path = os.environ.get(variable, "")
    assert path and Path(path).exists(), f"{variable} does not say where that is: '{path}'; scripts/test sets it"
    return path


class FarmProgram:
    """The full Blender program with the add-on in its scripts folder, as a worker has it."""

    def __init__(self, folder: Path) -> None:
        host = host_named("3.4")
        host.require()
        self.folder = folder
        # One thread: sums over several, as of normals, differ in the last bit from run to run.
        self.blender = str(folder / "blender")
        Path(self.blender).write_text(f'#!/bin/sh\nexec {host.path} -t 1 "$@"\n')
        Path(self.blender).chmod(0o755)
        scripts = folder / "scripts"
        for kind, name, source in (
            ("addons", "skinglow_blender", ADDON_FOLDER / "skinglow_blender"),
            ("modules", "skinglow", Path(os.environ["SKINGLOW_SITE_311"]) / "skinglow"),
        ):
            (scripts / kind).mkdir(parents=True)
            (scripts / kind / name).symlink_to(source)
        self.without_addon = {**os.environ, "BLENDER_USER_CONFIG": str(folder / "config")}
        self.environment = {**self.without_addon, "BLENDER_USER_SCRIPTS": str(scripts)}

    def python(self, text: str, *options: str) -> None:
        """Runs a text with the add-on."""
        command = [self.blender, "-b", *options, "--python-exit-code", "9", "--python-expr", START + text]
        done = subprocess.run(command, env=self.environment, capture_output=True, text=True, timeout=SECONDS)
        assert done.returncode == 0, done.stdout + done.stderr

    def openjd(self, *arguments: str | Path, with_addon: bool = True) -> subprocess.CompletedProcess[str]:
        """Runs the command line of Open Job Description; its tasks see the add-on or not."""
        return subprocess.run(
            [require("SKINGLOW_OPENJD"), *map(str, arguments)],
            env=self.environment if with_addon else self.without_addon,
            stdout=subprocess.PIPE,
            stderr=subprocess.STDOUT,
            text=True,
            timeout=SECONDS,
        )


def job_arguments(job: Path, blender: str) -> list[str | Path]:
    """What `openjd run` takes to run a bundle."""
    return ["run", job / "template.json", "-p", f"file://{job}/parameters.json", "-p", f"Blender={blender}"]


def manifest(folder: Path) -> list[dict]:
    """All lines of all manifests."""
    lines = [line for path in sorted(folder.glob("manifest*.jsonl")) for line in path.read_text().splitlines()]
    return [json.loads(line) for line in lines]


def assert_same_pixels(folder: Path, other: Path, names: list[str]) -> None:
    """Bit by bit; the files differ, as Cycles writes into them how long it took."""
    for name in names:
        paths = [str(folder / name), str(other / name)]
        compared = json.loads(subprocess.check_output([require("SKINGLOW_CLI"), "compare", "--json", *paths]))
        assert max(compared[channel]["max"] for channel in ("red", "green", "blue")) == 0.0, paths


def pictures(folder: Path) -> list[str]:
    """Names of the pictures."""
    return [path.relative_to(folder).as_posix() for path in sorted(folder.rglob("[!.]*.exr")) if path.is_file()]


def leftovers(folder: Path) -> list[str]:
    """Files that are neither pictures nor the batch's own."""
    ours = (".skinglow_digests", ".skinglow_lock")
    files = [path for path in folder.rglob("*") if path.is_file()]
    known = [p for p in files if p.name in ours or p.suffix == ".jsonl" or (p.suffix == ".exr" and p.name[0] != ".")]
    return sorted(str(path) for path in set(files) - set(known))
