"""Rays in a process with a malloc of its own: whole Blenders have jemalloc (Debian's 3.4, 4.3) or TBB's (5.2)."""

import os
import subprocess
import sys
from ctypes.util import find_library

import pytest

CODE = """
import numpy as np
import skinglow as sg

vertices = np.array([[x, y, z] for z in (0, -2) for x, y in ((0, 0), (10, 0), (10, 10), (0, 10))], float)
sides = [t for i in range(4) for j in [(i + 1) % 4] for t in ((i, 4 + i, 4 + j), (i, 4 + j, j))]
faces = [(0, 1, 2), (0, 2, 3), (4, 6, 5), (4, 7, 6), *sides]
light = sg.Light("POINT", position=(5.0, 5.0, -20.0), power=10.0)
assert sg.Shape(vertices, faces, sg.TISSUE_PRESETS["light"], unit_mm=1.0).light([light]).exitance.max() > 0.0
assert len(sg.thickness(vertices, faces)) == 8
sg.Occluders([(vertices, faces)])
print("traced", [line for line in open("/proc/self/maps") if "MALLOC" in line] != [])
"""


#: Debian's blender and libtbb-dev bring them.
ALLOCATORS = [library for name in ("jemalloc", "tbbmalloc_proxy") if (library := find_library(name))]


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no library takes malloc over")
def test_there_is_a_malloc_to_try() -> None:
    assert ALLOCATORS, "install libjemalloc2 or libtbbmalloc2"


@pytest.mark.skipif(sys.platform != "linux", reason="elsewhere no library takes malloc over")
@pytest.mark.parametrize("library", ALLOCATORS)
def test_rays_free_what_a_host_s_malloc_gave(library: str) -> None:
    done = subprocess.run(
        [sys.executable, "-c", CODE.replace("MALLOC", library)],
        capture_output=True,
        text=True,
        timeout=60,
        env=os.environ | {"LD_PRELOAD": library},
    )
    assert done.stdout == "traced True\n", done.stderr
    assert done.returncode == 0, done.stderr
