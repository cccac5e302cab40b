"""Runs inside Blender: the first picture, an ear lit from behind; the rest of the demo begins with its scene."""

from __future__ import annotations

import json
import time
from pathlib import Path
from typing import Any

import bpy
import skinglow_blender as sb

from studies.heads import loading, portrait, preview, studio
from studies.heads.human_head import HeadError
from studies.in_blender import MARK, Steps

#: Lookup and cells of the solution: for work, as the add-on's default.
CELL_MM = 0.8


def main(job: dict[str, Any]) -> dict[str, Any]:
    """job: of loading.load, and "size", "samples", "out". Returns {"error": in words} where the head cannot be used."""
    started = time.monotonic()
    out, step = Path(job["out"]), Steps(of=3)
    bpy.ops.wm.read_factory_settings(use_empty=True)
    scene = bpy.context.scene
    step("loading the head: a second or two")
    try:
        head, placed = loading.load(job)
    except HeadError as error:
        return {"error": str(error)}
    for sentence in placed.said:
        say(sentence)
    preview.draw(placed, out / "preview.png")
    if job["mesh"] not in ("person", "suzanne"):
        say(f"the wrong way round? see {out / 'preview.png'}, and end this with Ctrl-C")

    ear = studio.ear_of(placed)
    studio.settings(scene, job["size"], job["size"], job["samples"])
    studio.world(scene)
    studio.lights(scene, ear)
    scene.camera = studio.hero_camera(scene, ear)
    step(f"thickness at {len(head.data.vertices):,} vertices, and light through the shape: {_seconds(solving_s(head))}")
    make_skin(head)
    bpy.ops.wm.save_as_mainfile(filepath=str(out / "head.blend"))
    solved = time.monotonic()
    step(f"rendering {job['size']} x {job['size']} pixels: {_seconds(rendering_s(job['size'], job['samples']))}")
    scene.render.filepath = str(out / "hero.png")
    bpy.ops.render.render(write_still=True)
    ended = time.monotonic()
    return {
        "blender": job["host"],
        "vertices": len(head.data.vertices),
        "ear": {"center": ear.center.tolist(), "size": ear.size, "side": ear.side},
        "orientation": {"up": placed.orientation.up, "facing": placed.orientation.facing},
        "middle_x": placed.size.middle_x,
        "unit_mm": placed.unit_mm,
        "render_s_per_sample": (ended - solved) / (job["size"] ** 2 * job["samples"]),  # and pixel
        "seconds": {"solving": round(solved - started, 1), "rendering": round(ended - solved, 1)},
    }


def say(sentence: str) -> None:
    """To the terminal, not as a step."""
    print(MARK + json.dumps({"step": sentence, "done": None, "of": None}), flush=True)


def make_skin(head: bpy.types.Object) -> None:
    """As a user does who presses Make Skin Glow; of the person, without the mouth, the sockets and the cut."""
    sb.register()
    portrait.mask_glow(head)
    sb.make_skin(
        head, slots=loading.skin_slots(head), mode="physical", weights="shape", cell_mm=CELL_MM, unit_mm=1000.0
    )


def solving_s(head: bpy.types.Object) -> float:
    """What measuring, tiles and solving take about, on two cores with nothing else to do."""
    return 4.0 + len(head.data.vertices) / 5_000.0


def rendering_s(size: int, samples: int) -> float:
    return 3.0 + 1.6e-6 * size**2 * samples


def _seconds(about: float) -> str:
    return f"about {about:.0f} s on two cores with nothing else to do"
