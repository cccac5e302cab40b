"""The `skinglow` executable as people use it: what it prints, writes, refuses and returns."""

import json
import math
import os
import re
import struct
import subprocess
from pathlib import Path

import pytest

ROOT = Path(__file__).resolve().parents[2]
DATA = ROOT / "tests" / "data"
PROGRAM = Path(os.environ.get("SKINGLOW_CLI", ROOT / "build/release/bin/skinglow"))
COMMANDS = ("weights", "lut", "rig", "thickness", "povray", "compare")


def skinglow(*arguments, code=0):
    done = subprocess.run([PROGRAM, *map(str, arguments)], capture_output=True, text=True, timeout=120, check=False)
    assert done.returncode == code, done.stdout + done.stderr
    assert not re.search(r"\b(nan|inf)\b", done.stdout, re.IGNORECASE), done.stdout
    return done


def refused(*arguments):
    """The one line of the error."""
    done = skinglow(*arguments, code=2)
    assert done.stdout == ""
    lines = done.stderr.strip().split("\n")
    assert lines[-1].startswith("skinglow: ")
    return lines[-1]


def cube_obj(path):
    corners = [(x, y, z) for x in (0, 1) for y in (0, 1) for z in (0, 1)]
    faces = ["1 2 4 3", "5 7 8 6", "1 5 6 2", "3 4 8 7", "1 3 7 5", "2 6 8 4"]
    lines = [f"v {x} {y} {z}" for x, y, z in corners]
    path.write_text("\n".join([*lines, "g box", *("f " + face for face in faces)]) + "\n")
    return path


def read_table(path):
    rows = [line for line in path.read_text().splitlines() if not line.startswith("#")]
    assert rows[0] == "thickness_mm,r,g,b"
    return [[float(number) for number in row.split(",")] for row in rows[1:]]


def test_version_is_the_projects():
    version = re.search(r"project\(skinglow VERSION ([\d.]+)", (ROOT / "CMakeLists.txt").read_text())
    assert skinglow("--version").stdout.strip() == version[1]


@pytest.mark.parametrize("command", COMMANDS)
def test_help_has_an_example(command):
    text = skinglow(command, "--help").stdout
    assert f"Example: skinglow {command} " in text
    assert command in skinglow("--help").stdout


def test_weights_of_table_1():
    report = json.loads(skinglow("weights", DATA / "table1.json", "--json").stdout)
    rows = [((255, 112, 69), 0.92357), ((15, 64, 255), 0.85231), ((255, 255, 255), 1.01292)]
    total = [0.0, 0.0, 0.0]
    for light, (color, distance) in zip(report["lights"], rows, strict=True):
        attenuation = 1 / (1 + distance**2)
        assert math.isclose(light["distance"], distance, rel_tol=1e-14)
        assert math.isclose(light["attenuation"], attenuation, rel_tol=1e-14)
        for i in range(3):
            assert math.isclose(light["weight"][i], color[i] / 255 * attenuation, rel_tol=1e-14)
            total[i] += color[i] / 255 * attenuation
    for i, blood in enumerate((1.8, 0.5, 0.4)):
        assert math.isclose(report["light_weight"][i], total[i], rel_tol=1e-12)
        assert math.isclose(report["weight"][i], total[i] + blood, rel_tol=1e-12)
    assert math.isclose(sum(light["share"] for light in report["lights"]), 1.0, rel_tol=1e-12)


def test_weights_table_for_people():
    text = skinglow("weights", DATA / "table1.json").stdout
    header = next(line for line in text.splitlines() if line.startswith("light"))
    assert header.split() == ["light", "kind", "distance", "attenuation", "r", "g", "b", "share"]
    assert re.search(r"Light2 +POINT +0\.85231 +0\.579229 +0\.0340723 +0\.145375 +0\.579229", text)
    assert re.search(r"B \+ L +2\.86732 +1\.37599 +1\.61884", text)


def test_weights_takes_numbers_from_the_command_line():
    options = ("--point", -1, -2, -3, "--coefficients", 0, 0, 0, "--blood", 0, 0, 0, "--json")
    report = json.loads(skinglow("weights", DATA / "table1.json", *options).stdout)
    assert [light["attenuation"] for light in report["lights"]] == [1, 1, 1]
    assert report["weight"] == report["light_weight"]


