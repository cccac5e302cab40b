"""Tiles of meshes that are mirrored, decimated, huge or broken, and what is refused."""

import numpy as np
import pytest
import skinglow as sg
from shape_bodies import ball
from tile_reading import Mesh, grid, of_triangles, targets_of

BALL = of_triangles(*ball(10.0, 3))
QUADS = grid(12.0, 8.0, 5, 4)


def test_faces_with_a_wanted_corner_have_tiles_and_no_others() -> None:
    wanted = BALL.vertices[:, 2] > 6.0
    layout = sg.FaceTiles(*BALL, wanted)
    tiled = wanted[BALL.triangles].any(1)
    texels = layout.texels.reshape(-1, 3, 3)
    assert ((texels[:, :, 2] > 0) == tiled[:, None]).all()
    assert (texels[~tiled] == 0.0).all()
    assert set(np.unique(texels[tiled][:, :, 2])) == set(range(1, layout.tiles + 1))
    targets = targets_of(BALL, layout)
    assert (targets.points[:, 2] > 2.0).all()
    assert targets.mixed == 0.0
    none = sg.FaceTiles(*BALL, np.zeros(len(wanted)))
    assert (none.height, none.tiles, none.texels.any()) == (0, 0, False)
    assert targets_of(BALL, none).of_texel.shape == (0, 1024)


def test_the_rule_of_the_spacing() -> None:
    layout = sg.FaceTiles(*grid(12.0, 8.0, 5, 4), spacing_mm=0.65)
    a, b, c, d = layout.texels[:4, :2]
    assert np.allclose([b - a, c - b, c - d], [[4 - 2e-3, 0], [0, 3 - 2e-3], [4 - 2e-3, 0]], atol=1e-5)
    # The same in meters.
    meters = sg.FaceTiles(QUADS.vertices * 1e-3, *QUADS[1:], unit_mm=1000.0, spacing_mm=0.65)
    assert np.array_equal(meters.texels, layout.texels)
    assert layout.spacing_mm == 0.65
    assert layout.width == sg.FaceTiles.WIDTH == 1024


def test_max_texels_makes_the_spacing_grow_and_refuses_what_cannot_fit() -> None:
    large = grid(600.0, 400.0, 3, 2)
    free = sg.FaceTiles(*large)
    assert free.spacing_mm == 0.8
    bound = sg.FaceTiles(*large, max_texels=100 * 1024)
    assert bound.height <= 100 and bound.spacing_mm > 1.5
    steps = bound.texels[1, 0] - bound.texels[0, 0], 200.0 / bound.spacing_mm
    assert steps[0] == pytest.approx(np.round(steps[1]), abs=0.01)
    with pytest.raises(ValueError, match=r"max_texels is 2048; allowed: \d+ or more for 2000 tiles"):
        sg.FaceTiles(np.random.default_rng(1).normal(size=(6000, 3)), [3] * 2000, np.arange(6000), max_texels=2048)


def test_mirrored_and_repeated_faces_overlap() -> None:
    texels = sg.FaceTiles(*QUADS).texels[QUADS.fans]
    height = sg.FaceTiles(*QUADS).height
    both = np.concatenate([QUADS.vertices, QUADS.vertices * [-1.0, 1.0, 1.0] - [1.0, 0.0, 0.0]])
    triangles = np.concatenate([QUADS.triangles, QUADS.triangles[:, ::-1] + len(QUADS.vertices)])
    mirrored = sg.TileTargets(both, triangles, np.concatenate([texels, texels[:, ::-1]]), height)
    assert mirrored.overlapping == 1.0 and mirrored.mixed == 0.0
    half = len(texels) // 2
    partly = sg.TileTargets(
        both,
        np.concatenate([triangles[: len(texels)], triangles[len(texels) :][:half]]),
        np.concatenate([texels, texels[:half, ::-1]]),
        height,
    )
    assert partly.overlapping == pytest.approx(2 / 3)
    # The same faces twice at one place show the same light.
    assert (
        sg.TileTargets(both, np.tile(triangles[: len(texels)], (2, 1)), np.tile(texels, (2, 1, 1)), height).overlapping
        == 0
    )


def test_triangles_that_span_tiles_are_mixed() -> None:
    layout = sg.FaceTiles(*QUADS)
    texels = layout.texels[QUADS.fans].copy()
    assert sg.TileTargets(QUADS.vertices, QUADS.triangles, texels, layout.height).mixed == 0.0
    texels[::4, 1] = layout.texels[-1]  # a corner that a neighbor left, of every fourth triangle
    found = sg.TileTargets(QUADS.vertices, QUADS.triangles, texels, layout.height)
    assert found.mixed == pytest.approx(0.25, abs=0.03)
    texels[::4, 1] = 0.0
    assert sg.TileTargets(QUADS.vertices, QUADS.triangles, texels, layout.height).mixed == pytest.approx(0.25)


