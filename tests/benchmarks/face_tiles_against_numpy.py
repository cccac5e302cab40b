"""Tiles of 100,000 triangles: layout, targets and pixels, against numpy doing the plain half of it.

The alternative gives each triangle half a square of the same size, and finds the points that faces share by
np.unique. It knows nothing of other surfaces than the one it was laid out for, of quads, dense faces or overlaps.

Run: python tests/benchmarks/face_tiles_against_numpy.py     Prints medians, and ratios of one run, pair by pair.
"""

import statistics
import sys
import time
from pathlib import Path

import numpy as np
import skinglow as sg

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
from shape_bodies import ball  # noqa: E402

ROUNDS = 7
CELLS = 3
WIDTH = sg.FaceTiles.WIDTH


def numpy_layout(vertices, triangles):
    side = CELLS + 1
    per_row = WIDTH // side
    tile = np.arange(len(triangles))
    first = np.stack([tile % per_row, tile // per_row], 1) * side
    corners = np.array([(1e-3, 1e-3), (CELLS - 1e-3, 1e-3), (1e-3, CELLS - 1e-3)])
    texels = np.empty((len(triangles), 3, 3), np.float32)
    texels[:, :, :2] = first[:, None] + corners
    texels[:, :, 2] = tile[:, None] + 1
    return first, texels, (tile[-1] // per_row + 1) * side


def numpy_targets(vertices, triangles, first, height):
    i, j = (index.ravel() for index in np.meshgrid(np.arange(CELLS + 1), np.arange(CELLS + 1)))
    weights = np.stack([CELLS - i - j, i, j], 1) / CELLS
    points = np.einsum("wk,tkc->twc", weights, vertices[triangles]).reshape(-1, 3)
    unique, target = np.unique(np.round(points, 6), axis=0, return_inverse=True)
    of_texel = np.full((height, WIDTH), -1, np.int32)
    of_texel[first[:, 1, None] + j, first[:, 0, None] + i] = target.reshape(len(triangles), -1)
    return unique, of_texel


def numpy_spread(values, of_texel):
    pixels = np.zeros((*of_texel.shape, 3), np.float32)
    has = of_texel >= 0
    pixels[has] = values[of_texel[has]]
    return pixels


def main() -> None:
    vertices, triangles = ball(200.0, 7)  # 131,072 triangles with edges of 2.5 mm
    vertices, triangles = vertices, triangles[:100_000]
    times: dict[str, dict[str, list[float]]] = {"skinglow": {}, "numpy": {}}

    def timed(who, what, work):
        start = time.perf_counter()
        result = work()
        times[who].setdefault(what, []).append(time.perf_counter() - start)
        return result

    sizes, corners = np.full(len(triangles), 3), triangles.ravel()
    for _ in range(ROUNDS):  # in turn, so that a drift of the machine's speed meets all alike
        layout = timed("skinglow", "layout", lambda: sg.FaceTiles(vertices, sizes, corners, max_texels=1 << 22))
        texels = layout.texels.reshape(-1, 3, 3)
        targets = timed(
            "skinglow", "targets", lambda t=texels, h=layout.height: sg.TileTargets(vertices, triangles, t, h)
        )
        pixels = np.zeros((layout.height, WIDTH, 3), np.float32)
        timed("skinglow", "spread", lambda t=targets, p=pixels: t.spread(t.points, p))
        first, _, height = timed("numpy", "layout", lambda: numpy_layout(vertices, triangles))
        unique, of_texel = timed("numpy", "targets", lambda f=first, h=height: numpy_targets(vertices, triangles, f, h))
        timed("numpy", "spread", lambda u=unique, o=of_texel: numpy_spread(u, o))
    print(
        f"{len(triangles)} triangles; skinglow: {layout}, {len(targets.points)} targets; numpy: {len(unique)} targets"
    )
    for what in times["skinglow"]:
        ours, theirs = times["skinglow"][what], times["numpy"][what]
        ratio = statistics.median(b / a for a, b in zip(ours, theirs, strict=True))
        ms = [statistics.median(taken) * 1e3 for taken in (ours, theirs)]
        print(f"{what:8} {ms[0]:8.1f} ms   numpy {ms[1]:8.1f} ms   {ratio:5.2f} x")


if __name__ == "__main__":
    main()
