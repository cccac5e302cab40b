"""The wheel for Linux on older processors, by qemu: what is compiled for newer ones must not be run there, and the
results are the same.
"""

import json
import subprocess
import sys
import zipfile
from pathlib import Path

import numpy as np
import pytest
from installation import PACKAGES

#: Thickness, a light's visible fraction and a table, by the wheel in PYTHONPATH.
SCRIPT = """
import json, sys
import numpy as np
import skinglow as sg
u, v = np.meshgrid(np.linspace(0, 2 * np.pi, 24, endpoint=False), np.linspace(0.1, np.pi - 0.1, 12))
vertices = np.stack([np.cos(u) * np.sin(v), np.sin(u) * np.sin(v), np.cos(v)], axis=2).reshape(-1, 3)
first = np.arange(11 * 24)
across = first // 24 * 24 + (first + 1) % 24
triangles = np.concatenate([np.c_[first, first + 24, across + 24], np.c_[first, across + 24, across]])
wall = (np.array([(-1.0, -1, 1.5), (0.2, -1, 1.5), (0.2, 1, 1.5), (-1, 1, 1.5)]), np.array([(0, 1, 2), (0, 2, 3)]))
light = sg.Light("POINT", power=10.0, position=(0.0, 0.0, 3.0), radius=0.5)
found = {
    "thickness": sg.thickness(vertices, triangles, unit_mm=10.0),
    "visible": sg.Occluders([wall]).visible_fraction([light], vertices, vertices, samples=64).at_points,
    "irradiance": sg.surface_irradiance([light], vertices, vertices),
    "table": sg.recolor(sg.base_lut(sg.TISSUE_PRESETS["light"], size=64), (1.0, 0.5, 0.2)),
}
assert sg.__file__.startswith(sys.argv[1]), sg.__file__
json.dump({name: np.asarray(value).tolist() for name, value in found.items()}, sys.stdout)
"""


def results(wheel: Path, *emulator: str) -> dict[str, np.ndarray]:
    done = subprocess.run(
        [*emulator, sys.executable, "-c", SCRIPT, str(wheel)],
        env={"PYTHONPATH": str(wheel), "PATH": "/usr/bin:/bin"},
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, f"exit code {done.returncode}\n{done.stderr[-4000:]}"
    return {name: np.array(value) for name, value in json.loads(done.stdout).items()}


@pytest.mark.parametrize("processor", ["Nehalem", "Haswell"])  # SSE 4.2; AVX2
def test_same_results(processor: str, tmp_path: Path) -> None:
    tag = f"cp{sys.version_info.major}{sys.version_info.minor}"
    (wheel,) = PACKAGES.glob(f"skinglow-*-{tag}-{tag}-manylinux*.whl")
    with zipfile.ZipFile(wheel) as archive:
        archive.extractall(tmp_path)
    wanted = results(tmp_path)
    found = results(tmp_path, "qemu-x86_64", "-cpu", processor)
    assert wanted["visible"].min() == 0.0 and wanted["visible"].max() == 1.0
    # A ray through an edge meets either of two triangles, as its reciprocals are rounded.
    allowed = {"thickness": 1e-3, "visible": 0.05}
    for name, value in wanted.items():
        difference = np.abs(found[name] - value).max() / np.abs(value).max()
        print(name, difference)
        assert difference <= allowed.get(name, 1e-9), name
