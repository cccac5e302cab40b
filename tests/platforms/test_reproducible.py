"""The same sources make the same packages: a target built once more, in another folder, of what was fetched alone."""

import os
import subprocess
from pathlib import Path

from installation import PACKAGES

PROJECT = Path(__file__).parents[2]
TARGET, PYTHON = "windows-x64", "3.11"
#: Fetched, and checked by digests; made anew is all else.
FETCHED = ("tools", "zig_cache", "*.tar.*", "*.jar", f"python_windows_{PYTHON}")


def test_wheel_and_source_are_the_same_to_the_byte_when_built_elsewhere(tmp_path: Path) -> None:
    again = tmp_path / "elsewhere" / "skinglow"
    listed = subprocess.run(
        ["git", "ls-files", "-co", "--exclude-standard"], cwd=PROJECT, capture_output=True, text=True
    )
    for name in listed.stdout.splitlines():
        if (PROJECT / name).is_file():
            (again / name).parent.mkdir(parents=True, exist_ok=True)
            (again / name).write_bytes((PROJECT / name).read_bytes())
            (again / name).chmod((PROJECT / name).stat().st_mode)
    (again / "build" / "portable").mkdir(parents=True)
    (again / "build" / "envs").symlink_to(PROJECT / "build" / "envs")
    for pattern in FETCHED:
        for path in (PROJECT / "build" / "portable").glob(pattern):
            (again / "build" / "portable" / path.name).symlink_to(path)
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "SKINGLOW"))}
    command = ["bash", "scripts/package", TARGET, PYTHON]
    done = subprocess.run(command, cwd=again, env=clean, capture_output=True, text=True, check=False)
    assert done.returncode == 0, done.stdout + done.stderr[-4000:]
    found = sorted(path for path in (again / "build" / "packages").glob("skinglow-*"))
    assert [path.suffix for path in found] == [".whl", ".gz"]
    for path in found:
        assert path.read_bytes() == (PACKAGES / path.name).read_bytes(), path.name
