# SPDX-License-Identifier: GPL-3.0-or-later
"""Exports the scene to POV-Ray for comparison: same camera, mesh, lights and lookup. The core writes the text."""

import os
from collections.abc import Sequence
from itertools import chain, count
from pathlib import Path
from typing import NamedTuple

import bpy
import numpy as np

from ..errors import SkinError, core
from ..read import working_space
from ..read.scene_lights import make_light
from ..read.scene_reading import SceneReading, Skin, read_scene
from ..table.skin_tables import base_lut, compute_table, lights_of, world_irradiance
from .povray_pictures import pictures_of
from .povray_scene import camera_arguments, mesh_arguments, tiles_of, transforms_of
from .povray_writing import SceneFiles, float_image, staged

LUT_FILE, TILES_FILE = "lut.exr", "tiles.exr"
#: Names that some file systems keep for devices.
DEVICES = {"con", "prn", "aux", "nul", *(f"{kind}{i}" for kind in ("com", "lpt") for i in range(1, 10))}
#: Bytes that a folder's name may have, with room for a number.
LONGEST_NAME = 200


class PovrayExport(list[Path]):
    """The files that an export wrote."""

    notes: list[str]  #: what of the scene is not in them

    def __init__(self, files: Sequence[Path], notes: Sequence[str]) -> None:
        super().__init__(files)
        self.notes = list(notes)


class _What(NamedTuple):
    surface: bool
    compute_lut: bool
    frames: tuple[int, int] | None


def export_povray(
    depsgraph: bpy.types.Depsgraph,
    directory: str | os.PathLike,
    obj: bpy.types.Object | None = None,
    surface: bool = True,
    compute_lut: bool = False,
    frames: tuple[int, int] | None = None,
) -> PovrayExport:
    """Writes a POV-Ray 3.7 scene of a skin; `povray scene.ini` in the folder renders it. Returns the files written.

    obj          the skin; None: every skin of the depsgraph, each in its own folder if there are several
    surface      False: only the transmitted light, without lights
    compute_lut  True: POV-Ray computes the lookup itself, from the lights; False: it reads the EXR
    frames       first and last frame of an animation; None: the current frame alone
    Only what the scene uses is written, as a whole or not at all; `notes` of the result tell what is not exported.
    Raises SkinError if there is no camera or skin, or if writing fails.
    """
    what = _What(surface, compute_lut, _checked(frames))
    directory = Path(directory)
    reading = read_scene(depsgraph)
    chosen = _chosen(reading, obj)
    if depsgraph.scene.camera is None:
        raise SkinError("The scene has no camera: POV-Ray needs one")
    names = folder_names([skin.name for _original, skin in chosen])
    scene, notes = depsgraph.scene.original, {}
    with staged(directory) as stage:
        folders = [stage if len(chosen) == 1 else stage / name for name in names]
        files = [SceneFiles(folder, animated=frames is not None) for folder in folders]
        before = scene.frame_current, scene.frame_subframe
        try:
            for frame in range(what.frames[0], what.frames[1] + 1) if what.frames else (scene.frame_current,):
                if what.frames:
                    scene.frame_set(frame)
                    reading = read_scene(depsgraph)
                for (original, _skin), scene_files in zip(chosen, files, strict=True):
                    skin = _chosen(reading, original)[0][1]
                    notes.update(
                        dict.fromkeys(_write_frame(depsgraph, reading, original, skin, scene_files, what, frame))
                    )
        finally:
            if what.frames:
                scene.frame_set(before[0], subframe=before[1])
        for scene_files in files:
            scene_files.finish()
        written = [path.relative_to(stage) for path in sorted(stage.rglob("*")) if path.is_file()]
    return PovrayExport([directory / path for path in written], list(notes))


def _checked(frames: tuple[int, int] | None) -> tuple[int, int] | None:
    if frames is not None and not 0 <= frames[0] <= frames[1]:
        raise SkinError(f"Frames {frames[0]} to {frames[1]} cannot be exported: POV-Ray counts from 0 upward")
    return frames


