"""The core's vector kernels and Embree's on arm64: their C++ tests, which build_arm64.sh cross-builds, in an emulator.

Apple's processors cannot be had here; these are the same sources, compiler and instruction set on another system.
"""

import re
import subprocess
from pathlib import Path

import pytest

BUILT = Path(__file__).parents[2] / "build" / "portable" / "linux-arm64" / "tests" / "tests"
#: Each program, and those of its tests for which an emulator is too slow.
PROGRAMS = {
    "core/ground_tests": "",
    "core/light_tests": "",
    "core/slab_tests": "*MonteCarlo*",
    "rays/rays_tests": "",
}


@pytest.mark.parametrize("program", PROGRAMS)
def test_passes_its_cpp_tests(program: str) -> None:
    path = BUILT / program
    kind = subprocess.run(["objdump", "-f", path], capture_output=True, text=True, check=False).stdout
    assert path.exists() and b"\xb7\x00" == path.read_bytes()[18:20], f"{path} is not for arm64: {kind}"
    asked = ["qemu-aarch64", path, f"--gtest_filter=-{PROGRAMS[program]}", "--gtest_brief=1"]
    done = subprocess.run(asked, capture_output=True, text=True, timeout=1800, check=False)
    assert done.returncode == 0, (done.stdout + done.stderr)[-4000:]
    assert int(re.search(r"PASSED  \] (\d+) tests", done.stdout)[1]) > 5
