"""`python -m skinglow`: what comes with `pip install skinglow`, held against the functions and the C++ program."""

import json
import os
import subprocess
import sys
from pathlib import Path

import numpy as np
import pytest
import skinglow as sg
import trimesh
from skinglow.__main__ import main
from skinglow._mesh_files import read_mesh

ROOT = Path(__file__).resolve().parents[2]
RIG = ROOT / "tests" / "data" / "table1.json"
PROGRAM = Path(os.environ.get("SKINGLOW_CLI", ROOT / "build/release/bin/skinglow"))


def read(path: Path) -> np.ndarray:
    rows = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    return np.array([[float(number) for number in row.split(",")] for row in rows[1:]])


def ball(path: Path, radius: float) -> Path:
    mesh = trimesh.creation.icosphere(subdivisions=3, radius=radius)
    np.savez(path, vertices=mesh.vertices, triangles=mesh.faces)
    return path


def refused(capsys: pytest.CaptureFixture, *arguments: object) -> str:
    try:
        code = main([str(argument) for argument in arguments])
    except SystemExit as error:
        code = error.code
    told = capsys.readouterr()
    assert code == 2 and told.out == "" and told.err.startswith("skinglow: ") and told.err.count("\n") == 1, told
    return told.err


def test_weights_are_those_of_the_program() -> None:
    asked = ["weights", str(RIG), "--point", "0.1", "0", "0.2", "--json"]
    ours = subprocess.run([sys.executable, "-m", "skinglow", *asked], capture_output=True, text=True, check=True)
    theirs = subprocess.run([PROGRAM, *asked], capture_output=True, text=True, check=True)
    got, want = json.loads(ours.stdout), json.loads(theirs.stdout)
    for name in ("point", "light_weight", "blood_weight", "weight"):
        np.testing.assert_allclose(got[name], want[name], rtol=1e-13)
    assert len(got["lights"]) == len(want["lights"]) == 3
    for one, other in zip(got["lights"], want["lights"], strict=True):
        assert {key: one[key] for key in ("name", "kind", "on")} == {key: other[key] for key in ("name", "kind", "on")}
        np.testing.assert_allclose([*one["weight"], one["share"]], [*other["weight"], other["share"]], rtol=1e-13)


def test_weights_as_a_table(capsys: pytest.CaptureFixture) -> None:
    assert main(["weights", str(RIG)]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert [line.split()[0] for line in lines] == ["Light1", "Light2", "Light3", "L", "B", "B"]
    assert lines[4].split()[1:] == ["1.8", "0.5", "0.4"]


@pytest.mark.parametrize("chosen", [["--mode", "existing"], [RIG], [RIG, "--mode", "physical", "--skin", "ear"]])
def test_tables_are_those_of_the_program(chosen: list, tmp_path: Path) -> None:
    chosen = [*map(str, chosen), "--size", "32", "--max-thickness", "8"]
    assert main(["lut", *chosen, "-o", str(tmp_path / "ours.csv")]) == 0
    subprocess.run([PROGRAM, "lut", *chosen, "-o", tmp_path / "theirs.csv"], capture_output=True, check=True)
    ours = read(tmp_path / "ours.csv")
    assert ours.shape == (32, 4)
    np.testing.assert_allclose(ours, read(tmp_path / "theirs.csv"), rtol=1e-12)


def test_table_of_a_skin_as_numpy(tmp_path: Path) -> None:
    asked = ["lut", "--skin", "light", "--melanin-fraction", "0.2", "--size", "16", "-o", str(tmp_path / "a.npy")]
    assert main(asked) == 0
    want = sg.recolor(sg.base_lut(sg.TISSUE_PRESETS["light"].replace(melanin_fraction=0.2), 16), np.ones(3))
    np.testing.assert_array_equal(np.load(tmp_path / "a.npy")[:, 1:], want)


def test_thickness_of_a_ball(tmp_path: Path) -> None:
    mesh, unit = ball(tmp_path / "ball.npz", 0.01), "1000"
    assert main(["thickness", str(mesh), "--unit", unit, "-o", str(tmp_path / "a.csv")]) == 0
    with np.load(mesh) as held:
        want = sg.thickness(held["vertices"], held["triangles"], 1000.0)
    np.testing.assert_array_equal(read(tmp_path / "a.csv")[:, 3], want)
    np.testing.assert_allclose(want, 20.0, rtol=0.03)


def test_thickness_of_other_formats_by_meshio(tmp_path: Path) -> None:
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]
    lines = ["v {} {} {}".format(*corner) for corner in corners] + [f"f {face}" for face in faces]
    (tmp_path / "cube.obj").write_text("\n".join(lines) + "\n")
    assert main(["thickness", str(tmp_path / "cube.obj"), "-o", str(tmp_path / "a.npy")]) == 0
    table = np.load(tmp_path / "a.npy")
    np.testing.assert_array_equal(table[:, :3], corners)
    assert np.all((table[:, 3] > 0.9) & (table[:, 3] <= 3**0.5))


