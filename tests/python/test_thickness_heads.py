"""skinglow.thickness on real heads, where they are at hand (../shared from the project's root)."""

from pathlib import Path

import numpy as np
import pytest
from mesh_files import measured
from skinglow._thickness import thickness

HEADS = Path(__file__).resolve().parents[3] / "shared" / "data" / "heads"


def at_hand(name):
    path = HEADS / name
    if not path.exists():
        reason = f"no ../shared/data/heads/{name}: thickness is not tested on this head"
        print(reason)
        pytest.skip(reason)  # -ra among pytest's options lists the reason at the end
    return path


@pytest.fixture(scope="module")
def makehuman():
    """(vertices in mm, triangles) of the group "body"; closed, symmetric, with mouth and sockets."""
    body = measured(at_hand("makehuman_base.obj"), "--group", "body", rays=1)
    return body.positions * 100.0, body.triangles


@pytest.fixture(scope="module")
def lee_perry_smith():
    """(vertices in mm, triangles) of the scan; open at the neck."""
    head = measured(at_hand("LeePerrySmith.glb"), rays=1)
    return head.positions * 50.35, head.triangles


def foremost(mm, region):
    """Of the vertices in a region, those within 1 mm of the foremost one (+z) in their 4 mm cell."""
    cells = np.round(mm[:, :2] / 4.0).astype(int)
    _, cell = np.unique(cells, axis=0, return_inverse=True)
    cell = cell.ravel()
    front = np.full(cell.max() + 1, -np.inf)
    np.maximum.at(front, cell[region], mm[region, 2])
    return region & (mm[:, 2] > front[cell] - 1.0)


# Where the ears are, where eyes, nose and mouth are, where the crown is; mm in each mesh's own frame.
@pytest.mark.parametrize(
    ("head", "ear_x", "ear_y", "face_y", "crown_y"),
    [
        ("makehuman", 78.0, (690, 740), (640, 745), 820),
        ("lee_perry_smith", 76.0, (35, 95), (0, 100), 150),
    ],
)
def test_ears_are_thin_and_the_skull_and_the_face_are_not(request, head, ear_x, ear_y, face_y, crown_y):
    mm, triangles = request.getfixturevalue(head)
    result = thickness(mm, triangles, min_sky_visibility=0.1)
    assert np.isfinite(result).all()

    ear = (np.abs(mm[:, 0]) > ear_x) & (mm[:, 1] > ear_y[0]) & (mm[:, 1] < ear_y[1])
    assert ear.sum() > 50
    assert 2.0 < np.percentile(result[ear], 25) < 8.0

    crown = mm[:, 1] > crown_y
    assert crown.sum() > 10
    assert result[crown].min() > 60.0

    # Lips and lids lie over dark cavities: no light comes through them from behind.
    skin = foremost(mm, (np.abs(mm[:, 0]) < 50) & (mm[:, 1] > face_y[0]) & (mm[:, 1] < face_y[1]))
    any_way_out = thickness(mm, triangles)
    assert np.mean(any_way_out[skin] < 10.0) > 0.1
    assert np.mean(result[skin] < 10.0) < 0.05


def test_vertices_split_at_every_triangle_have_one_value(lee_perry_smith):
    mm, triangles = lee_perry_smith
    corners = mm[triangles].reshape(-1, 3)
    result = thickness(corners, np.arange(len(corners)).reshape(-1, 3))
    index = triangles.ravel()
    low, high = np.full(len(mm), np.inf), np.full(len(mm), -np.inf)
    np.minimum.at(low, index, result)
    np.maximum.at(high, index, result)
    np.testing.assert_array_equal(low, high)


def test_both_ears_of_a_symmetric_head_agree(makehuman):
    mm, triangles = makehuman
    result = thickness(mm, triangles, min_sky_visibility=0.1)
    ear = np.flatnonzero((np.abs(mm[:, 0]) > 70) & (mm[:, 1] > 680))
    twin = [np.argmin(np.linalg.norm(mm - mm[i] * (-1, 1, 1), axis=1)) for i in ear]
    assert np.linalg.norm(mm[ear] * (-1, 1, 1) - mm[twin], axis=1).max() < 0.1
    # The cone's spiral is not mirrored, so single rays differ; the answer must not, where it is thin.
    thin = result[ear] < 12.0
    ratio = (result[ear] / result[twin])[thin]
    assert np.percentile(np.abs(np.log(ratio)), 90) < np.log(1.15)
