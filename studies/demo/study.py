"""The demo: a head lit from behind, in Blender and POV-Ray."""

from __future__ import annotations

import argparse
import json
import time
from pathlib import Path

from studies import hosts
from studies.demo import comparison, figures, head_source, light_rigs, page
from studies.progress import Progress


def parsed(arguments: list[str]) -> argparse.Namespace:
    parser = argparse.ArgumentParser(
        prog="scripts/demo",
        description="Lights a head from behind; in Blender and POV-Ray it glows in the color of the lights.",
        epilog="example: scripts/demo LeePerrySmith.glb --unit 50.35",
    )
    parser.add_argument("mesh", nargs="?", help="GLB, OBJ or PLY file (default: MakeHuman's CC0 base mesh)")
    parser.add_argument(
        "--mesh", dest="named_mesh", metavar="FILE|suzanne", help="the same; `suzanne` is Blender's monkey"
    )
    parser.add_argument("--unit", type=float, metavar="MM", help="millimeters per unit of the file")
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
    parser.add_argument("--size", type=int, default=640, metavar="PIXELS", help="width and height (default 640)")
    parser.add_argument("--samples", type=int, default=64, help="Cycles samples per pixel (default 64)")
    parser.add_argument("--out", type=Path, default=Path("out"), help="output folder (default out/)")
    return parser.parse_args(arguments)


def main(arguments: list[str]) -> None:
    options = parsed(arguments)
    started = time.monotonic()
    out: Path = options.out.resolve()
    out.mkdir(parents=True, exist_ok=True)
    progress = Progress(out / "demo.log")

    head = head_source.find(options.mesh or options.named_mesh, options.unit, progress)
    host = hosts.Host.find(options.blender)
    rigs = light_rigs.gather(options.rig, host, progress)
    job = {
        **head.job(),
        "rigs": rigs,
        "color_map": str(options.color_map.resolve()) if options.color_map else None,
        "normal_map": str(options.normal_map.resolve()) if options.normal_map else None,
        "camera_azimuth_degrees": light_rigs.CAMERA_AZIMUTH_DEGREES,
        "size": options.size,
        "samples": options.samples,
        "out": str(out),
    }
    numbers = host.run("studies.demo.job", job, progress)
    numbers["head"] = {"name": head.name, "license": head.license, "unit_mm": head.unit_mm}
    numbers["comparison"] = comparison.render_and_compare(out, options.size, progress)
    progress.say("drawing the figures")
    figures.draw_all(out, numbers)
    numbers["seconds"] = round(time.monotonic() - started, 1)
    (out / "numbers.json").write_text(json.dumps(numbers, indent=1))
    page.write(out, numbers)
    progress.say(f"done in {numbers['seconds']:.0f} s: open {out / 'index.html'}")
