"""Calls that take long let other Python threads run."""

from __future__ import annotations

import threading
import time
from collections.abc import Callable

import numpy as np
import pytest
import skinglow as sg


def grid(count: int) -> tuple[np.ndarray, np.ndarray]:
    """A wavy sheet of count * count vertices."""
    x, y = np.meshgrid(np.linspace(0, 1, count), np.linspace(0, 1, count), indexing="ij")
    vertices = np.stack([x, y, 0.02 * np.sin(40 * x) * np.cos(30 * y)], axis=-1).reshape(-1, 3)
    a = (np.arange(count - 1)[:, None] * count + np.arange(count - 1)).ravel()
    return vertices, np.concatenate(
        [np.stack([a, a + count, a + 1], 1), np.stack([a + 1, a + count, a + count + 1], 1)]
    )


def thickness_of(mesh: tuple[np.ndarray, np.ndarray]) -> Callable[[], object]:
    return lambda: sg.thickness(*mesh, rays=256, threads=1)


def visibility_of(mesh: tuple[np.ndarray, np.ndarray]) -> Callable[[], object]:
    occluders = sg.Occluders([mesh])
    light = sg.Light("POINT", (1, 1, 1), (0.5, 0.5, 1), power=1, radius=0.5)
    points = mesh[0] - (0, 0, 0.1)
    normals = np.tile([0.0, 0, 1], (len(points), 1))
    return lambda: occluders.visible_fraction([light], points, normals, samples=64, threads=1)


def povray_of(mesh: tuple[np.ndarray, np.ndarray]) -> Callable[[], object]:
    u = np.zeros(len(mesh[0]))
    return lambda: sg.povray_files(
        *mesh, u, camera_matrix=np.eye(4), resolution=(8, 8), angle_x=0.7, base=sg.BaseLut([1.0, 0.5], 12.0)
    )


@pytest.mark.parametrize(
    ("prepare", "count"),
    [(thickness_of, 60), (visibility_of, 120), (povray_of, 400)],
    ids=lambda p: getattr(p, "__name__", p),
)
def test_other_threads_run_meanwhile(prepare: Callable, count: int) -> None:
    call = prepare(grid(count))
    call()
    ticks: list[float] = []
    running = True

    def tick() -> None:
        while running:
            ticks.append(time.perf_counter())
            time.sleep(0.001)

    other = threading.Thread(target=tick)
    other.start()
    try:
        # Ticks about the ends prove nothing: the interpreter may switch just before and after the call.
        for _ in range(20):
            start = time.perf_counter()
            call()
            took = time.perf_counter() - start
            if any(start + 0.3 * took < t < start + 0.7 * took for t in ticks):
                return
    finally:
        running = False
        other.join()
    pytest.fail(f"no other thread ran within calls of {took * 1e3:.0f} ms")
