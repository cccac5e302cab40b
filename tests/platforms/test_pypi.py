"""What would go to PyPI."""

import os
import subprocess
import sys
from pathlib import Path

import numpy as np
from installation import PACKAGES

PROJECT = Path(__file__).parents[2]
RIG = PROJECT / "tests" / "data" / "table1.json"


def test_twine_passes_all_of_them() -> None:
    files = [*PACKAGES.glob("skinglow-*.whl"), *PACKAGES.glob("skinglow-*.tar.gz")]
    assert {path.suffix for path in files} == {".whl", ".gz"}
    asked = [PROJECT / "build/envs/twine/bin/twine", "check", "--strict", *files]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stdout.count("PASSED") == len(files), done.stdout


def test_source_package_installs_and_runs_without_the_project(tmp_path: Path) -> None:
    """Built by what pip builds with, into an empty environment, to which numpy is lent."""
    (source,) = PACKAGES.glob("skinglow-*.tar.gz")
    pip = [sys.executable, "-m", "pip", "--quiet", "--disable-pip-version-check"]
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "SKINGLOW"))}

    def run(*command: object) -> str:
        asked = list(map(str, command))
        done = subprocess.run(asked, cwd=tmp_path, env=clean, capture_output=True, text=True, check=False)
        assert done.returncode == 0, (done.stdout + done.stderr)[-4000:]
        return done.stdout

    run(*pip, "wheel", "--no-build-isolation", "--no-deps", "--wheel-dir", tmp_path, source)
    run(sys.executable, "-m", "venv", "--without-pip", tmp_path / "fresh")
    python = tmp_path / "fresh" / "bin" / "python"
    (wheel,) = tmp_path.glob("skinglow-*.whl")
    run(*pip, "--python", python, "install", "--no-deps", "--no-index", wheel)
    (packages,) = (tmp_path / "fresh").glob("lib/python3*/site-packages")
    for entry in Path(np.__file__).parents[1].glob("numpy*"):
        (packages / entry.name).symlink_to(entry)
    assert run(python, "-c", "import skinglow; print(skinglow.__file__)").startswith(str(packages))
    assert "Light3" in run(python, "-m", "skinglow", "weights", RIG)
    run(python, "-m", "skinglow", "lut", RIG, "-o", tmp_path / "lut.csv")
    assert len((tmp_path / "lut.csv").read_text().splitlines()) > 256
    # A cube of edge 2, of six faces in two triangles each.
    corners = np.array([(x, y, z) for x in (0, 2) for y in (0, 2) for z in (0, 2)], float)
    faces = np.array([(0, 1, 3, 2), (4, 6, 7, 5), (0, 4, 5, 1), (2, 3, 7, 6), (0, 2, 6, 4), (1, 5, 7, 3)])
    np.savez(tmp_path / "cube.npz", vertices=corners, triangles=np.concatenate([faces[:, :3], faces[:, [0, 2, 3]]]))
    run(python, "-m", "skinglow", "thickness", "cube.npz", "-o", "thickness.npy")
    thickness = np.load(tmp_path / "thickness.npy")[:, 3]
    assert len(thickness) == 8 and np.all((thickness > 1.8) & (thickness <= 2 * 3**0.5))
