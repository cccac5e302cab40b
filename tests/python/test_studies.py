"""The command of the studies: what it lists is there, and it says in words what is missing."""

import importlib
import re
import shutil
import subprocess
import sys
from html.parser import HTMLParser
from pathlib import Path

import numpy as np
import pytest

from studies import __main__ as command
from studies.demo import page
from studies.errors import Reference
from studies.ladder.cells import Cells
from studies.paths import IMAGES
from studies.progress import StudyError
from studies.report import fill

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", command.STUDIES)
def test_each_study_can_be_run(name):
    assert callable(importlib.import_module(f"studies.{name}.study").main)


def test_each_study_tells_its_options(tmp_path, monkeypatch, capsys):
    monkeypatch.chdir(tmp_path)
    before = (IMAGES / "architecture.svg").stat()
    for name in command.STUDIES:
        for options, code in ((["--help"], 0), (["--no-such-option"], 2)):
            with pytest.raises(SystemExit) as end:
                importlib.import_module(f"studies.{name}.study").main(options)
            assert end.value.code == code, name
        assert "usage: " in capsys.readouterr().out
    assert list(tmp_path.iterdir()) == [] and (IMAGES / "architecture.svg").stat() == before


@pytest.mark.parametrize(
    "words",
    ["demo --quick --docs", f"demo --quick --rig {__file__}", "batch --scene --docs", "ear --reuse --size 64 --unit 2"],
)
def test_an_option_that_would_change_nothing_is_refused(tmp_path, monkeypatch, capsys, words):
    monkeypatch.chdir(tmp_path)
    name, *options = words.split()
    with pytest.raises(SystemExit) as end:
        importlib.import_module(f"studies.{name}.study").main(options)
    assert end.value.code == 2 and "error: " in capsys.readouterr().err and list(tmp_path.iterdir()) == []


def pictures_named_in(study: str) -> list[str]:
    """Patterns of the file names in a study's sources; what is filled in is any word."""
    text = "".join(path.read_text() for path in sorted((ROOT / "studies" / study).glob("*.py")))
    names = re.findall(r'"([\w{}.]+\.(?:png|jpg|svg))"', text)
    # A name that begins with what is filled in says nothing.
    return [re.sub(r"\\{.*?\\}", r"\\w+", re.escape(name)) for name in names if not name.startswith("{")]


def test_every_picture_of_the_docs_is_made_by_a_study_and_shown_on_a_page():
    made = [(name, study) for study, about in command.STUDIES.items() for name in about.pictures]
    assert sorted(name for name, _study in made) == sorted(path.name for path in IMAGES.iterdir())
    pages = [ROOT / "README.md", *(ROOT / "docs").glob("*.md")]
    shown = {name for path in pages for name in re.findall(r"images/([\w.]+)", path.read_text())} | set(page.COMMITTED)
    for name, study in made:
        assert name in shown, f"no page shows {name}"
        assert any(re.fullmatch(pattern, name) for pattern in pictures_named_in(study)), f"{study} does not name {name}"


def test_a_name_that_no_study_has_is_told_with_those_there_are():
    done = subprocess.run([sys.executable, "-m", "studies", "eras"], cwd=ROOT, capture_output=True, text=True)
    assert done.returncode == 1
    assert done.stderr.startswith("skinglow: no study is named eras; there are: demo, accuracy, ear")


def test_without_a_build_it_says_what_to_run(monkeypatch, tmp_path):
    monkeypatch.setattr(command, "CLI", tmp_path / "skinglow")
    with pytest.raises(StudyError, match="run scripts/setup and scripts/build first"):
        command.require("blender")


def test_a_picture_as_noisy_as_the_reference_has_its_own_strength():
    random = np.random.default_rng(4)
    truth = random.uniform(0.5, 1.5, (40000, 3))
    dim, bright = (
        Reference(*(scale * truth * (1.0 + 0.5 * random.standard_normal(truth.shape)) for _ in range(2)))
        for scale in (1.0, 3.0)
    )
    assert dim.best_factor_to(bright) == pytest.approx(3.0, rel=0.02)


def test_the_ladder_keeps_what_was_rendered_with_the_same_inputs(tmp_path):
    mesh = tmp_path / "mesh.npz"
    mesh.write_bytes(b"one")
    job = {"mesh_file": str(mesh), "rigs": {}, "center": [0, 0, 0], "height": 0.1, "size": 8, "host": ["4.5", "3.4"]}
    cells = Cells.of(tmp_path, "head", job)
    for rung in ("shape 0.8", "pixel"):
        cells.keep(f"behind|{rung}", np.full((2, 2, 4), 0.5), 1.5, 20.0)
    again = Cells.of(tmp_path, "head", job)
    assert again["behind|pixel"].seconds == 1.5 and again["behind|pixel"].prepared == 20.0
    again.forget("shape 0.8")
    assert "behind|shape 0.8" not in again and "behind|pixel" in again
    mesh.write_bytes(b"another")
    assert "behind|pixel" not in Cells.of(tmp_path, "head", job)


def test_a_page_without_the_section_is_told(tmp_path):
    path = tmp_path / "page.md"
    path.write_text("<!-- measured: here -->\nold\n<!-- end -->\n")
    fill(path, {"here": "new"})
    assert path.read_text() == "<!-- measured: here -->\nnew\n<!-- end -->\n"
    with pytest.raises(ValueError, match="measured: there"):
        fill(path, {"there": "new"})


