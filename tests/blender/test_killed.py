"""Blender is killed while the add-on writes: what was there is whole, and what is new is whole or not there.

endless_writer.py writes two versions of the same by turns, until SIGKILL ends it at a moment that the seed says. Each
file that is there then must be that of one version, to the byte, and those that belong together of the same one. Blend
files are never the same twice: Blender opens them. SKINGLOW_KILLS says how often each kind is killed.
"""

from __future__ import annotations

import json
import os
import random
import shutil
import signal
import subprocess
import time
from collections.abc import Callable
from pathlib import Path

import pytest
from hosts import HERE, Host, host_named

WRITER = HERE / "endless_writer.py"
KILLS = int(os.environ.get("SKINGLOW_KILLS", "8"))
SECONDS = 300.0
FRAMES = 3
#: How an EXR starts, and bytes at its end that are pixels.
EXR, PIXELS = b"v/1\x01", 120
#: By name, the bytes of a folder's files.
Files = dict[str, bytes]


def files_of(folder: Path) -> Files:
    """All but those whose name tells that they are not complete."""
    return {
        str(path.relative_to(folder)): path.read_bytes()
        for path in sorted(folder.rglob("*"))
        if path.is_file() and not any(part.startswith(".") for part in path.relative_to(folder).parts)
    }


def write_versions(host: Host, kind: str, folder: Path) -> list[Files]:
    """What each version consists of."""
    command = host.command(WRITER, [kind, str(folder), "one"])
    done = subprocess.run(
        command, env=host.environment(folder), capture_output=True, text=True, timeout=SECONDS, cwd=folder
    )
    assert done.returncode == 0, done.stdout[-3000:] + done.stderr[-3000:]
    return [files_of(folder / str(version)) for version in (0, 1)]


def kill_while_writing(host: Host, kind: str, folder: Path, delay: float) -> None:
    """Starts a writer and kills it some time after it has written once."""
    command = host.command(WRITER, [kind, str(folder)])
    with (
        (folder.parent / "output.txt").open("w") as log,
        subprocess.Popen(
            command,
            env=host.environment(folder.parent),
            cwd=folder.parent,
            stdout=subprocess.PIPE,
            stderr=log,
            text=True,
            start_new_session=True,
        ) as running,
    ):
        try:
            assert running.stdout is not None
            told = ""
            while "written" not in told:
                told = running.stdout.readline()
                assert told, (folder.parent / "output.txt").read_text()[-3000:]
            time.sleep(delay)
        finally:
            os.killpg(running.pid, signal.SIGKILL)
        running.wait(SECONDS)
        assert running.returncode == -signal.SIGKILL


def require_one_version(found: Files, versions: list[Files]) -> None:
    """All files are there, and of one version."""
    which = {name: [content == version.get(name) for version in versions] for name, content in found.items()}
    assert any(found == version for version in versions), (sorted(found), which)


def require_whole_files(found: Files, versions: list[Files]) -> None:
    """Each file is that of one of the versions."""
    for name, content in found.items():
        assert content in [version[name] for version in versions], (name, len(content))


def require_whole_pictures(found: Files, versions: list[Files]) -> None:
    """Each picture is that of one of the versions, and each line of the manifest a line."""
    manifest = found.pop("pictures/manifest.jsonl")
    for line in manifest.split(b"\n")[:-1]:
        json.loads(line)
    # Cycles writes its times before the pixels; those of a file that is cut off are not at its end.
    pixels = [{name: content[-PIXELS:] for name, content in version.items()} for version in versions]
    assert all(content.startswith(EXR) for content in found.values())
    require_whole_files({name: content[-PIXELS:] for name, content in found.items()}, pixels)
    assert len(found) == FRAMES


def require_whole_folders(found: Files, versions: list[Files]) -> None:
    """Each folder of frozen light has all frames of one version."""
    folders: dict[str, Files] = {}
    for name, content in found.items():
        folder, _, file = name.partition("/")
        folders.setdefault(folder, {})[f"Patch/{file}"] = content
    assert folders
    for content in folders.values():
        require_one_version(content, versions)


CHECKS: dict[str, Callable[[Files, list[Files]], None]] = {
    "bake": require_whole_files,
    "freeze": require_whole_folders,
    "batch": require_whole_pictures,
    "export": require_one_version,
}
#: Seconds within which the writer is killed after it has written once: several times what it takes to write.
WITHIN = {"save": 0.2, "bake": 0.1, "freeze": 0.3, "batch": 0.5, "export": 0.2}


@pytest.mark.parametrize("name", ["4.5"])
@pytest.mark.parametrize("kind", CHECKS)
def test_what_is_written_is_whole(kind: str, name: str, tmp_path: Path) -> None:
    host = host_named(name)
    host.require()
    versions = write_versions(host, kind, tmp_path)
    assert versions[0] and versions[0] != versions[1] and versions[0].keys() == versions[1].keys()
    chance = random.Random(f"{kind} {name}")
    target = tmp_path / "target"
    target.mkdir()
    for number in range(KILLS):
        delay = chance.uniform(0.0, WITHIN[kind])
        kill_while_writing(host, kind, target, delay)
        try:
            CHECKS[kind](files_of(target), versions)
        except AssertionError as error:
            raise AssertionError(f"killed {number + 1} times, at last after {delay:.4f} s: {error}") from error


@pytest.mark.parametrize("name", ["4.5"])
def test_a_blend_file_opens_and_shows_its_light(name: str, tmp_path: Path) -> None:
    host = host_named(name)
    host.require()
    chance = random.Random(f"save {name}")
    target, kept = tmp_path / "target", tmp_path / "kept"
    target.mkdir()
    kept.mkdir()
    for number in range(KILLS):
        kill_while_writing(host, "save", target, chance.uniform(0.0, WITHIN["save"]))
        # Blender makes the file that was there scene.blend1 before the new one gets its name: it may be all there is.
        left = next(path for file in ("scene.blend", "scene.blend1") if (path := target / file).exists())
        shutil.copy(left, kept / f"{number}.blend")
    command = host.command(WRITER, ["open", str(kept)])
    done = subprocess.run(
        command, env=host.environment(tmp_path), capture_output=True, text=True, timeout=SECONDS, cwd=tmp_path
    )
    assert f"{KILLS} files are whole" in done.stdout, done.stdout[-3000:] + done.stderr[-3000:]
