"""A head of a file in Blender, as the demo loads it: upright, in meters, facing front, however the file has it."""

import json
import subprocess
from pathlib import Path

import matplotlib.pyplot as plt
import numpy as np
import pytest
import trimesh
from hosts import host_named

from studies.heads import human_head
from studies.heads.orientation import Orientation
from tests.python.made_head import ball, head

#: File, how it has the head, and units per meter.
FILES = {
    "turned.ply": (Orientation("-X", "+Y"), 1000.0),
    "y_up.obj": (Orientation("+Y", "+Z"), 100.0),
    "z_up.obj": (Orientation("+Z", "-Y"), 1.0),
    "printed.stl": (Orientation("+Z", "-Y"), 1000.0),
    "standard.glb": (Orientation("+Y", "+Z"), 1.0),
}
#: Of several pieces: two eyeballs of one mesh, which stand where their nodes say; and specks beside the head.
SEVERAL = ("several.glb", "specks.ply")
#: Made by Blender: on bones, with a shape key.
RIGGED = "rigged.glb"


@pytest.fixture(scope="module")
def found(tmp_path_factory):
    folder = tmp_path_factory.mktemp("heads")
    vertices, triangles = head(detail=20)
    for name, (way, units) in FILES.items():
        mesh = trimesh.Trimesh(units * vertices @ way.rotation(), triangles, process=False)
        mesh.export(folder / name)
    _write_several(folder, vertices, triangles)
    results = folder / "results.json"
    script = Path(__file__).with_name("heads_inside.py")
    files = [str(folder / name) for name in (RIGGED, *SEVERAL, *FILES)]
    host = host_named("4.5")
    host.require()
    command = host.command(script, [str(results), str(folder), *files])
    done = subprocess.run(
        command, env=host.environment(folder), capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
    return json.loads(results.read_text()), folder


def _write_several(folder, vertices, triangles):
    eye = trimesh.Trimesh(*ball((0.0, 0.0, 0.0), (0.011, 0.011, 0.011), 12), process=False)
    scene = trimesh.Scene({"head": trimesh.Trimesh(vertices @ FILES["standard.glb"][0].rotation(), triangles)})
    for side in (-1.0, 1.0):
        where = trimesh.transformations.translation_matrix((0.03 * side, 0.05, 0.08))
        scene.add_geometry(eye, f"eye{side:+g}", geom_name="eye", transform=where)
    scene.export(folder / SEVERAL[0])
    specks = vertices.max(axis=0) + 0.3 + 0.01 * np.random.default_rng(3).random((30, 3))
    corners = len(vertices) + np.arange(30).reshape(-1, 3)
    both = np.concatenate([vertices, specks]), np.concatenate([triangles, corners])
    trimesh.Trimesh(*both, process=False).export(folder / SEVERAL[1])


@pytest.mark.parametrize("name", [*FILES, *SEVERAL, RIGGED])
def test_a_head_of_a_file_stands_upright_in_meters_and_faces_front(found, name):
    vertices, _ = head(detail=20)
    about = found[0][name]
    assert about["low"] == pytest.approx(vertices.min(axis=0).tolist(), abs=0.004)
    assert about["high"] == pytest.approx(vertices.max(axis=0).tolist(), abs=0.004)
    assert about["nose"] == pytest.approx([0.0, -0.122, 0.035], abs=0.01)
    assert sorted(np.sign(ear[0]) for ear in about["ears"]) == [-1.0, 1.0]


def test_debians_blender_loads_every_format(found, tmp_path):
    """Its glTF importer asks numpy for what Debian's has no longer, and the whole traceback was the message."""
    results, folder = tmp_path / "results.json", found[1]
    host = host_named("3.4")
    host.require()
    (tmp_path / "cut.ply").write_bytes((folder / "turned.ply").read_bytes()[:5000])
    files = [str(folder / name) for name in (RIGGED, *SEVERAL, *FILES)] + [str(tmp_path / "cut.ply")]
    command = host.command(Path(__file__).with_name("heads_inside.py"), [str(results), "-", *files])
    done = subprocess.run(
        command, env=host.environment(tmp_path), capture_output=True, text=True, timeout=600, check=False
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
    vertices, _ = head(detail=20)
    told = json.loads(results.read_text())
    assert told.pop("cut.ply")["error"].startswith("cut.ply: Blender could not read it (it is damaged")
    for about in told.values():
        assert about["low"] == pytest.approx(vertices.min(axis=0).tolist(), abs=0.004)
        assert sorted(np.sign(ear[0]) for ear in about["ears"]) == [-1.0, 1.0]


def test_the_first_picture_shows_light_through_the_ear(found):
    results, folder = found
    assert results["hero"]["unit_mm"] == 1000.0
    assert results["hero"]["orientation"] == {"up": "+Y", "facing": "+Z"}
    assert results["denoises"]
    picture = plt.imread(folder / "hero.png")
    assert picture.shape[:2] == (48, 48)
    red = picture[:, :, 0] - picture[:, :, 2]
    assert red.max() > 0.2
    for name in ("preview.png", "head.blend"):
        assert (folder / name).is_file()


def test_a_head_that_cannot_be_used_is_told_in_words(found):
    assert "--unit" in found[0]["error"]["error"]


@pytest.mark.parametrize(
    ("name", "words"),
    [
        ("broken.glb", "Blender could not read it"),
        ("broken.ply", "Blender could not read it"),
        ("empty.obj", "contains no mesh with faces"),
        ("head.fbx", "allowed: .glb, .gltf, .obj, .ply, .stl"),
    ],
)
def test_a_file_without_a_head_is_told_in_words(found, name, words):
    assert found[0][name]["error"].startswith(name) and words in found[0][name]["error"]


def test_sockets_mouth_and_nostrils_of_the_person_do_not_glow(tmp_path):
    """Flesh is thin there too; the dot at a nostril in dark portraits was one of these."""
    shapes = human_head.fetch(human_head.SHAPES, print)
    results, pictures = tmp_path / "results.json", tmp_path / "pictures.npz"
    host = host_named("4.5")
    host.require()
    script = Path(__file__).with_name("person_inside.py")
    done = subprocess.run(
        host.command(script, [str(results), str(shapes), str(pictures)]),
        env=host.environment(tmp_path),
        capture_output=True,
        text=True,
        timeout=600,
        check=False,
    )
    assert done.returncode == 0, done.stdout[-2000:] + done.stderr[-4000:]
    pixels = json.loads(results.read_text())
    left, right = sorted((pixels["helper-l-eye"], pixels["helper-r-eye"]))
    apart = right[0] - left[0]
    # From brows to chin, as wide as both eyes.
    rows = slice(int(left[1] - 0.4 * apart), int(left[1] + 2.0 * apart))
    columns = slice(int(left[0] - 0.6 * apart), int(right[0] + 0.4 * apart))
    column, row = (int(value) for value in pixels["ear"])
    with np.load(pictures) as glow:
        ear = glow["masked"][row - 25 : row + 25, column - 15 : column + 15].max()
        assert ear > 0.5
        # Without the mask there is light in the face, so that this sees what it is about.
        assert glow["everywhere"][rows, columns].max() > 0.5 * ear
        assert glow["masked"][rows, columns].max() < 1e-3 * ear