def test_weights_of_lamps_that_are_off_and_of_suns():
    report = json.loads(skinglow("weights", DATA / "all_kinds.json", "--json").stdout)
    lights = {light["name"]: light for light in report["lights"]}
    assert lights["Evening"]["distance"] is None
    assert lights["Evening"]["attenuation"] == 1
    assert lights["Unplugged"]["on"] is False
    assert lights["Unplugged"]["weight"] == [0, 0, 0]
    assert "off" in skinglow("weights", DATA / "all_kinds.json").stdout


def test_no_lights(tmp_path):
    rig = tmp_path / "none.json"
    rig.write_text('{"skinglow_rig": 1, "lights": []}')
    report = json.loads(skinglow("weights", rig, "--json").stdout)
    assert report["light_weight"] == [0, 0, 0]
    assert report["weight"] == [1.8, 0.5, 0.4]
    skinglow("weights", rig)


def test_studio_light_says_what_it_leaves_out():
    done = skinglow("weights", DATA / "two_lamps.sl", "--json")
    assert "ambient" in done.stderr and "smooth" in done.stderr
    assert json.loads(done.stdout)["light_weight"] == pytest.approx([1.025, 0.7, 0.6], rel=1e-15)


def test_rig_file_of_a_studio_light(tmp_path):
    skinglow("rig", DATA / "two_lamps.sl", "-o", tmp_path / "rig.json")
    rig = json.loads((tmp_path / "rig.json").read_text())
    assert rig["lights"][0]["direction"] == [-0.6, -0.8, 0]
    again = skinglow("weights", tmp_path / "rig.json", "--json").stdout
    assert again == skinglow("weights", DATA / "two_lamps.sl", "--json").stdout


def test_lut_existing_is_the_six_gaussians(tmp_path):
    skinglow("lut", "--mode", "existing", "--size", 5, "--max-thickness", 4, "-o", tmp_path / "t.csv")
    variances = (0.0064, 0.0484, 0.187, 0.567, 1.99, 7.41)
    red = (0.233, 0.1, 0.118, 0.113, 0.358, 0.078)
    rows = read_table(tmp_path / "t.csv")
    assert [row[0] for row in rows] == [0, 1, 2, 3, 4]
    for row in rows:
        by_hand = sum(w * math.exp(-(row[0] ** 2) / v) for w, v in zip(red, variances, strict=True))
        assert math.isclose(row[1], by_hand, rel_tol=1e-12)


def test_lut_paper_is_equation_1(tmp_path):
    skinglow("lut", DATA / "table1.json", "--size", 9, "-o", tmp_path / "paper.csv")
    skinglow("lut", "--mode", "existing", "--size", 9, "-o", tmp_path / "existing.csv")
    weight = json.loads(skinglow("weights", DATA / "table1.json", "--json").stdout)["weight"]
    rows = zip(read_table(tmp_path / "paper.csv"), read_table(tmp_path / "existing.csv"), strict=True)
    for (_, *color), (_, r, g, b) in rows:
        gray = 0.2126 * r + 0.7152 * g + 0.0722 * b
        assert color == pytest.approx([gray * w for w in weight], rel=1e-12)


def test_lut_formats_agree_and_clamping_is_reported(tmp_path):
    for name in ("a.exr", "a.png", "a.csv"):
        done = skinglow("lut", DATA / "table1.json", "-o", tmp_path / name, "--preview", tmp_path / "p.png")
        assert ("texels were clamped" in done.stderr) == (name == "a.png")
    assert struct.unpack(">II", (tmp_path / "p.png").read_bytes()[16:24]) == (512, 64)
    skinglow("lut", DATA / "table1.json", "--bits", 16, "--encoding", "linear", "-o", tmp_path / "b.png")
    assert (tmp_path / "b.png").read_bytes()[24] == 16
    # The two PNGs differ by half a level of the coarser, the clamped entries included.
    near = json.loads(skinglow("compare", tmp_path / "a.png", tmp_path / "b.png", "--json").stdout)
    assert 0 < near["max"] < 0.01
    left = sorted(path.name for path in tmp_path.iterdir())
    assert left == ["a.csv", "a.exr", "a.png", "b.png", "p.png"]


