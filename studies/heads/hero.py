"""The demo's first picture, which `scripts/demo --quick` ends with."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from studies.heads import human_head
from studies.heads.human_head import HeadError
from studies.hosts import Host
from studies.progress import Progress, StudyError

OPTIONS = ("up", "facing", "unit_mm", "ear")


def head_job(mesh: str | None, progress: Progress, **options: Any) -> dict[str, Any]:  # noqa: ANN401
    """What is loaded: the person if `mesh` is None, "suzanne", or a file; options: OPTIONS, color_map, normal_map."""
    job = {"mesh": mesh or "person", **options}
    if mesh is None:
        progress.say(f"the head: {human_head.LICENSE}")
        try:
            job["folder"] = str(human_head.fetch(human_head.SHAPES, progress.say))
        except HeadError as error:
            raise StudyError(str(error)) from None
    elif mesh != "suzanne":
        path = Path(mesh).resolve()
        if not path.is_file():
            raise StudyError(f"{mesh}: no such file; give a GLB, OBJ or PLY mesh, or `--mesh suzanne`")
        job["mesh"] = str(path)
    return job


def render(host: Host, head: dict[str, Any], out: Path, size: int, samples: int, progress: Progress) -> dict[str, Any]:
    """Renders out/hero.png and saves out/head.blend; returns what hero_job reports."""
    found = host.run("studies.heads.hero_job", {**head, "size": size, "samples": samples, "out": str(out)}, progress)
    if "error" in found:
        raise StudyError(found["error"])
    progress.say(f"the first picture is there: {out / 'hero.png'}")
    return found
