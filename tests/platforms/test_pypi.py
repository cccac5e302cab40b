"""What would go to PyPI: wheels and the source, as pip takes them."""

import os
import subprocess
import sys
import tarfile
from pathlib import Path

from installation import PACKAGES

PROJECT = Path(__file__).parents[2]


def test_twine_passes_all_of_them() -> None:
    files = [*PACKAGES.glob("skinglow-*.whl"), *PACKAGES.glob("skinglow-*.tar.gz")]
    assert len(files) >= 8
    asked = [PROJECT / "build/envs/twine/bin/twine", "check", "--strict", *files]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stdout.count("PASSED") == len(files), done.stdout


def test_source_builds_and_installs_elsewhere(tmp_path: Path) -> None:
    """In an environment that has nothing of ours; pip fetches what builds it by pyproject.toml."""
    (source,) = PACKAGES.glob("skinglow-*.tar.gz")
    with tarfile.open(source) as archive:
        tops = {Path(name).parts[1] for name in archive.getnames()}
    assert tops == {
        "CHANGELOG.md", "CMakeLists.txt", "LICENSE", "PKG-INFO", "README.md", "core", "povray_macros", "pyproject.toml",
        "python_bindings",
    }  # fmt: skip
    subprocess.run([sys.executable, "-m", "venv", tmp_path / "env"], check=True)
    python = tmp_path / "env" / "bin" / "python"
    clean = {name: value for name, value in os.environ.items() if not name.startswith(("PYTHON", "SKINGLOW"))}
    done = subprocess.run(
        [python, "-m", "pip", "install", source], cwd=tmp_path, env=clean, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout[-4000:] + done.stderr[-2000:]
    asked = [python, "-m", "skinglow", "lut", "--skin", "ear", "--size", "16", "-o", "ear.csv"]
    subprocess.run(asked, cwd=tmp_path, env=clean, check=True)
    assert len((tmp_path / "ear.csv").read_text().splitlines()) == 20