class Images(HTMLParser):
    def __init__(self):
        super().__init__()
        self.found = []

    def handle_starttag(self, tag, attrs):
        if tag == "img":
            self.found.append(dict(attrs))


def test_the_page_of_the_demo_shows_only_what_is_in_its_folder(tmp_path):
    light = {"name": "<Bulb>", "distance": None, "weight": (0.1, 0.2, 0.3), "share": 1.0, "reason": None}
    numbers = {
        "head": {"name": "A & B", "license": "CC0"},
        "vertices": 3,
        "blender": "4.5",
        "seconds": 1.0,
        "strength": 20.0,
        "exposure_stops": 2.0,
        "comparison": {"rms": 1e-3, "max": 1e-2, "allowed_rms": 1 / 255},
        "lights": {"table1": [light], "rim": [light]},
    }
    page.write(tmp_path, numbers)
    text = (tmp_path / "index.html").read_text()
    assert "&lt;Bulb&gt;" in text and "A &amp; B" in text
    images = Images()
    images.feed(text)
    assert all(
        set(image) == {"src", "alt", "loading"} or image["src"] == "physical_surface_ear.png" for image in images.found
    )
    assert "Blender's rim lights, or those of --rig" in [image["alt"] for image in images.found]
    shown = re.findall(r"(?:src=|url\()([\w./]+)", text)
    assert {name for name in shown if "/" in name} == {
        f"from_docs/{path.name}" for path in tmp_path.glob("from_docs/*")
    }
    # What a run draws itself: by demo/figures.py, but for the first picture.
    drawn = (ROOT / "studies" / "demo" / "figures.py").read_text()
    assert all(f'"{name}"' in drawn for name in shown if "/" not in name and name != "physical_surface_ear.png")


def test_what_the_demo_tells_to_have_spent_is_without_the_build(tmp_path):
    """A process that replaces the shell inherits what the shell's children spent."""
    project = tmp_path / "project"
    (project / "build" / "envs" / "tools" / "bin").mkdir(parents=True)
    shutil.copytree(ROOT / "scripts", project / "scripts")
    (project / "studies").symlink_to(ROOT / "studies")
    for name in ("setup", "build"):
        (project / "scripts" / name).write_text("for ((i = 0; i < 300000; i++)); do :; done\n")
    python = project / "build" / "envs" / "tools" / "bin" / "python"
    told = f"import sys; sys.path[:0] = [{str(ROOT)!r}]; from studies import timing; print(timing.spent())"
    python.write_text(
        f"#!/usr/bin/env bash\nexec {sys.executable} -c '{told}'\n".replace("'" + str(ROOT) + "'", f'"{ROOT}"')
    )
    python.chmod(0o755)
    done = subprocess.run(["bash", project / "scripts" / "demo"], capture_output=True, text=True, cwd=tmp_path)
    assert done.stdout.startswith("0 s of processor time"), done


@pytest.mark.parametrize(
    ("given", "code", "told"),
    [
        (["--help"], 0, "usage: scripts/demo"),
        (["nothere.ply"], 2, "nothere.ply: no such file; give a GLB, OBJ, PLY or STL mesh"),
        (["--size", "0"], 2, "--size: '0' is no whole number from 1 on"),
        (["--samples", "-1"], 2, "--samples: '-1' is no whole number from 1 on"),
        (["--unit", "nan"], 2, "--unit: 'nan' is no number above 0"),
        (["--up=Q"], 2, "--up: 'Q' is no axis"),
        (["--ear", "1,2"], 2, "--ear: '1,2' is no point; give three numbers"),
        (["--color-map", "skin.png"], 2, "--color-map: skin.png: no such file"),
        (["--out", "note.txt"], 2, "--out note.txt: is a file; give a folder"),
        (["note.txt", "--mesh", "suzanne"], 2, "two heads are given, note.txt and suzanne"),
    ],
)
def test_the_demo_answers_about_its_options_before_it_sets_up(tmp_path, given, code, told):
    """It told of a file that is not there after minutes of installing and building, and of a size of 0 never."""
    project = tmp_path / "project"
    shutil.copytree(ROOT / "scripts", project / "scripts")
    (project / "studies").symlink_to(ROOT / "studies")
    (project / "scripts" / "setup").write_text("echo sets up\nexit 7\n")
    (tmp_path / "note.txt").write_text("")
    done = subprocess.run(["bash", project / "scripts" / "demo", *given], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == code, done.stdout + done.stderr
    assert told in " ".join((done.stdout + done.stderr).split())
    assert "sets up" not in done.stdout


def test_the_demo_sets_up_when_its_options_can_be(tmp_path):
    project = tmp_path / "project"
    shutil.copytree(ROOT / "scripts", project / "scripts")
    (project / "studies").symlink_to(ROOT / "studies")
    (project / "scripts" / "setup").write_text("echo sets up\nexit 7\n")
    (tmp_path / "my head.ply").write_text("")
    given = ["my head.ply", "--up", "z", "--facing=-Y", "--unit", "1", "--ear=-8,4.5,-1"]
    done = subprocess.run(["bash", project / "scripts" / "demo", *given], capture_output=True, text=True, cwd=tmp_path)
    assert done.returncode == 7 and "sets up" in done.stdout
