"""Tiles of texels on the faces of a mesh: what a renderer reads is what the targets say."""

import numpy as np
import pytest
import skinglow as sg
from hypothesis import given, settings
from hypothesis import strategies as st
from shape_bodies import ball, lobe, plate
from tile_reading import Mesh, cells, grid, of_triangles, read, split_in_four, surface_points, targets_of

COEFFICIENTS = np.array([[0.3, -0.2], [0.1, 0.5], [-0.4, 0.25]])


def linear(points):
    return points @ COEFFICIENTS + [3.0, -1.0]


def polygon(sides: int, radius: float) -> Mesh:
    angle = np.arange(sides) * 2 * np.pi / sides
    return Mesh(
        np.stack([radius * np.cos(angle), radius * np.sin(angle), 0.3 * np.cos(angle)], 1),
        np.array([sides]),
        np.arange(sides),
    )


def mixed_faces() -> Mesh:
    """Triangles, quads and a concave pentagon side by side."""
    vertices = np.array(
        [(0, 0, 0), (4, 0, 0), (4, 3, 1), (0, 3, 1), (7, 1, 0), (2, 5, 2), (6, 6, 0), (4, 4, 0.5)], float
    )
    return Mesh(vertices, np.array([4, 3, 5]), np.array([0, 1, 2, 3, 1, 4, 2, 3, 2, 7, 6, 5]))


MESHES = {
    "triangle": of_triangles(np.array([(0, 0, 0), (5, 0, 0), (1, 3, 2)], float), np.array([[0, 1, 2]])),
    "ball": of_triangles(*ball(10.0, 3)),
    "lobe": of_triangles(*lobe(levels=3)),
    "plate": of_triangles(*plate(20.0, 3.0, 4)),
    "quads": grid(12.0, 5.0, 3, 4, bend=2.0),
    "one large quad": grid(300.0, 200.0, 1, 1),
    "faces": mixed_faces(),
    "polygon": polygon(32, 6.0),
    "dense": of_triangles(*ball(5.0, 5)),
    "sliver": of_triangles(np.array([(0, 0, 0), (90, 0, 0), (45, 0.01, 0)], float), np.array([[0, 1, 2]])),
}
#: Those with faces that share a tile without lying in one plane; also quads and polygons that are not flat.
BENT = {"ball", "lobe", "dense", "faces", "polygon", "quads"}


@pytest.mark.parametrize("name", MESHES)
@pytest.mark.parametrize("levels", [0, 2])
def test_every_texel_that_is_read_has_a_target_and_linear_functions_are_exact(name: str, levels: int) -> None:
    mesh = MESHES[name]
    layout = sg.FaceTiles(*mesh)
    shown = mesh.vertices, mesh.triangles, layout.texels[mesh.fans]
    for _ in range(levels):
        shown = split_in_four(*shown)
    targets = sg.TileTargets(*shown, layout.height)
    points = surface_points(*shown)
    (x, y), _ = (part.T for part in cells(points))
    for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
        assert (targets.of_texel[y + dy, x + dx] >= 0).all()
    error = read(targets.spread(linear(targets.points)), points) - linear(points.places)
    # The inset moves points by 1/1000 of a texel. Faces that share a tile meet in a bend, which four texels take for a
    # curve.
    slope = np.linalg.norm(COEFFICIENTS, axis=0).max() * max(layout.spacing_mm, targets.spacing_mm)
    assert np.abs(error).max() < slope * (0.3 if name in BENT else 8e-3)
    assert np.sqrt((error**2).mean()) < slope * (0.02 if name in BENT else 3e-3)
    assert targets.overlapping == targets.mixed == 0.0