def test_lut_from_an_image(tmp_path):
    skinglow("lut", "--mode", "existing", "--max-thickness", 7, "-o", tmp_path / "base.exr")
    done = skinglow("lut", DATA / "table1.json", "--base", tmp_path / "base.exr", "-o", tmp_path / "a.csv")
    assert "Rec.709 luminance" in done.stderr
    assert read_table(tmp_path / "a.csv")[-1][0] == 7


def test_compare_limits_and_heat_map(tmp_path):
    skinglow("lut", DATA / "table1.json", "-o", tmp_path / "a.exr")
    skinglow("lut", "--mode", "existing", "-o", tmp_path / "b.exr")
    pair = (tmp_path / "a.exr", tmp_path / "b.exr")
    same = json.loads(skinglow("compare", pair[0], pair[0], "--json", "--max-rms", 0).stdout)
    assert same["rms"] == 0 and same["psnr_db"] is None
    assert "same" in skinglow("compare", pair[0], pair[0]).stdout
    report = json.loads(skinglow("compare", *pair, "--json").stdout)
    assert list(report["percentiles"]) == ["50", "90", "95", "99", "99.9"]
    assert report["percentiles"]["99.9"] <= report["max"]
    seen = json.loads(skinglow("compare", *pair, "--json", "--side-by-side", tmp_path / "s.png").stdout)
    assert seen["heat_map_white"] == report["max"]
    assert (tmp_path / "s.png").read_bytes().startswith(b"\x89PNG")
    a, b = (read_csv_of(path, tmp_path) for path in ("paper", "existing"))
    pairs = [pair for rows in zip(a, b, strict=True) for pair in zip(*(row[1:] for row in rows), strict=True)]
    squares = [(x - y) ** 2 for x, y in pairs]
    assert math.isclose(report["rms"], math.sqrt(sum(squares) / len(squares)), rel_tol=1e-6)
    assert math.isclose(report["psnr_db"], -20 * math.log10(report["rms"]), rel_tol=1e-12)
    done = skinglow("compare", *pair, "--max-rms", report["rms"] / 2, "--heatmap", tmp_path / "h.png", code=1)
    assert "above --max-rms" in done.stderr
    assert "heat map: white is a difference of" in done.stdout
    assert (tmp_path / "h.png").read_bytes().startswith(b"\x89PNG")


def read_csv_of(mode, folder):
    rig = () if mode == "existing" else (DATA / "table1.json",)
    skinglow("lut", *rig, "--mode", mode, "-o", folder / f"{mode}.csv")
    return read_table(folder / f"{mode}.csv")


def test_thickness_of_a_cube(tmp_path):
    mesh = cube_obj(tmp_path / "cube.obj")
    done = skinglow("thickness", mesh, "--unit", 10, "--group", "box", "-o", tmp_path / "t.csv")
    assert "8 vertices, 12 triangles" in done.stdout
    rows = [row.split(",") for row in (tmp_path / "t.csv").read_text().splitlines()[2:]]
    assert len(rows) == 8
    for row in rows:
        assert 0 < float(row[4]) <= 10 * math.sqrt(3)
    skinglow("thickness", mesh, "-o", tmp_path / "t.ply")
    skinglow("thickness", tmp_path / "t.ply", "-o", tmp_path / "again.csv")
    assert "no group" in refused("thickness", mesh, "--group", "nose", "-o", tmp_path / "no.csv")
    assert not (tmp_path / "no.csv").exists()


def test_povray_writes_a_scene(tmp_path):
    mesh = cube_obj(tmp_path / "cube.obj")
    scene = ("povray", DATA / "table1.json", "--mesh", mesh)
    skinglow(*scene, "-o", tmp_path / "scene")
    assert {"scene.pov", "scene.ini", "mesh.inc"} <= {path.name for path in (tmp_path / "scene").iterdir()}
    skinglow("lut", DATA / "table1.json", "-o", tmp_path / "a.exr")
    table = ("--lut", tmp_path / "a.exr")
    skinglow(*scene, *table, "-o", tmp_path / "table")
    assert (tmp_path / "table" / "lut.exr").exists()
    message = refused(*scene, *table, "--size", 4, "-o", tmp_path)
    assert "--lut brings its own table" in message
    skinglow(*scene, "--skin", "ear", "--size", 2, "--tolerance", 0.1, "-o", tmp_path / "scene")
    assert "Skinglow_Red_Column = array[2]" in (tmp_path / "scene" / "columns.inc").read_text()
    skinglow(*scene, "-o", tmp_path / "scene")
    assert not (tmp_path / "scene" / "columns.inc").exists()


