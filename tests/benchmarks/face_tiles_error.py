"""What interpolation in tiles loses of the light through an ear: ../shared/data/shape, docs/face_tiles.md.

Exitance is solved at the targets and, by the same shape, at random points of back-lit skin; there the image of the
targets is read as a renderer reads it. The rays of the last flight are other ones at each point, so that what is left
at a spacing of 0.3 mm is mostly their noise.

Run: python tests/benchmarks/face_tiles_error.py [lps-a mh-a ...]     Some minutes.
"""

import sys
from pathlib import Path

import numpy as np
import skinglow as sg

sys.path.insert(0, str(Path(__file__).parents[1] / "python"))
from tile_reading import Points, read  # noqa: E402

DATA = Path(__file__).resolve().parents[3] / "shared" / "data" / "shape"
SAMPLES = 4000


def normals_of(vertices, triangles):
    """Area vectors of the triangles, twice their area long, and unit normals of the vertices."""
    corners = vertices[triangles]
    of_triangles = np.cross(corners[:, 1] - corners[:, 0], corners[:, 2] - corners[:, 0])
    normals = np.zeros_like(vertices)
    for k in range(3):
        np.add.at(normals, triangles[:, k], of_triangles)
    return of_triangles, normals / (np.linalg.norm(normals, axis=1, keepdims=True) + 1e-30)


def measure(name: str, spacing_mm: float) -> None:
    truth, mesh = np.load(DATA / f"{name}.npz"), np.load(DATA / f"{name.split('-')[0]}_mesh.npz")
    vertices, triangles = mesh["vertices_mm"].astype(float), mesh["triangles"].astype(np.int64)
    wanted, back_lit = np.zeros((2, len(vertices)), bool)
    wanted[truth["vertex"]] = True
    back_lit[truth["vertex"][truth["back_lit"]]] = True
    layout = sg.FaceTiles(vertices, np.full(len(triangles), 3), triangles.ravel(), wanted, spacing_mm=spacing_mm)
    texels = layout.texels.reshape(-1, 3, 3)
    targets = sg.TileTargets(vertices, triangles, texels, layout.height)
    of_triangles, normals = normals_of(vertices, triangles)
    area = np.linalg.norm(of_triangles, axis=1) / 2
    rng = np.random.default_rng(0)
    own = np.flatnonzero(back_lit[triangles].all(1))
    chosen = rng.choice(own, SAMPLES, p=area[own] / area[own].sum())
    weights = rng.dirichlet(np.ones(3), SAMPLES)
    places = np.einsum("nk,nkc->nc", weights, vertices[triangles[chosen]])
    at = Points(places, np.einsum("nk,nkc->nc", weights.astype(np.float32), texels[chosen]))
    shape = sg.Shape(
        vertices,
        triangles,
        absorption=(0.032, 0.17, 0.48),
        reduced_scattering=(0.74, 0.88, 1.01),
        refractive_index=1.0,
        points=np.concatenate([targets.points, places]),
        normals=np.concatenate([targets.normals, np.einsum("nk,nkc->nc", weights, normals[triangles[chosen]])]),
    )
    exitance = shape.exitance(truth["irradiance"].astype(float))
    exact = exitance[len(targets.points) :]
    error = read(targets.spread(exitance[: len(targets.points)]), at) - exact
    rms = 100 * np.append(np.sqrt((error**2).mean(0)) / exact.mean(0), np.sqrt((error**2).mean()) / exact.mean())
    tiled = area[(texels[:, :, 2] > 0).all(1)].sum()
    print(
        f"{name} spacing {spacing_mm}: {layout.tiles} tiles, {(targets.of_texel >= 0).sum() / tiled:.1f} texels and "
        f"{len(targets.points) / tiled:.1f} targets a mm2 ({len(targets.points)}); R G B all "
        + " ".join(f"{value:.1f}" for value in rms)
        + " %",
        flush=True,
    )


if __name__ == "__main__":
    for head in sys.argv[1:] or ("lps-a", "mh-a"):
        for spacing in (0.3, 0.6, 0.8, 1.2):
            measure(head, spacing)