def test_light_through_a_plate(tmp_path: Path) -> None:
    """A plate of 4 mm, 20 mm wide, under the lights of the rig."""
    plate = trimesh.creation.box(extents=(0.02, 0.02, 0.004)).subdivide().subdivide()
    np.savez(tmp_path / "plate.npz", vertices=plate.vertices, triangles=plate.faces)
    asked = ["shape", tmp_path / "plate.npz", RIG, "--cell", "1", "--reentries", "0", "-o", tmp_path / "a.csv"]
    assert main([str(argument) for argument in asked]) == 0
    got = read(tmp_path / "a.csv")
    body = sg.Shape(plate.vertices, plate.faces, sg.TISSUE_PRESETS["light"], unit_mm=1000.0, cell_mm=1.0)
    want = body.light(sg.read_light_rig(RIG).lights, reentries=0).exitance
    np.testing.assert_allclose(got[:, 3:], want, rtol=1e-12)
    assert want.max() > 0.0


def test_refusals_are_one_line_that_names_the_thing(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    out = tmp_path / "a.csv"
    np.savez(tmp_path / "empty.npz", vertices=np.zeros((0, 3)))
    (tmp_path / "text.ply").write_text("no mesh")
    for arguments, word in (
        (("weights", tmp_path / "none.json"), "none.json"),
        (("weights", RIG, "--coefficients", "-1", "0", "0"), "coefficient"),
        (("lut", "-o", out), "RIG"),
        (("lut", RIG, "--mode", "existing", "-o", out), "RIG"),
        (("lut", RIG, "--mode", "paper", "--skin", "ear", "-o", out), "--skin"),
        (("lut", RIG, "-o", tmp_path / "a.exr"), ".csv or .npy"),
        (("lut", RIG, "--size", "0", "-o", out), "size"),
        (("lut", "--skin", "ear", "--melanin-fraction", "7", "-o", out), "melanin_fraction"),
        (("thickness", tmp_path / "empty.npz", "-o", out), "triangles"),
        (("thickness", tmp_path / "text.ply", "-o", out), "text.ply"),
        (("thickness", tmp_path / "none.ply", "-o", out), "none.ply"),
        (("thickness", tmp_path / "none.npz", "-o", out), "none.npz: No such file or directory: check the name"),
        (("lut", RIG, "-o", tmp_path / "missing" / "a.csv"), "there is no folder"),
        (("melt",), "melt"),
        # What would change nothing is no option.
        (("shape", tmp_path / "empty.npz", RIG, "--point", 0, 0, 1, "-o", out), "--point"),
        (("shape", tmp_path / "empty.npz", RIG, "--blood", 1, 1, 1, "-o", out), "--blood"),
    ):
        assert word in refused(capsys, *arguments), arguments
    assert not out.exists()


@pytest.mark.parametrize(
    ("words", "told"),
    [
        (f"{RIG} --tolerance 0.05 --mode paper", "belong to --mode physical"),
        ("--mode existing --blood 1 1 1", "there is no RIG, which --blood would not change"),
        ("--skin ear --camera-rotation 1 2 3", "there is no RIG, which --camera-rotation would not change"),
        (f"{RIG} --skin ear --coefficients 1 2 3", "--coefficients would not change"),
    ],
)
def test_an_option_that_would_change_nothing_is_refused(
    tmp_path: Path, capsys: pytest.CaptureFixture, words: str, told: str
) -> None:
    assert told in refused(capsys, "lut", *words.split(), "-o", tmp_path / "a.csv")
    assert list(tmp_path.iterdir()) == []


@pytest.mark.skipif(sys.platform != "linux", reason="names are text elsewhere")
def test_files_whose_names_are_no_text(tmp_path: Path) -> None:
    """POSIX' names are bytes; a terminal in UTF-8, whose Python refuses to print others, must not end what is done."""
    name = os.fsdecode(b"caf\xe9")
    (tmp_path / f"{name}.json").write_bytes(RIG.read_bytes())
    command = [sys.executable, "-m", "skinglow", "lut", "--size", "8", "-o", f"{name}.csv"]
    strict = {**os.environ, "PYTHONIOENCODING": "utf-8:strict"}
    runs = [
        subprocess.run([*command, file], cwd=tmp_path, env=strict, capture_output=True, check=False)
        for file in (f"{name}.json", f"none {name}.json")
    ]
    assert runs[0].returncode == 0 and runs[0].stderr == b""
    assert runs[0].stdout.startswith(b"caf\\udce9.csv: mode paper")
    assert len(read(tmp_path / f"{name}.csv")) == 8
    assert runs[1].returncode == 2 and b"skinglow: file none caf\\udce9.json: cannot be" in runs[1].stderr


def test_a_folder_that_is_closed_is_told_by_the_name_that_was_given(
    tmp_path: Path, capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def closed(self: Path, *_arguments: object, **_options: object) -> None:
        raise PermissionError(13, "Permission denied", str(self))

    monkeypatch.setattr(Path, "write_text", closed)  # root may write anywhere
    told = refused(capsys, "lut", RIG, "-o", tmp_path / "a.csv")
    assert f"file {tmp_path / 'a.csv'}: cannot be written: Permission denied: choose a folder" in told
    assert ".part" not in told and not list(tmp_path.iterdir())


def test_a_name_of_several_lines_is_one_line_of_the_table(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    light = {"kind": "POINT", "name": "Key\nL 9 9\x1b[2J"}
    (tmp_path / "rig.json").write_text(json.dumps({"skinglow_rig": 1, "lights": [light]}))
    assert main(["weights", str(tmp_path / "rig.json")]) == 0
    lines = capsys.readouterr().out.splitlines()
    assert len(lines) == 4 and lines[0].startswith("Key?L 9 9?[2J ")


def test_damaged_files_are_refused_at_once(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    """An archive cut at every length, and with any byte changed, is read or refused in one line."""
    whole = ball(tmp_path / "ball.npz", 1.0).read_bytes()
    bad, out = tmp_path / "bad.npz", tmp_path / "a.csv"
    rng = np.random.default_rng(7)
    cuts = [whole[: int(n)] for n in rng.integers(0, len(whole) - 1, 100)]
    for content in [b"", b"PK\x03\x04", *cuts]:
        bad.write_bytes(content)
        assert "bad.npz" in refused(capsys, "thickness", bad, "-o", out)
    for at in rng.integers(0, len(whole), 300):
        bad.write_bytes(whole[:at] + bytes([rng.integers(256)]) + whole[at + 1 :])
        try:
            read_mesh(bad)
        except ValueError as refusal:
            assert "bad.npz" in str(refusal)
    np.save(tmp_path / "plain.npy", np.zeros(3))
    (tmp_path / "plain.npy").rename(tmp_path / "plain.npz")
    assert "plain.npz" in refused(capsys, "thickness", tmp_path / "plain.npz", "-o", out)
    assert "is not a file" in refused(capsys, "thickness", tmp_path, "-o", out)


@pytest.mark.skipif(not hasattr(os, "mkfifo"), reason="this system has no pipes and devices among its files")
def test_special_files_are_refused_at_once(tmp_path: Path, capsys: pytest.CaptureFixture) -> None:
    out = tmp_path / "a.csv"
    for name in ("pipe.npz", "pipe.ply"):
        os.mkfifo(tmp_path / name)
        assert "is not a file" in refused(capsys, "thickness", tmp_path / name, "-o", out)
        assert name in refused(capsys, "weights", tmp_path / name)
    (tmp_path / "endless.npz").symlink_to("/dev/zero")
    assert "is not a file" in refused(capsys, "thickness", tmp_path / "endless.npz", "-o", out)


def test_a_full_disk_is_told_without_a_file_that_nobody_named(
    capsys: pytest.CaptureFixture, monkeypatch: pytest.MonkeyPatch
) -> None:
    def full(*_: object, **__: object) -> None:
        raise OSError(28, "No space left on device")

    full.__name__ = "weights"  # the command's
    monkeypatch.setattr("skinglow.__main__.weights", full)
    assert refused(capsys, "weights", RIG) == "skinglow: No space left on device\n"
