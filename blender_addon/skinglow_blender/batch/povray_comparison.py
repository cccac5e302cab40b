# SPDX-License-Identifier: GPL-3.0-or-later
"""Renders the light that comes through a skin by Blender and by POV-Ray, and compares the pictures (docs/povray.md)."""

import json
import os
import shutil
import sys
from collections.abc import Iterable, Iterator
from contextlib import ExitStack, contextmanager
from importlib.util import find_spec
from pathlib import Path
from typing import Any, NamedTuple

import bpy

from ..commands.povray_export import export_povray
from ..commands.povray_pictures import materials_of_skin
from ..commands.povray_run import povray_program, run_povray, run_program
from ..commands.skin import skin_settings_of
from ..errors import SkinError
from ..live.live_update import update_scene
from ..show.skin_material import skin_nodes
from .povray_report import write_report
from .rigs import Rig, light_objects, lit_by, make_ready

MODES = ("existing", "paper", "physical")
ALL_LIGHTS = "all lights"
#: The narrowest filter that Cycles takes, in pixels. Each pixel is one ray through its center, the same in both
#: programs: of glow in a line thinner than a pixel, several samples at positions of their own see different parts.
FILTER_WIDTH = 0.01


class PovrayComparison(NamedTuple):
    """What became of a comparison."""

    entries: tuple[dict[str, Any], ...]  #: one for each mode and light: numbers, pictures, or what went wrong
    report: Path  #: report.html; report.json is beside it
    notes: tuple[str, ...]  #: what could not be compared, and why


def compare_with_povray(
    obj: bpy.types.Object,
    directory: str | os.PathLike,
    modes: Iterable[str] = MODES,
    per_light: bool = True,
    scene: bpy.types.Scene | None = None,
) -> PovrayComparison:
    """Renders the light through a skin by Cycles and by POV-Ray, in each mode, under all lights and each alone.

    POV-Ray computes the lookup itself. Both programs have the scene's camera and one ray through the center of each
    pixel; the skin is lit per object, and everything else is hidden. Writes report.html and report.json, and for each
    comparison both pictures (linear EXR), the POV-Ray scene, and a PNG of both beside the heat map. Without POV-Ray, or
    without the program `skinglow`, which compares, all other files are written, and the notes say so. The scene is left
    as it was.
    """
    skin_settings_of(obj)
    unknown = set(modes := tuple(modes)) - set(MODES)
    if unknown:
        raise ValueError(f"compare_with_povray: modes = {sorted(unknown)} is not allowed: {', '.join(MODES)}")
    scene = scene or bpy.context.scene
    directory = Path(directory)
    try:
        directory.mkdir(parents=True, exist_ok=True)
    except OSError as error:
        raise SkinError(f"Cannot write to {directory}: {error.strerror or error}") from error
    tools = ((povray_program(), NO_POVRAY), (compare_program(), NO_COMPARE), (find_spec("flip_evaluator"), NO_FLIP))
    missing = [note for tool, note in tools if not tool]
    entries, notes = [], dict.fromkeys(missing)
    with _prepared(obj, scene):
        for mode in modes:
            obj.skinglow.mode = mode.upper()
            if mode == "physical":
                obj.skinglow.weights = "OBJECT"
            for name, rig in _rigs(scene, per_light and mode != "existing"):
                with lit_by(scene, make_ready(scene, rig), None), _world_only_with_all_lights(scene, rig):
                    folder = directory / f"{len(entries):02}_{mode}"
                    entry = {"mode": mode, "light": name, "folder": folder.name}
                    notes.update(dict.fromkeys(_compare(obj, scene, folder, entry)))
                    entries.append(entry)
    report = write_report(directory, obj.name, entries, list(notes))
    return PovrayComparison(tuple(entries), report, tuple(notes))


NO_POVRAY = "POV-Ray is not installed on this computer: its scenes are written and not rendered"
NO_COMPARE = (
    "The program 'skinglow', which compares pictures, is not on the PATH, nor does SKINGLOW_CLI say where it is: "
    "nothing is measured"
)
NO_FLIP = "The Python package 'flip-evaluator' is not installed: what a person sees of the differences is not measured"
#: In a process of its own: it ends the process where it finds no exposure. These are as the picture is, and brighter.
FLIP = """import sys, flip_evaluator
exposures = {"startExposure": 0.0, "stopExposure": 4.0, "numExposures": 3}
print(flip_evaluator.evaluate(*sys.argv[1:], "HDR", applyMagma=False, parameters=exposures)[1])"""


def compare_program() -> str | None:
    """Path of the command line `skinglow`; None if it is not installed."""
    return os.environ.get("SKINGLOW_CLI") or shutil.which("skinglow")