def _chosen(reading: SceneReading, obj: bpy.types.Object | None) -> list[tuple[bpy.types.Object, Skin]]:
    found = [each for each in reading.skins if obj is None or each[0] == obj.original]
    if not found:
        what = "no skin" if obj is None else f"no skin '{obj.name}'"
        raise SkinError(f"There is {what} to export in this view layer: make one first, and unhide it")
    return found


def folder_names(names: list[str]) -> list[str]:
    """A folder's name for each skin: objects of different libraries, or "a b" and "a_b", may have the same one."""
    found: list[str] = []
    taken: set[str] = set()
    for name in map(_folder_name, names):
        # Without regard to case: some file systems have none.
        free = next(n for n in chain((name,), (f"{name}_{i}" for i in count(2))) if n.casefold() not in taken)
        taken.add(free.casefold())
        found.append(free)
    return found


def _folder_name(name: str) -> str:
    """A name that every file system takes."""
    clean = bpy.path.clean_name(name).strip(" .") or "_"
    clean = clean.encode()[:LONGEST_NAME].decode(errors="ignore")
    return f"{clean}_" if clean.partition(".")[0].casefold() in DEVICES else clean


def _write_frame(
    depsgraph: bpy.types.Depsgraph,
    reading: SceneReading,
    original: bpy.types.Object,
    skin: Skin,
    files: SceneFiles,
    what: _What,
    frame: int,
) -> list[str]:
    """Writes a skin's files of one frame; what is not in them."""
    obj = original.evaluated_get(depsgraph)
    base = base_lut(skin.base)
    tiles = None if what.compute_lut else tiles_of(original, depsgraph)
    table = None if what.compute_lut or tiles is not None else compute_table(skin, reading.lights, reading.world)
    varies = table is not None and table.lighting is not None
    by_thickness = tiles is None
    pictures = pictures_of(obj, skin, files, frame, surface=what.surface, by_thickness=by_thickness, varies=varies)
    notes = list(pictures.notes)
    transforms = transforms_of(depsgraph, original)
    arguments, tiles = mesh_arguments(obj, skin, base, tiles, transforms, table, pictures)
    arguments |= camera_arguments(depsgraph) | pictures.arguments
    # The macros alone look up a picture of thickness.
    computed = what.compute_lut or "thickness_image" in arguments
    if depsgraph.scene.camera.data.dof.use_dof:
        notes.append("Depth of field is not exported")
    if depsgraph.scene.render.use_border:
        notes.append("The render region is not exported: POV-Ray renders the whole picture")
    lights = [make_light(light) for light in lights_of(skin, reading.lights)]
    if what.surface and any(light.kind == "AREA" and light.spread < np.pi for light in lights):
        notes.append(
            "The spread of an area light is a cone in POV-Ray: light on the surface is up to 15 % of the brightest off"
        )
    if skin.mode == "PHYSICAL" and skin.weights != "OBJECT" and tiles is None:
        notes.append(f"'{skin.name}': its light varies over the surface in Blender; POV-Ray shows it per object")
    if varies and len(transforms) > 1:
        notes.append(f"'{skin.name}': its instances show the light of the first")
    if tiles is not None:
        # With a dark row for all that shows no light.
        light = np.pad(working_space.to_rec709(tiles[:, :, :3]), ((0, 1), (0, 0), (0, 0)))
        arguments["image"] = files.write(TILES_FILE, float_image(light, files.folder), frame)
    elif not computed:
        arguments["image"] = files.write(LUT_FILE, float_image(table.colors[None], files.folder), frame)
    if what.frames:
        render = depsgraph.scene.render
        arguments["frames"] = (*what.frames, render.fps / render.fps_base)
    texts = core().povray_files(
        mode=skin.mode.lower(),
        base=base if skin.mode == "PAPER" or (computed and skin.mode == "PHYSICAL") else None,
        size=base.size,
        max_thickness_mm=base.max_thickness_mm,
        lights=lights,
        point=skin.point,
        coefficients=skin.attenuation,
        blood_weight=skin.blood_weight,
        world_irradiance=world_irradiance(reading.world),
        strength=skin.strength,
        name=skin.name,
        **arguments,
    )
    for name, text in texts.items():
        files.write(name, text.encode(), frame)
    return notes
