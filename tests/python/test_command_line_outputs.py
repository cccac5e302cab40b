"""What the C++ command line writes and prints: all of it or nothing, and lines that can be used as they are."""

import json
import shlex

import pytest
from test_command_line import DATA, cube_obj, refused, skinglow

RIG = DATA / "table1.json"


@pytest.mark.parametrize("name", ["a.jpg", "preview", "missing/a.png"])
def test_a_second_output_that_cannot_be_written_leaves_no_first(tmp_path, name):
    refused("lut", RIG, "-o", tmp_path / "a.exr", "--preview", tmp_path / name)
    picture = tmp_path / "picture.png"
    skinglow("lut", RIG, "-o", picture)
    both = ("--heatmap", tmp_path / "heat.png", "--side-by-side", tmp_path / name)
    refused("compare", picture, picture, *both)
    assert list(tmp_path.iterdir()) == [picture]


def test_an_output_is_refused_before_the_mesh_is_read(tmp_path):
    for name, word in (("thickness", "no extension"), ("a.txt", ".csv or .ply"), ("missing/a.csv", "choose a folder")):
        assert word in refused("thickness", tmp_path / "none.obj", "-o", tmp_path / name)


@pytest.mark.parametrize("name", ["plain", "my scene", 'it\'s "here"', "Kopf ü & $HOME"])
def test_the_command_that_renders_can_be_pasted(tmp_path, name):
    mesh = cube_obj(tmp_path / "cube.obj")
    told = skinglow("povray", RIG, "--mesh", mesh, "-o", tmp_path / name).stdout
    command = told.partition("render with: ")[2]
    assert shlex.split(command) == ["cd", str(tmp_path / name), "&&", "povray", "scene.ini"]


def test_a_name_of_several_lines_is_one_line_of_the_table(tmp_path):
    light = {"kind": "POINT", "name": "Key\nL  9 9 9\x1b[2J"}
    (tmp_path / "rig.json").write_text(json.dumps({"skinglow_rig": 1, "lights": [light]}))
    lines = skinglow("weights", tmp_path / "rig.json").stdout.splitlines()
    assert len(lines) == 7 and lines[3].startswith("Key?L  9 9 9?[2J  POINT")
    told = json.loads(skinglow("weights", tmp_path / "rig.json", "--json").stdout)
    assert told["lights"][0]["name"] == light["name"]


def test_a_table_that_a_spreadsheet_saved_is_the_same(tmp_path):
    """A UTF-8 mark, line ends of Windows, and as many commas in each row as the widest has."""
    skinglow("lut", RIG, "--size", 8, "-o", tmp_path / "a.csv")
    lines = (tmp_path / "a.csv").read_text().splitlines()
    saved = [line + "," * (3 - line.count(",")) for line in [*lines, ""]]
    (tmp_path / "b.csv").write_bytes(b"\xef\xbb\xbf" + "\r\n".join([*saved, ""]).encode())
    mesh = ("--mesh", cube_obj(tmp_path / "cube.obj"))
    for name in ("a", "b"):
        skinglow("povray", RIG, *mesh, "--lut", tmp_path / f"{name}.csv", "-o", tmp_path / name)
    one, other = (tmp_path / name / "lut.exr" for name in ("a", "b"))
    skinglow("compare", one, other, "--max-rms", 0)  # their bytes tell when they were written
    (tmp_path / "b.csv").write_text("\n".join([*lines[:-2], "", lines[-1], ""]))
    assert "none may be missing" in refused("povray", RIG, *mesh, "--lut", tmp_path / "b.csv", "-o", tmp_path / "c")


@pytest.mark.parametrize(
    ("told", "arguments"),
    [
        ("--encoding are of a PNG", ("lut", RIG, "--bits", 16, "-o", "a.exr")),
        ("--encoding are of a PNG", ("lut", RIG, "--encoding", "linear", "-o", "a.csv", "--preview", "p.png")),
        ("--scale is of heat maps", ("compare", "a.exr", "a.exr", "--scale", 1)),
        ("--coefficients would not change", ("lut", RIG, "--skin", "ear", "--coefficients", 1, 0, 1, "-o", "a.exr")),
        ("--blood would not change", ("lut", RIG, "--mode", "physical", "--blood", 1, 1, 1, "-o", "a.exr")),
        ("--blood would not change", ("povray", "--mode", "physical", "--blood", 1, 1, 1)),
        ("--point would not change", ("povray", "--mode", "existing", "--point", 1, 1, 1)),
        ("--coefficients would not change", ("povray", "--lut", "a.exr", "--coefficients", 1, 0, 1)),
    ],
)
def test_an_option_that_would_change_nothing_is_refused(tmp_path, told, arguments):
    files = [tmp_path / str(word) if str(word).endswith((".exr", ".csv", ".png")) else word for word in arguments]
    if arguments[0] == "povray":
        files[1:1] = [RIG, "--mesh", cube_obj(tmp_path / "cube.obj"), "-o", tmp_path / "scene"]
    assert told in refused(*files)
    assert [path.name for path in tmp_path.iterdir()] in ([], ["cube.obj"])