@pytest.mark.parametrize(
    "mesh",
    [
        Mesh(np.zeros((0, 3)), np.zeros(0, int), np.zeros(0, int)),
        Mesh(np.zeros((4, 3)), np.array([4]), np.arange(4)),  # at one place
        Mesh(np.array([(0, 0, 0), (1, 0, 0), (2, 0, 0)], float), np.array([3]), np.arange(3)),  # on a line
        Mesh(np.array([(0, 0, 0), (1, 0, 0), (1, 1, 0)], float), np.array([5]), np.array([0, 1, 1, 2, 2])),
        Mesh(np.array([(0, 0, 0), (1, 0, 0), (0, 1, 0)], float), np.array([3, 3, 3]), np.array([0, 1, 2] * 3)),
        Mesh(1e300 * BALL.vertices, BALL.sizes, BALL.corners),
        Mesh(1e-300 * BALL.vertices, BALL.sizes, BALL.corners),
        Mesh(BALL.vertices + 1e9, BALL.sizes, BALL.corners),
    ],
    ids=["empty", "point", "line", "repeated corners", "tripled", "huge", "tiny", "far"],
)
def test_broken_meshes_get_finite_numbers(mesh: Mesh) -> None:
    layout = sg.FaceTiles(*mesh)
    assert np.isfinite(layout.texels).all()
    targets = sg.TileTargets(mesh.vertices, mesh.triangles, layout.texels[mesh.fans], layout.height)
    for array in (targets.points, targets.normals, targets.spread(targets.normals)):
        assert np.isfinite(array).all()
    for number in (targets.mixed, targets.overlapping, targets.spacing_mm):
        assert np.isfinite(number)
    if len(mesh.vertices):
        low, high = mesh.vertices.min(0), mesh.vertices.max(0)
        reach = 0.1 * (high - low).max() + 1.5 * layout.spacing_mm + 1e-12 * np.abs(high).max()
        assert (targets.points >= low - reach).all() and (targets.points <= high + reach).all()


def test_a_fine_scan_keeps_its_texels_bounded() -> None:
    mesh = of_triangles(*ball(30.0, 7))  # 131,072 triangles
    layout = sg.FaceTiles(*mesh)
    targets = targets_of(mesh, layout)
    area = 4 * np.pi * 30.0**2
    assert len(targets.points) < 5 * area
    assert (targets.of_texel >= 0).sum() < 8 * area
    assert layout.tiles < len(mesh.sizes) / 5
    assert targets.overlapping == 0.0


def test_values_at_targets() -> None:
    layout = sg.FaceTiles(*BALL)
    targets = targets_of(BALL, layout)
    assert np.allclose(targets.at_vertices(BALL.vertices - 20.0), targets.points - 20.0, atol=1e-9)
    thickness = np.where(BALL.vertices[:, 0] > 0, 5.0, 0.0)
    at = targets.at_vertices(thickness)
    assert at.shape == (len(targets.points),) and at.min() == 0.0 and at.max() > 4.9
    assert targets.at_vertices(-thickness).min() < -4.9


def test_spread_writes_into_an_image() -> None:
    layout = sg.FaceTiles(*BALL)
    targets = targets_of(BALL, layout)
    image = np.full((layout.height, 1024, 4), 7.0, np.float32)
    assert targets.spread(targets.points, image) is not None
    assert (image[:, :, 3] == 7.0).all()
    has = targets.of_texel >= 0
    assert np.array_equal(image[has][:, :3], targets.points[targets.of_texel[has]].astype(np.float32))
    assert not image[~has][:, :3].any()
    assert np.array_equal(targets.spread(targets.points), image[:, :, :3])
    assert targets.spread(targets.points[:, 0]).shape == (layout.height, 1024, 1)


NAN_VERTEX = np.where(np.arange(12).reshape(4, 3) == 7, np.nan, 1.0)


