# SPDX-License-Identifier: GPL-3.0-or-later
"""Digests of the inputs of a picture, by which a batch detects that it is up to date."""

from pathlib import Path
from typing import Any

import bpy

from .. import blender_version
from ..errors import core
from ..read.scene_lights import read_light
from ..skin_settings import SETTING_NAMES
from .digests import file_digests
from .files import input_files
from .manifest import data_digest
from .rigs import ReadyRig, light_objects

#: Settings that do not affect a picture, or that the batch itself sets.
NOT_IN_PICTURES = frozenset(
    "filepath threads threads_mode use_lock_interface use_persistent_data use_overwrite use_placeholder device".split()
)


def scene_inputs(scene: bpy.types.Scene, folder: Path | None = None) -> dict[str, str]:
    """Digests of the inputs of all pictures of a scene, which has to be at a fixed frame.

    folder  where digests of files are kept for other workers; None: nowhere

    files     the blend file as saved, its libraries and every file that it reads
    render    settings of rendering, color management and output, and the camera
    skins     the settings of every skin
    programs  versions, as text
    Unsaved changes to lights, cameras, settings and their animation are included; changed meshes and materials have to
    be saved first.
    """
    render = [_plain_values(owner) for owner in _render_settings(scene)]
    camera = scene.camera
    if camera is not None:
        render.append([camera.name_full, _numbers(camera.matrix_world), _animation(camera)])
        render.append([_plain_values(camera.data), _animation(camera.data)])
    skins = [
        [obj.name_full, obj.hide_render, _numbers(obj.matrix_world), skin_values(obj), _animation(obj)]
        for obj in scene.objects
        if obj.skinglow.enabled
    ]
    programs = f"Blender {bpy.app.version_string}, skinglow {core().__version__}"
    return {
        # Names only: the machines of a farm may see a folder under different paths.
        "files": data_digest(sorted((path.name, each) for path, each in file_digests(input_files(), folder).items())),
        "render": data_digest(render),
        "skins": data_digest(skins),
        "programs": programs,
    }


def rig_inputs(
    scene: bpy.types.Scene, ready: ReadyRig, onto: tuple[float, float, float] | None, folder: Path | None = None
) -> dict[str, str]:
    """Digests of the additional inputs of one rig: its lights, its file and the target point; folder: as above."""
    lights = [
        [
            read_light(obj, obj.matrix_world, obj.name, blender_version.output_target(scene)).signature,
            obj.visible_diffuse,
            _animation(obj),
            _animation(obj.data),
            obj.hide_render if ready.shown is None else None,
        ]
        for obj in sorted(light_objects(scene), key=lambda obj: obj.name)
        if ready.shown is None or obj.name_full in ready.shown
    ]
    file = file_digests([ready.rig.file], folder)[ready.rig.file] if ready.rig.file is not None else None
    return {"rig": data_digest([ready.shown, lights, file, onto if file else None])}


def skin_values(obj: bpy.types.Object) -> dict[str, Any]:
    """A skin's settings by name, as `make_skin` accepts them."""
    return {name: _plain(getattr(obj.skinglow, name)) for name in SETTING_NAMES}


def _render_settings(scene: bpy.types.Scene) -> list[Any]:
    owners = [scene.render, scene.render.image_settings, scene.view_settings, scene.display_settings]
    engine = engine_settings(scene)
    return owners if engine is None else [*owners, engine]


def engine_settings(scene: bpy.types.Scene) -> Any:  # noqa: ANN401
    """The scene's settings of its own render engine; None for engines other than Cycles and EEVEE."""
    engine = scene.render.engine
    name = "cycles" if engine == "CYCLES" else "eevee" if engine.startswith("BLENDER_EEVEE") else ""
    return getattr(scene, name, None)


def _plain_values(owner: Any) -> dict[str, Any]:  # noqa: ANN401
    """The settings of a Blender struct that are numbers, strings or data-blocks (by name)."""
    return {
        prop.identifier: _plain(getattr(owner, prop.identifier))
        for prop in owner.bl_rna.properties
        if prop.type not in ("COLLECTION",)
        and not (prop.type == "POINTER" and not isinstance(getattr(owner, prop.identifier), bpy.types.ID))
        and prop.identifier not in NOT_IN_PICTURES
        and not prop.is_readonly
    }


def _plain(value: Any) -> Any:  # noqa: ANN401
    if isinstance(value, bpy.types.ID):
        return value.name_full
    if isinstance(value, set):
        return sorted(value)
    if value is None or isinstance(value, bool | int | float | str):
        return value
    return list(value)


def _numbers(matrix: Any) -> list[float]:  # noqa: ANN401
    return [number for row in matrix for number in row]


def _animation(owner: bpy.types.ID) -> list[Any]:
    """The animation of a data-block: keyframes, and the expressions of drivers."""
    found = []
    for curve in blender_version.animation_curves(owner):
        driver = getattr(curve, "driver", None)
        expression = [driver.type, driver.expression] if driver is not None else None
        keys = [[*key.co, *key.handle_left, *key.handle_right, key.interpolation] for key in curve.keyframe_points]
        found.append([curve.data_path, curve.array_index, curve.mute, expression, keys])
    return found
