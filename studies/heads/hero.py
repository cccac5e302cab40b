"""The demo's first picture, which `scripts/demo --quick` ends with."""

from __future__ import annotations

from pathlib import Path
from typing import Any

from studies.hosts import Host
from studies.progress import Progress, StudyError


def render(host: Host, head: dict[str, Any], out: Path, size: int, samples: int, progress: Progress) -> dict[str, Any]:
    """Renders out/hero.png and saves out/head.blend; returns what hero_job reports."""
    found = host.run("studies.heads.hero_job", {**head, "size": size, "samples": samples, "out": str(out)}, progress)
    if "error" in found:
        raise StudyError(found["error"])
    progress.say(f"the first picture is there: {out / 'hero.png'}")
    return found
