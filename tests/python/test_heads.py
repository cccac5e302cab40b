"""Which way a head of a file looks, how large it is and where its ears are: studies/heads."""

from itertools import product

import matplotlib.pyplot as plt
import numpy as np
import pytest
import trimesh
from made_head import ball, body, head, joined

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


@pytest.mark.parametrize("degrees", [-20.0, 20.0])
def test_a_head_that_nods_is_no_head_that_looks_back(degrees):
    """Two heads were turned round or over, for sure: the ears tell front from back."""
    vertices, triangles = head()
    nod = trimesh.transformations.rotation_matrix(np.radians(degrees), (1, 0, 0))[:3, :3]
    found = guess(sample(vertices @ nod.T, triangles))
    assert found.orientation == Orientation("+Z", "-Y")
    assert found.is_sure


def test_what_has_no_ears_where_a_head_has_them_is_never_sure():
    """Suzanne, whose ears stand out by half of her head, was turned over for sure."""
    vertices, triangles = head(ears=[])
    parts = [(vertices, triangles)] + [ball((0.12 * side, 0.01, 0.045), (0.06, 0.01, 0.03)) for side in (1.0, -1.0)]
    for shape in ((vertices, triangles), joined(parts)):
        assert not guess(sample(*shape)).is_sure


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


@pytest.mark.parametrize("radius", [0.004, 0.012])
def test_holes_of_a_scan_are_no_ears(radius):
    """What a hole left of the side of the head was taken for an ear of 10 to 13 cm, or there was none."""
    vertices, triangles = head(detail=96)
    middles = vertices[triangles].mean(axis=1)
    for side, y, z in product((-0.07, 0.07), (-0.03, 0.045), (0.06, 0.1)):
        beside = np.linalg.norm(middles[:, 1:] - (y, z), axis=1) < radius
        kept = ~(beside & (np.sign(middles[:, 0]) == np.sign(side)))
        triangles, middles = triangles[kept], middles[kept]
    placed = place_head(vertices, triangles, "head.ply", up="z", facing="-y")
    assert {ear.side for ear in placed.ears} == {1.0, -1.0}
    for ear in placed.ears:
        assert ear.center == pytest.approx([0.088 * ear.side, 0.01, 0.045], abs=0.012)
        assert ear.size == pytest.approx(0.062, abs=0.012)


def test_a_bun_is_no_ear():
    vertices, triangles = head(ears=[])
    bun, corners = ball((0.06, 0.05, 0.06), (0.035, 0.05, 0.06))
    vertices, triangles = np.concatenate([vertices, bun]), np.concatenate([triangles, corners + len(vertices)])
    assert place_head(vertices, triangles, "head.ply", up="z", facing="-y").ears == []


@pytest.mark.parametrize("name", ["scan.ply", "scan.obj"])
def test_what_lies_about_a_head_is_left_out_and_told(name):
    """Ten specks beside a scan turned it over, for sure, and halved its size."""
    vertices, triangles = head()
    random = np.random.default_rng(3)
    specks = vertices.max(axis=0) + 0.3 + 0.01 * random.random((30, 3))
    corners = len(vertices) + np.arange(30).reshape(-1, 3)
    way = Orientation("+Y", "+Z")
    both = as_file(np.concatenate([vertices, specks]), way), np.concatenate([triangles, corners])
    placed = place_head(*both, name)
    assert placed.orientation == way
    assert placed.unit_mm == 1000.0
    assert len(placed.ears) == 2
    assert any("10 pieces lie away from the head" in sentence for sentence in placed.said)
    assert placed.away.tolist() == [False] * len(triangles) + [True] * 10


def test_a_soup_of_triangles_is_a_head():
    vertices, triangles = head()
    random = np.random.default_rng(3)
    apart = vertices[triangles].reshape(-1, 3) * (1.0 + 1e-4 * random.random((3 * len(triangles), 1)))
    placed = place_head(apart, np.arange(len(apart)).reshape(-1, 3), "scan.ply")
    assert placed.orientation == Orientation("+Z", "-Y")
    assert not placed.away.any()


@pytest.mark.parametrize(
    ("name", "way", "up"),
    [
        ("person.obj", Orientation("+Y", "+Z"), None),
        ("person.ply", Orientation("+Z", "-Y"), "z"),
        ("person.ply", Orientation("+Z", "-Y"), None),
        ("person.ply", Orientation("-X", "+Y"), None),
    ],
)
def test_of_a_whole_body_the_head_is_looked_at(name, way, up):
    """No ear was found, or it was turned over for sure."""
    vertices, triangles = body()
    placed = place_head(100.0 * as_file(vertices, way), triangles, name, up=up)
    assert placed.orientation == way
    assert placed.unit_mm == 10.0
    assert placed.size.width == pytest.approx(0.16, abs=0.015)
    assert {ear.side for ear in placed.ears} == {1.0, -1.0}
    for ear in placed.ears:
        assert ear.center == pytest.approx([0.088 * ear.side, 0.01, 0.045], abs=0.012)
    assert any("could stand another way too" in sentence for sentence in placed.said)


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