@pytest.mark.parametrize(
    ("text", "parts"),
    [
        ('{"skinglow_rig": 1,\n"lights": [\n{"kind": "POINT", "color": 1}]}', ["lights[0].color (line 3)"]),
        ('{"skinglow_rig": 1,\n"lights": [\n{"kind": "POINT",\n"power": 1e999}]}', ["line 4", "overflow"]),
        ('{"skinglow_rig": 1,\n"lights": [', ["line 2", "not JSON"]),
        ("[1, 2]", ["line 1", "object"]),
    ],
)
def test_bad_rigs_are_refused_with_key_and_line(tmp_path, text, parts):
    rig = tmp_path / "bad.json"
    rig.write_text(text)
    for command in (("weights", rig), ("lut", rig, "-o", tmp_path / "a.exr")):
        message = refused(*command)
        assert f"file {rig}" in message
        for part in parts:
            assert part in message
    assert not (tmp_path / "a.exr").exists()


def test_refusals_of_files_and_options(tmp_path):
    table = DATA / "table1.json"
    assert "does not exist" in refused("compare", tmp_path / "none.exr", tmp_path / "none.exr")
    assert "No such file" in refused("weights", tmp_path / "none.json")
    assert "extension .jpg" in refused("lut", table, "-o", tmp_path / "a.jpg")
    (tmp_path / "folder.exr").mkdir()
    assert "not a regular file" in refused("lut", table, "-o", tmp_path / "folder.exr")
    assert "choose a folder" in refused("lut", table, "-o", "/proc/a.exr")
    assert "table size is 0" in refused("lut", table, "--size", 0, "-o", tmp_path / "a.exr")
    assert "max_thickness_mm is -1" in refused("lut", table, "--max-thickness", -1, "-o", tmp_path / "a.exr")
    assert "needs lights" in refused("lut", "-o", tmp_path / "a.exr")
    assert "knows no lights" in refused("lut", table, "--mode", "existing", "-o", tmp_path / "a.exr")
    assert "--camera-rotation is for" in refused("weights", table, "--camera-rotation", 0, 0, 0)
    for value in ("nan", "inf", "-inf"):
        assert "finite" in refused("weights", table, "--point", value, 0, 0)
    assert "k_l" in refused("weights", table, "--coefficients", 1, -1, 1)
    assert "blood_weight" in refused("weights", table, "--blood", -1, 0, 0)
    assert "--max-rms" in refused("compare", tmp_path, tmp_path, "--max-rms", "nan")
    for arguments in ((), ("no-such-command",), ("weights",), ("lut", "--bits", 12, "-o", "a.png")):
        assert "--help" in refused(*arguments)
    assert list(tmp_path.iterdir()) == [tmp_path / "folder.exr"]


def test_a_closed_standard_output_is_an_error():
    with open("/dev/full", "w") as full:
        command = [PROGRAM, "weights", DATA / "table1.json"]
        done = subprocess.run(command, stdout=full, stderr=subprocess.PIPE, text=True, check=False)
    assert done.returncode == 2
    assert "standard output" in done.stderr


def test_schema_has_the_keys_that_the_reader_has(tmp_path):
    """The reader names its keys when it refuses one: the schema must have the same, for each kind of lamp."""
    schema = json.loads((ROOT / "docs" / "rig.schema.json").read_text())
    light = schema["definitions"]["light"]
    rig = tmp_path / "rig.json"

    def keys(text):
        rig.write_text(text)
        named = refused("weights", rig).split("keys are ")[1]
        return set(re.split(", | or ", named))

    assert keys('{"skinglow_rig": 1, "lights": [], "?": 0}') == set(schema["properties"])
    for kind in light["properties"]["kind"]["enum"]:
        allowed = set(light["properties"])
        for rule in light["allOf"]:
            condition = rule["if"]["properties"]["kind"]
            applies = kind in condition.get("enum", [condition.get("const")])
            branch = rule.get("then" if applies else "else", {})
            allowed -= {key for key, value in branch.get("properties", {}).items() if value is False}
        bad = {"skinglow_rig": 1, "lights": [{"kind": kind, "?": 0}]}
        assert keys(json.dumps(bad)) == allowed