def _rigs(scene: bpy.types.Scene, per_light: bool) -> list[tuple[str, Rig]]:
    rigs = [(ALL_LIGHTS, Rig("scene"))]
    names = [obj.name for obj in light_objects(scene) if not obj.hide_render]
    if per_light and len(names) > 1:
        rigs += [(name, Rig(name, (name,))) for name in names]
    return rigs


def _compare(obj: bpy.types.Object, scene: bpy.types.Scene, folder: Path, entry: dict[str, Any]) -> list[str]:
    """Makes both pictures and puts what differs into the entry; what could not be done."""
    folder.mkdir(exist_ok=True)
    graph = bpy.context.evaluated_depsgraph_get()
    update_scene(graph)
    files = export_povray(graph, folder / "povray", obj, surface=False, compute_lut=True)
    scene.render.filepath = str(folder / "blender.exr")
    bpy.ops.render.render(write_still=True, scene=scene.name)
    if povray_program() is None:
        return files.notes
    try:
        run_povray(folder / "povray", "+UA", "-A", "+O../povray.exr")
        if compare_program() is not None:
            entry.update(_measured(folder))
    except SkinError as error:
        entry["error"] = str(error)
    return files.notes


def _measured(folder: Path) -> dict[str, Any]:
    pictures = ["blender.exr", "povray.exr", "--ignore-edges", "--ignore-background"]
    shown = ["--side-by-side", "side_by_side.png", "--heatmap", "difference.png"]
    command = [compare_program(), "compare", *pictures, *shown, "--json"]
    done = run_program(command, folder)
    if not done.succeeded:
        raise SkinError(done.errors.strip() or "skinglow compare failed without a word")
    found = json.loads(done.output)
    covered = found["width"] * found["height"] - found["background_pixels"]
    left_out = 1.0 - found["compared_pixels"] / covered
    return found | {"left_out_fraction": left_out, "flip": _perceived(folder)}


def _perceived(folder: Path) -> float | None:
    """NVIDIA's HDR-FLIP, what a person sees of the difference, 0 to 1: mean over the pixels; None if not computed."""
    package = find_spec("flip_evaluator")
    if package is None or package.origin is None:
        return None
    home = str(Path(package.origin).parents[1])
    command = [sys.executable, "-c", FLIP, "blender.exr", "povray.exr"]
    paths = os.pathsep.join(filter(None, (home, os.environ.get("PYTHONPATH"))))
    environment = {**os.environ, "PYTHONPATH": paths}
    done = run_program(command, folder, environment)
    words = done.output.split()
    return float(words[-1]) if done.succeeded and words and words[-1][0].isdigit() else None


@contextmanager
def _prepared(obj: bpy.types.Object, scene: bpy.types.Scene) -> Iterator[None]:
    """Context manager in which renders show the light that comes through this skin, and nothing else."""
    with ExitStack() as undo:

        def put(owner: Any, name: str, value: Any) -> None:  # noqa: ANN401
            undo.callback(setattr, owner, name, getattr(owner, name))
            setattr(owner, name, value)

        for other in scene.objects:
            if other.type not in ("LIGHT", "CAMERA", "EMPTY") and other != obj and not other.hide_render:
                put(other, "hide_render", True)
        for name in ("mode", "weights"):
            undo.callback(setattr, obj.skinglow, name, getattr(obj.skinglow, name))
        for node in (node for material in materials_of_skin(obj) for node in skin_nodes(material)):
            tree, socket = node.id_data, node.inputs["Surface"]
            if socket.is_linked:
                source = socket.links[0].from_socket
                tree.links.remove(socket.links[0])
                undo.callback(tree.links.new, source, socket)
        render, cycles, image = scene.render, scene.cycles, scene.render.image_settings
        for owner, settings in (
            (render, {"engine": "CYCLES", "film_transparent": True, "filepath": "", "use_motion_blur": False}),
            (
                render,
                {"use_compositing": False, "use_sequencer": False, "use_border": False, "use_file_extension": True},
            ),
            (cycles, {"samples": 1, "use_adaptive_sampling": False, "use_denoising": False}),
            (cycles, {"pixel_filter_type": "BOX", "filter_width": FILTER_WIDTH}),
            (image, {"file_format": "OPEN_EXR", "color_depth": "32", "color_mode": "RGBA"}),
        ):
            for name, value in settings.items():
                put(owner, name, value)
        if scene.camera is not None and scene.camera.type == "CAMERA":
            put(scene.camera.data.dof, "use_dof", False)
        yield


@contextmanager
def _world_only_with_all_lights(scene: bpy.types.Scene, rig: Rig) -> Iterator[None]:
    world = scene.world
    if rig.lights is not None:
        scene.world = None
    try:
        yield
    finally:
        scene.world = world
