"""Which head a study loads: what loading.load is asked for, and whose head it is."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from studies.heads import human_head
from studies.heads.human_head import HeadError
from studies.paths import SCAN
from studies.progress import Progress, StudyError

PERSON, MAKEHUMAN, SUZANNE = "person", "makehuman", "suzanne"
LICENSES = {
    PERSON: human_head.LICENSE,
    MAKEHUMAN: human_head.LICENSE,
    SUZANNE: "Blender's monkey, CC0",
    SCAN.name: "Infinite, 3D Head Scan by Lee Perry-Smith (www.triplegangers.com), CC BY 3.0",
}
NAMES = {PERSON: "MakeHuman", MAKEHUMAN: "MakeHuman", SUZANNE: "Suzanne"}


def head_job(mesh: str | None, progress: Progress, **options: Any) -> dict[str, Any]:  # noqa: ANN401
    """What is loaded: the person if `mesh` is None, "makehuman" (its base mesh), "suzanne", or a file.

    options  as loading.load describes: up, facing, unit_mm, ear, color_map, normal_map
    Raises StudyError, with the remedy, where there is no such head.
    """
    job = {"mesh": mesh or PERSON, **options}
    if job["mesh"] in (PERSON, MAKEHUMAN):
        progress.say(f"the head: {human_head.LICENSE}")
        try:
            job["folder"] = str(human_head.fetch(human_head.SHAPES, progress.say))
        except HeadError as error:
            raise StudyError(str(error)) from None
    elif mesh != SUZANNE:
        path = Path(mesh).resolve()
        if not path.is_file():
            raise StudyError(f"{mesh}: no such file; give a GLB, OBJ, PLY or STL mesh, or `--mesh suzanne`")
        job["mesh"] = str(path)
    return job


def about(mesh: str) -> dict[str, str]:
    """ "name" and "license" of the head of a job, by its "mesh"."""
    file = Path(mesh)
    return {
        "name": NAMES.get(mesh, file.stem),
        "license": LICENSES.get(mesh) or LICENSES.get(file.name, "license of its owner"),
    }
