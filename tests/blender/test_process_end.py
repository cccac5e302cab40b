"""A Blender that measured thickness, traced and rendered ends with exit code 0: Debian's once crashed there."""

import subprocess
from pathlib import Path

import pytest
from hosts import HERE, host_named

SECONDS = 120


@pytest.mark.parametrize("order", ["cycles first", "core first"])
@pytest.mark.parametrize("name", ["3.4"])  # the wheels' scripts end with os._exit: that of 4.5 hangs otherwise
def test_process_ends_well_after_tracing(name: str, order: str, tmp_path: Path) -> None:
    host = host_named(name)
    assert host.path, f"Blender {name} is not there: {host.variable} does not say where it is"
    command = [host.path, "-b", "--factory-startup", "--python-exit-code", "5", "-P", str(HERE / "traces_and_ends.py")]
    done = subprocess.run(
        [*command, "--", order, str(tmp_path / "picture.png")],
        capture_output=True,
        text=True,
        timeout=SECONDS,
        env=host.environment(tmp_path),
        cwd=tmp_path,
    )
    told = f"{done.stdout[-3000:]}\n{done.stderr[-3000:]}"
    assert "traced and rendered" in done.stdout, told
    assert done.returncode == 0, told
    assert (tmp_path / "picture.png").exists()
