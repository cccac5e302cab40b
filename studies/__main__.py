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


STUDIES = {
    "demo": Study("a head lit from behind in Blender and POV-Ray: out/index.html", ("package", "blender", "povray")),
    "accuracy": Study("errors and times of the skin optics: docs/accuracy.md; three minutes"),
    "ear": Study("a back-lit ear by every table against random walk: docs/accuracy.md", ("package", "blender")),
    "ladder": Study("an ear by every method, error against run time: docs/accuracy.md", ("package", "blender")),
    "shape": Study("light through the shape against Monte Carlo: docs/shape.md", ("package", "blender")),
    "batch": Study("the example of docs/batch.md: frames x light rigs", ("package", "blender")),
    "panel": Study("the pictures of the panel in docs/blender.md", ("package",)),
    "povray": Study("the picture of docs/povray.md, by POV-Ray alone", ("povray",)),
    "turn": Study("a light carried round an ear: docs/images/round_the_ear.png", ("package", "blender")),
    "architecture": Study("docs/images/architecture.svg from the includes of the core", ()),
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