@given(st.integers(0, 10**6), st.floats(-2.0, 1.0), st.sampled_from([1e-3, 1.0, 1000.0]))
@settings(max_examples=60, deadline=None)
def test_any_faces_can_be_read(seed: int, log_spacing: float, unit_mm: float) -> None:
    rng = np.random.default_rng(seed)
    count = int(rng.integers(4, 40))
    sizes = rng.integers(3, 7, int(rng.integers(1, 30)))
    sizes = np.minimum(sizes, count)
    corners = np.concatenate([rng.choice(count, n, replace=False) for n in sizes])
    vertices = np.round(rng.normal(size=(count, 3)) * 3, 1)  # some at one place
    mesh = Mesh(vertices / unit_mm, sizes, corners)
    layout = sg.FaceTiles(*mesh, rng.random(count) < 0.7, unit_mm=unit_mm, spacing_mm=10.0**log_spacing)
    texels = layout.texels[mesh.fans]
    targets = targets_of(mesh, layout, unit_mm=unit_mm)
    assert targets.of_texel.shape == (layout.height, sg.FaceTiles.WIDTH)
    assert np.isfinite(targets.points).all() and np.isfinite(targets.normals).all()
    length = np.linalg.norm(targets.normals, axis=1)
    assert ((length < 1e-12) | (abs(length - 1) < 1e-9)).all()
    assert targets.mixed == 0.0 and 0.0 <= targets.overlapping <= 1.0
    area = np.linalg.norm(
        np.cross(*(vertices[mesh.triangles[:, k]] - vertices[mesh.triangles[:, 0]] for k in (1, 2))), axis=1
    )
    if not (texels[area > 0][:, :, 2] > 0).any():
        return
    (x, y), _ = (part.T for part in cells(surface_points(vertices, mesh.triangles, texels, 2000)))
    for dx, dy in ((0, 0), (1, 0), (0, 1), (1, 1)):
        assert (targets.of_texel[y + dy, x + dx] >= 0).all()


def test_edges_and_corners_that_faces_share_have_one_target() -> None:
    mesh = grid(12.0, 8.0, 5, 4, bend=1.0)
    layout = sg.FaceTiles(*mesh, spacing_mm=0.65)
    targets = targets_of(mesh, layout)
    texels_a_face = (targets.of_texel >= 0).sum() / len(mesh.sizes)
    nx, ny = 4, 3  # 2.4 mm, along the bend up to a little more, and 2 mm
    assert texels_a_face == (nx + 1) * (ny + 1)
    assert len(targets.points) == (5 * nx + 1) * (4 * ny + 1)
    # Seams of texture coordinates and parts that were never merged split vertices.
    apart = Mesh(mesh.vertices[mesh.corners], mesh.sizes, np.arange(len(mesh.corners)))
    assert len(targets_of(apart, sg.FaceTiles(*apart, spacing_mm=0.65)).points) == len(targets.points)
    shown = mesh.vertices, mesh.triangles, layout.texels[mesh.fans]
    for _ in range(3):
        shown = split_in_four(*shown)
        finer = sg.TileTargets(*shown, layout.height)
        assert len(finer.points) == len(targets.points)


def test_targets_lie_on_the_surface_as_it_is_shown() -> None:
    mesh = of_triangles(*ball(10.0, 2))
    layout = sg.FaceTiles(*mesh)
    shown = mesh.vertices, mesh.triangles, layout.texels[mesh.fans]
    for _ in range(3):
        vertices, triangles, texels = split_in_four(*shown)
        shown = 10.0 * vertices / np.linalg.norm(vertices, axis=1, keepdims=True), triangles, texels
    targets = sg.TileTargets(*shown, layout.height)
    # Those beyond an edge continue a triangle.
    assert (np.percentile(abs(np.linalg.norm(targets.points, axis=1) - 10.0), [90, 100]) < [0.03, 0.2]).all()
    assert (np.einsum("kc,kc->k", targets.normals, targets.points) > 9.9).all()
    assert np.linalg.norm(sg.TileTargets(*shown, layout.height).points - targets.points, axis=1).max() == 0.0


def smooth(points):
    """Falls as light does in flesh, by e in 2 and 5 mm."""
    return np.exp((points[:, 2:] - 10.0) / [2.0, 5.0])


@pytest.mark.parametrize(("levels", "bound"), [(2, 0.02), (3, 0.02), (4, 0.02), (5, 0.02), (7, 0.03)])
def test_interpolation_of_a_smooth_function(levels: int, bound: float) -> None:
    """From faces of 4 mm to those of 0.12 mm, which share tiles."""
    mesh = of_triangles(*ball(10.0, levels))
    layout = sg.FaceTiles(*mesh)
    targets = targets_of(mesh, layout)
    points = surface_points(mesh.vertices, mesh.triangles, layout.texels[mesh.fans], 100000)
    exact = smooth(points.places)
    error = read(targets.spread(smooth(targets.points)), points) - exact
    assert (np.sqrt((error**2).mean(0)) < bound * exact.mean(0)).all()
    area = 4 * np.pi * 100
    assert (targets.of_texel >= 0).sum() < 15 * area
    assert 0.5 < targets.spacing_mm < 0.9
