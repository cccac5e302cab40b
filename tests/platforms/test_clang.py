"""The preset `clang`: the other compiler builds all of the C++ with its warnings as errors, and computes the same."""

import json
import subprocess
from pathlib import Path

import numpy as np

PROJECT = Path(__file__).parents[2]


def test_clang_builds_the_preset_and_its_program_computes_the_same() -> None:
    options = ["-DSKINGLOW_TESTS=OFF"]  # their code is GoogleTest's, for the most part
    subprocess.run(["cmake", "--preset", "clang", *options], cwd=PROJECT, check=True, capture_output=True)
    done = subprocess.run(
        ["cmake", "--build", "--preset", "clang"], cwd=PROJECT, capture_output=True, text=True, check=False
    )
    assert done.returncode == 0, done.stdout[-6000:]
    asked = ["weights", "tests/data/all_kinds.json", "--json"]
    told = []
    for preset in ("clang", "release"):
        program = PROJECT / "build" / preset / "bin" / "skinglow"
        done = subprocess.run([program, *asked], cwd=PROJECT, capture_output=True, text=True, check=True)
        told.append(json.loads(done.stdout)["weight"])
    np.testing.assert_allclose(told[0], told[1], rtol=1e-12)