@pytest.mark.parametrize(
    ("arguments", "options", "words"),
    [
        ((NAN_VERTEX, [4], [0, 1, 2, 3]), {}, r"vertices\[2\] is \(1, nan, 1\)"),
        ((np.ones((4, 3)), [2, 2], [0, 1, 2, 3]), {}, r"face_sizes\[0\] is 2; allowed: 3 or more"),
        ((np.ones((4, 3)), [3], [0, 1, 2, 3]), {}, "corners is 4 entries; allowed: 3, the sum of face_sizes"),
        ((np.ones((4, 3)), [4], [0, 1, 2, 4]), {}, r"corners\[3\] is 4; allowed: below the number of vertices"),
        ((np.ones((4, 3)), [4], [0, 1, 2, -1]), {}, r"corners\[3\] is -1"),
        ((np.ones((4, 3)), [4.0], [0, 1, 2, 3]), {}, "face_sizes is of shape .* type float64"),
        ((np.ones((4, 3)), [4], [0, 1, 2, 3], [True]), {}, "wanted is 1 entries; allowed: 4"),
        ((np.ones((4, 3)), [4], [0, 1, 2, 3]), {"spacing_mm": 0.0}, "spacing_mm is 0"),
        ((np.ones((4, 3)), [4], [0, 1, 2, 3]), {"spacing_mm": np.nan}, "spacing_mm is nan"),
        ((np.ones((4, 3)), [4], [0, 1, 2, 3]), {"unit_mm": -1.0}, "unit_mm is -1"),
        ((np.ones((4, 3)), [4], [0, 1, 2, 3]), {"max_texels": 1000}, "max_texels is 1000; allowed: 1024 to 16777216"),
    ],
)
def test_refused_layouts(arguments: tuple, options: dict, words: str) -> None:
    with pytest.raises(ValueError, match=words):
        sg.FaceTiles(*arguments, **options)


def test_refused_targets() -> None:
    layout = sg.FaceTiles(*BALL)
    texels = layout.texels[BALL.fans]
    arguments = BALL.vertices, BALL.triangles
    for bad, words in (
        (np.where(texels == texels[3, 1, 0], np.nan, texels), r"texels\[\d+\] is \(nan"),
        (texels + np.float32([1024, 0, 0]), r"texels\[0\] is .*image of 1024 x"),
        (texels * np.float32([1, 1, -1]), r"texels\[0\]"),
        (texels[1:], "texels is 1533 corners; allowed: 1536"),
        (texels[0], r"texels is of shape \(3, 3\); allowed: shape \(m, 3, 3\)"),
    ):
        with pytest.raises(ValueError, match=words):
            sg.TileTargets(*arguments, bad, layout.height)
    with pytest.raises(ValueError, match="height is 70000"):
        sg.TileTargets(*arguments, texels, 70000)
    with pytest.raises(ValueError, match=r"texels\[\d+\]"):  # of a layout that was higher
        sg.TileTargets(*arguments, texels, layout.height - 4)
    targets = sg.TileTargets(*arguments, texels, layout.height)
    image = np.zeros((layout.height, 1024, 3), np.float32)
    for values, out, words in (
        (np.full((len(targets.points), 3), np.nan), None, r"values\[0\] is nan"),
        (np.full((len(targets.points), 3), 1e39), None, r"values\[0\] is 1e\+39"),
        (np.zeros((4, 3)), None, "values is 12 entries"),
        (targets.points, image.astype(float), "float32"),
        (targets.points, image[:, ::2], "float32"),
        (targets.points, image[1:].copy(), "out is of shape"),
        (targets.points, image[:, :, :2].copy(), "channels is 2"),
    ):
        with pytest.raises(ValueError, match=words):
            targets.spread(values, out)
    with pytest.raises(ValueError, match=r"values is 12 entries"):
        targets.at_vertices(np.zeros((4, 3)))


def test_table_at_is_what_an_image_of_the_table_shows() -> None:
    base = sg.base_lut(sg.Tissue(), 64, 8.0)
    colors = sg.recolor(base, [1.0, 0.8, 0.5])
    thickness = np.linspace(-1.0, 12.0, 400)
    found = sg.table_at(colors, base.texel_mapping, thickness)
    expected = [np.interp(thickness, base.thickness_mm, colors[:, k]) for k in range(3)]
    assert np.allclose(found, np.stack(expected, 1), rtol=1e-12)
    assert np.array_equal(sg.table_at(colors[:1], (0.1, 0.5), thickness), np.repeat(colors[:1], 400, 0))
    assert np.isfinite(sg.table_at(colors, (1e300, 1e300), [1e300, -1e300])).all()
    for arguments, words in (
        ((colors, base.texel_mapping, [np.nan]), r"thickness_mm\[0\] is nan"),
        ((np.zeros((0, 3)), base.texel_mapping, [1.0]), "number of colors is 0"),
        ((colors * np.inf, base.texel_mapping, [1.0]), r"colors\[0\]"),
        ((colors, (np.nan, 0.0), [1.0]), "texel scale is nan"),
    ):
        with pytest.raises(ValueError, match=words):
            sg.table_at(*arguments)
