"""What would go to PyPI."""

import subprocess
from pathlib import Path

from installation import PACKAGES

PROJECT = Path(__file__).parents[2]


def test_twine_passes_all_of_them() -> None:
    files = [*PACKAGES.glob("skinglow-*.whl"), *PACKAGES.glob("skinglow-*.tar.gz")]
    assert {path.suffix for path in files} == {".whl", ".gz"}
    asked = [PROJECT / "build/envs/twine/bin/twine", "check", "--strict", *files]
    done = subprocess.run(asked, capture_output=True, text=True, check=False)
    assert done.returncode == 0 and done.stdout.count("PASSED") == len(files), done.stdout
