"""What tests share that have mesh files read: by the command line, as everything else reads them."""

import os
import subprocess
import sys
import tempfile
from dataclasses import dataclass
from pathlib import Path

import numpy as np

ROOT = Path(__file__).resolve().parents[2]
PROGRAM = Path(os.environ.get("SKINGLOW_CLI", ROOT / "build/release/bin/skinglow"))
# Of a process that another one starts and ends; its own memory would count as the first memory of the child.
PEAK = "import os, sys; pid = os.spawnv(os.P_NOWAIT, sys.argv[1], sys.argv[1:]); _, status, used = os.wait4(pid, 0); "
PEAK += "print('peak', used.ru_maxrss * 1024); sys.exit(os.waitstatus_to_exitcode(status))"


def run(*arguments, code=0):
    done = subprocess.run(
        [PROGRAM, *map(str, arguments)],
        capture_output=True,
        text=True,
        errors="replace",
        timeout=120,
        check=False,
    )
    assert done.returncode == code, done.stdout + done.stderr
    return done


def peak_memory(*arguments, code=0):
    """Bytes that the program had in memory at most, and what it said."""
    done = subprocess.run(
        [sys.executable, "-S", "-c", PEAK, PROGRAM, *map(str, arguments)],
        capture_output=True,
        text=True,
        timeout=120,
        check=False,
    )
    assert done.returncode == code, done.stdout + done.stderr
    return int(done.stdout.split("peak ")[1]), done.stderr


@dataclass
class Measured:
    positions: np.ndarray
    triangles: np.ndarray
    thickness: np.ndarray

    def corners(self):
        """The triangles as positions, in an order of their own: the least corner first, then sorted."""
        return in_order(self.positions[self.triangles])

    def by_position(self):
        return dict(zip(map(tuple, self.positions), self.thickness, strict=True))


def in_order(corners):
    """Triangles (n, 3, 3) with the least corner of each first, sorted; each keeps its winding."""
    turned = [min((tuple(map(tuple, np.roll(t, k, axis=0))) for k in range(3)), key=lambda t: t[0]) for t in corners]
    return np.array(sorted(turned))


def measured(path, *options, rays=16):
    """A mesh file as the command line reads and measures it. Vertices at one position are one."""
    with tempfile.TemporaryDirectory() as folder:
        output = Path(folder) / "measured.ply"
        run("thickness", path, "-o", output, "--rays", rays, *options)
        content = output.read_bytes()
    header, body = content.split(b"end_header\n", 1)
    counts = [int(line.split()[2]) for line in header.decode().splitlines() if line.startswith("element")]
    vertex = np.dtype([("at", "<f8", 3), ("mm", "<f4")])
    face = np.dtype([("count", "u1"), ("corners", "<u4", 3)])
    vertices = np.frombuffer(body, vertex, counts[0])
    faces = np.frombuffer(body, face, counts[1], counts[0] * vertex.itemsize)
    return Measured(vertices["at"].copy(), faces["corners"].astype(int), vertices["mm"].astype(float))
