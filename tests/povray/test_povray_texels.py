"""Light at points of a surface as texels of an image, rendered by the real POV-Ray."""

import numpy as np
import pytest
import skinglow as sg
from povray_runs import render, write, write_exr

SQUARE = np.array([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], float)
TRIANGLES = np.array([(0, 1, 2), (0, 2, 3)])
FROM_ABOVE = np.diag([1.0, 1.0, 1.0, 1.0])
FROM_ABOVE[2, 3] = 5
SIZE = 32


def files(**changes) -> dict[str, str]:
    settings = dict(camera_matrix=FROM_ABOVE, resolution=(SIZE, SIZE), ortho_width=2, size=2, max_thickness_mm=1.0)
    return sg.povray_files(SQUARE, TRIANGLES, **settings | changes)


def test_bilinear_between_the_centers_of_texels(tmp_path) -> None:
    """A square of 3 x 2 texels in an image of 8 x 4, second and third row from below: mirrored it would show."""
    image = np.random.default_rng(1).random((4, 8, 3)).astype(np.float16).astype(np.float32)
    corners = np.array([(2, 1), (4, 1), (4, 2), (2, 2)], float)
    uv = (corners[TRIANGLES] + 0.5) / (8, 4)
    write(tmp_path, files(glow_uv=uv, image="tiles.exr", mode="physical"))
    write_exr(tmp_path / "tiles.exr", image)
    shown = render(tmp_path, "-A")
    across = 2 * (np.arange(SIZE) + 0.5) / SIZE
    up = (np.arange(SIZE)[::-1] + 0.5) / SIZE
    rows = image[::-1][1:3, 2:5].astype(float)  # rows from below
    lower, upper = (np.stack([np.interp(across, np.arange(3), c) for c in row.T], axis=1) for row in rows)
    expected = lower[None] + (upper - lower)[None] * up[:, None, None]
    np.testing.assert_allclose(shown, expected, atol=1e-3)


def test_one_of_lookup_and_texels() -> None:
    uv = np.zeros((2, 3, 2))
    for arguments in ({}, {"glow_uv": uv, "lut_u": np.zeros(4)}):
        with pytest.raises(ValueError, match="lut_u and glow_uv"):
            files(image="tiles.exr", **arguments)
    with pytest.raises(ValueError, match="glow_uv"):
        files(image="tiles.exr", glow_uv=uv[:1])
