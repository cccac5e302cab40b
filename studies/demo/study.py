"""The demo: an ear lit from behind, as soon as it can be there; then every mode, and POV-Ray beside Blender."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from studies import hosts, timing
from studies.demo import comparison, figures, light_rigs, page
from studies.heads import hero, sources
from studies.progress import Progress


def parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/demo",
        description="Lights a head from behind; in Blender and POV-Ray it glows in the color of the lights.",
        epilog="examples: scripts/demo --quick; scripts/demo scan.ply --up=Y --facing=-Z --unit 10",
    )
    parser.add_argument("mesh", nargs="?", help="GLB, OBJ or PLY file of a head (default: a CC0 person)")
    parser.add_argument(
        "--mesh", dest="named_mesh", metavar="FILE|suzanne", help="the same; `suzanne` is Blender's monkey"
    )
    parser.add_argument("--quick", action="store_true", help="the first picture alone")
    parser.add_argument("--unit", type=float, metavar="MM", help="millimeters per unit of the file (default: guessed)")
    axes = "+X, -X, +Y, -Y, +Z or -Z; write --{0}=-Z with the sign (default: by the format, or guessed)"
    parser.add_argument("--up", metavar="AXIS", help="of the file that points up: " + axes.format("up"))
    parser.add_argument(
        "--facing", metavar="AXIS", help="of the file along which the face looks: " + axes.format("facing")
    )
    parser.add_argument(
        "--ear", type=point, metavar="X,Y,Z", help="where the ear is, in the file (default: looked for)"
    )
    parser.add_argument("--rig", type=Path, metavar="FILE", help="light rig instead of Blender's rim.sl: .json or .sl")
    parser.add_argument(
        "--color-map", type=Path, metavar="FILE", help="base color texture of the skin, in the UVs of the mesh"
    )
    parser.add_argument(
        "--normal-map", type=Path, metavar="FILE", help="tangent-space normal map, in the UVs of the mesh"
    )
    parser.add_argument(
        "--blender",
        metavar="PROGRAM",
        help="Blender program or Python with bpy, instead of the default",
    )
    parser.add_argument(
        "--size",
        type=int,
        default=720,
        metavar="PIXELS",
        help="of the first picture (default 720); the others have two thirds",
    )
    parser.add_argument(
        "--samples",
        type=int,
        default=32,
        help="Cycles samples per pixel of the first picture, denoised (default 32); the others have a quarter",
    )
    parser.add_argument("--out", type=Path, default=Path("out"), help="output folder (default out/)")
    parser.add_argument(
        "--docs", action="store_true", help="the pictures of README and docs are then those of this run"
    )
    return parser.parse_args(arguments)


def point(text: str) -> tuple[float, float, float]:
    """Of "X,Y,Z"."""
    x, y, z = (float(number) for number in text.split(","))
    return x, y, z


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
