"""Which way a head of a file looks, how large it is and where its ears are: studies/heads."""

from itertools import product

import matplotlib.pyplot as plt
import numpy as np
import pytest
import trimesh
from made_head import head

from studies.heads import preview
from studies.heads.any_head import place_head
from studies.heads.human_head import HeadError
from studies.heads.orientation import AXES, Orientation, guess, normalized
from studies.heads.samples import sample
from studies.paths import SCAN

ALL_WAYS = [Orientation(up, facing) for up, facing in product(AXES, AXES) if up[1] != facing[1]]


def as_file(vertices, way):
    """The vertices in the axes of a file that has it that way."""
    return vertices @ way.rotation()


def test_a_head_is_seen_for_what_it_is_any_way_it_lies():
    vertices, triangles = head()
    samples = sample(vertices, triangles, 20_000)
    for way in ALL_WAYS:
        found = guess(samples.turned(way.rotation().T))
        assert found.orientation == way
        assert found.is_sure


@pytest.mark.parametrize("axis", [0, 1])
def test_what_is_no_whole_head_is_told_to_be_a_guess(axis):
    """A face without the back of the head, and a head without its left side."""
    vertices, triangles = head()
    kept = triangles[(vertices[triangles, axis] < 0.03).all(axis=1)]
    placed = place_head(vertices, kept, "scan.ply", unit_mm=1000.0 if axis else None)
    assert any("could stand another way too" in sentence for sentence in placed.said)
    if axis == 1:
        assert placed.orientation.facing == "-Y"


def test_what_is_given_is_kept_and_the_rest_guessed():
    vertices, triangles = head()
    placed = place_head(as_file(vertices, Orientation("-X", "+Z")), triangles, "scan.ply", up="-x")
    assert placed.orientation == Orientation("-X", "+Z")
    both = place_head(vertices, triangles, "scan.ply", up="y", facing="x")
    assert both.orientation == Orientation("+Y", "+X")


def test_a_gltf_file_is_taken_as_its_standard_says_and_doubts_are_told():
    vertices, triangles = head()
    right = place_head(as_file(vertices, Orientation("+Y", "+Z")), triangles, "head.glb")
    assert right.orientation == Orientation("+Y", "+Z")
    assert not any("looks as if" in sentence for sentence in right.said)
    wrong = place_head(vertices, triangles, "head.glb")
    assert wrong.orientation == Orientation("+Y", "+Z")
    assert any("add --up=+Z --facing=-Y" in sentence for sentence in wrong.said)


def test_ears_are_found_and_missing_ones_told():
    both = place_head(*head(), "head.ply")
    assert {ear.side for ear in both.ears} == {1.0, -1.0}
    for ear in both.ears:
        assert ear.center == pytest.approx([0.088 * ear.side, 0.01, 0.045], abs=0.012)
    one = place_head(*head(ears=["right"]), "head.ply", up="z", facing="-y")
    assert [ear.side for ear in one.ears] == [-1.0]
    assert any("only the right ear" in sentence for sentence in one.said)
    none = place_head(*head(ears=[]), "head.ply")
    assert none.ears == []
    assert any("no ear was found" in sentence and "--ear" in sentence for sentence in none.said)


def test_an_ear_that_is_given_is_taken():
    vertices, triangles = head(ears=[])
    way = Orientation("+Y", "+Z")
    placed = place_head(1000.0 * as_file(vertices, way), triangles, "head.obj", ear=(-80.0, 45.0, -10.0))
    assert placed.ears[0].center == pytest.approx([-0.080, 0.010, 0.045])
    assert placed.ears[0].side == -1.0


@pytest.mark.parametrize(("scale", "unit"), [(1.0, 1000.0), (1000.0, 1.0), (100.0, 10.0), (10.0, 100.0)])
def test_the_unit_is_the_one_that_makes_it_a_head(scale, unit):
    vertices, triangles = head()
    assert place_head(scale * vertices, triangles, "head.ply").unit_mm == unit


@pytest.mark.parametrize(("scale", "size"), [(1000.0, "152 m wide"), (0.01, "1.52 mm wide")])
def test_a_head_of_another_size_is_told_with_the_remedy(scale, size):
    vertices, triangles = head()
    with pytest.raises(HeadError, match=r"--unit 1000 the head would be .* wide.*give --unit ") as raised:
        place_head(scale * vertices, triangles, "head.ply", unit_mm=1000.0)
    number = float(str(raised.value).split("the head would be ")[1].split()[0])
    assert number == pytest.approx(float(size.split()[0]), rel=0.15)
    assert size.split()[1] in str(raised.value)


def test_options_that_cannot_be_are_told():
    vertices, triangles = head()
    for options in ({"up": "w"}, {"up": "y", "facing": "-Y"}, {"unit_mm": -1.0}, {"unit_mm": float("nan")}):
        with pytest.raises(HeadError, match="--"):
            place_head(vertices, triangles, "head.ply", **options)
    with pytest.raises(HeadError, match="no surface"):
        place_head(np.zeros((3, 3)), np.array([[0, 1, 2]]), "head.ply")
    assert normalized(" -z ") == "-Z"


def test_the_preview_shows_the_head_and_marks_its_ears(tmp_path):
    preview.draw(place_head(*head(), "head.ply"), tmp_path / "preview.png")
    image = plt.imread(tmp_path / "preview.png")
    height, width, _ = image.shape
    assert width == 2 * height
    marks = np.isclose(image[:, :, :3], preview.MARK / 255.0, atol=0.01).all(axis=2)
    for half in (marks[:, : width // 2], marks[:, width // 2 :]):
        assert half.sum() > 20


def test_the_scan_is_found_however_it_is_turned():
    if not SCAN.is_file():
        pytest.skip("no ../shared/data/heads: the scan is not turned")
    scan = trimesh.load(SCAN, force="mesh", process=False)
    samples = sample(np.array(scan.vertices), np.array(scan.faces), 20_000)
    upright = samples.turned(Orientation("+Y", "+Z").rotation())
    for way in ALL_WAYS[::3]:
        assert guess(upright.turned(way.rotation().T)).orientation == way
    assert len(place_head(np.array(scan.vertices), np.array(scan.faces), "scan.obj").ears) == 2
