"""The demo: an ear lit from behind, as soon as it can be there; then every mode, and POV-Ray beside Blender."""

from __future__ import annotations

import json
import time
from pathlib import Path

from studies import hosts, timing
from studies.demo import comparison, figures, light_rigs, page
from studies.demo.options import parsed
from studies.heads import hero, sources
from studies.progress import Progress


def main(arguments: list[str]) -> None:
    options = parsed(arguments)
    started = time.monotonic()
    out: Path = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    progress = Progress(out / "demo.log")

    head = sources.head_job(
        options.mesh or options.named_mesh,
        progress,
        up=options.up,
        facing=options.facing,
        unit_mm=options.unit,
        ear=options.ear,
        color_map=str(options.color_map.resolve()) if options.color_map else None,
        normal_map=str(options.normal_map.resolve()) if options.normal_map else None,
    )
    host = hosts.Host.find(options.blender)
    first = hero.render(host, head, out, options.size, options.samples, progress)
    if options.quick:
        progress.say(f"done: {timing.spent()}")
        return
    rigs = light_rigs.gather(options.rig, host, progress)
    size = 2 * options.size // 3
    job = {**first, "rigs": rigs, "size": size, "samples": max(options.samples // 4, 1), "out": str(out)}
    numbers = host.run("studies.demo.job", job, progress)
    numbers["head"] = {**sources.about(head["mesh"]), "unit_mm": first["unit_mm"]}
    numbers["hero"] = first
    numbers["comparison"] = comparison.render_and_compare(out, size, progress)
    progress.say("drawing the figures")
    figures.draw_all(out, numbers)
    numbers["seconds"] = round(time.monotonic() - started, 1)
    numbers["spent"] = timing.spent()
    (out / "numbers.json").write_text(json.dumps(numbers, indent=1))
    page.write(out, numbers)
    if options.docs:
        figures.to_docs(out)
    progress.say(f"done in {numbers['seconds']:.0f} s ({numbers['spent']}): open {out / 'index.html'}")
