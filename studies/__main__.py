"""python -m studies NAME [OPTION...]: runs a study; without a name it lists them."""

from __future__ import annotations

import importlib
import importlib.util
import shutil
import sys
from dataclasses import dataclass

from studies.paths import CLI, ENVIRONMENTS
from studies.progress import StudyError


@dataclass(frozen=True)
class Study:
    about: str
    needs: tuple[str, ...] = ("package",)
    pictures: tuple[str, ...] = ()  #: of docs/images, which it makes


STUDIES = {
    "demo": Study(
        "a head lit from behind in Blender and POV-Ray: out/index.html",
        ("package", "blender", "povray"),
        ("hero.jpg", "color_change.png", "physical.png", "light_output.png"),
    ),
    "accuracy": Study(
        "errors and times of the skin optics: docs/accuracy.md; three minutes",
        pictures=tuple(f"accuracy_{name}.png" for name in ("presets", "methods", "solver", "table", "estimate")),
    ),
    "ear": Study(
        "a back-lit ear by every table against random walk: docs/accuracy.md",
        ("package", "blender"),
        ("ear_pictures.png", "ear_error.png"),
    ),
    "ladder": Study(
        "an ear by every method, error against run time: docs/accuracy.md",
        ("package", "blender"),
        tuple(f"ladder_{head}{kind}.png" for head in ("scan", "person", "suzanne") for kind in ("", "_pictures")),
    ),
    "shape": Study(
        "light through the shape against Monte Carlo: docs/shape.md",
        ("package", "blender"),
        ("shape_scan.png", "shape_makehuman.png"),
    ),
    "batch": Study("the example of docs/batch.md: frames x light rigs", ("package", "blender"), ("batch_example.png",)),
    "panel": Study(
        "the pictures of Blender's window in docs/blender.md",
        pictures=("guide_select.png", "panel.png", "guide_ear.png", "thickness.png"),
    ),
    "povray": Study("the picture of docs/povray.md, by POV-Ray alone", ("povray",), ("povray_example.png",)),
    "turn": Study(
        "a light carried round an ear: the first picture of docs/blender.md",
        ("package", "blender"),
        ("round_the_ear.png", "round_the_ear_film.jpg"),
    ),
    "architecture": Study("the folders of the core by their includes", (), ("architecture.svg",)),
}


def require(need: str) -> None:
    """Raises StudyError, with the remedy, if that is not there."""
    if need == "package" and not (importlib.util.find_spec("skinglow") and importlib.util.find_spec("matplotlib")):
        python = ENVIRONMENTS / "tools" / "bin" / "python"
        remedy = f"run {python} -m studies" if python.exists() else "run scripts/setup and scripts/build first"
        raise StudyError(f"{sys.executable} has no skinglow and matplotlib: {remedy}")
    if need == "blender" and not ((ENVIRONMENTS / "blender").exists() and CLI.exists()):
        raise StudyError("Blender or the command line is missing in build: run scripts/setup and scripts/build first")
    if need == "povray" and shutil.which("povray") is None:
        raise StudyError("POV-Ray is missing: run scripts/setup first")


def main(arguments: list[str]) -> None:
    if not arguments or arguments[0] in ("-h", "--help"):
        width = max(map(len, STUDIES))
        print(__doc__, *(f"  {name:{width}}  {study.about}" for name, study in STUDIES.items()), sep="\n")
        return
    name, *options = arguments
    if name not in STUDIES:
        raise StudyError(f"no study is named {name}; there are: {', '.join(STUDIES)}")
    for need in STUDIES[name].needs:
        require(need)
    importlib.import_module(f"studies.{name}.study").main(options)


if __name__ == "__main__":
    try:
        main(sys.argv[1:])
    except StudyError as error:
        sys.exit(f"skinglow: {error}")
