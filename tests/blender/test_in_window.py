"""What happens only where Blender has a window: the full program, under a virtual display."""

import json
import subprocess
from pathlib import Path

from hosts import HERE, HOSTS

from studies.display import virtual_display

SECONDS = 300


def test_lookup_follows_the_view_layer_in_the_window(tmp_path: Path) -> None:
    (host,) = (host for host in HOSTS if host.is_program)
    host.require()
    result = tmp_path / "result.json"
    program = [host.path, "--factory-startup", "-P", str(HERE / "window_layers.py"), "--", str(result)]
    with virtual_display() as display:
        environment = {**host.environment(tmp_path), "DISPLAY": display}
        done = subprocess.run(program, env=environment, capture_output=True, text=True, timeout=SECONDS)
    assert result.exists(), done.stdout[-3000:] + done.stderr[-3000:]
    assert json.loads(result.read_text()) is True, json.loads(result.read_text())
