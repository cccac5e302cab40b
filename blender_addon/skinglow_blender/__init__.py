# SPDX-License-Identifier: GPL-3.0-or-later
"""Skinglow for Blender: skin that glows in the color of your lights, updated as they change.

As an add-on it is registered by Blender. From a script: `import skinglow_blender as sb` with the parent of this folder
on `sys.path`, then call the functions below. Each registers the add-on if necessary; call `sb.register()` if the skins
of a file only have to be kept up to date.
"""

from collections.abc import Callable
from functools import wraps
from typing import Any

import bpy

from . import batch, bundled_core, farm, preferences, scene_settings, skin_settings
from .batch import BatchResult, BatchStep, Rig, povray_comparison
from .batch.povray_comparison import PovrayComparison
from .commands import freezing, light_listing, povray_export, skin, thickness_map
from .commands import health as skin_health
from .commands.freezing import Frozen
from .commands.health import Fault
from .commands.povray_export import PovrayExport
from .commands.skin import SkinState
from .commands.thickness_map import BakedThickness
from .errors import SkinError
from .live import handlers
from .live.rebuilt import Rebuilt
from .script_arguments import check_of
from .show import image_pairs, material_settings, subsurface
from .ui import (
    farm_operators,
    freeze_operators,
    heat_map,
    light_list,
    main_panel,
    manual,
    material_operators,
    measuring_operators,
    menus,
    operators,
    povray_operators,
    presets,
    slot_choice,
    thickness_operators,
    thumbnails,
    waiting_operators,
)

bl_info = {
    "name": "Skinglow",
    "description": "Skin that glows in the color of your lights",
    "author": "Skinglow contributors",
    "version": (0, 1, 0),
    "blender": (3, 4, 0),
    "location": "3D View > Sidebar > Skinglow, and Object properties",
    "category": "Material",
}

__all__ = [
    "BakedThickness",
    "BatchResult",
    "BatchStep",
    "Fault",
    "Frozen",
    "PovrayComparison",
    "PovrayExport",
    "Rebuilt",
    "Rig",
    "SkinError",
    "SkinState",
    "bake_thickness",
    "batch_main",
    "compare_with_povray",
    "compare_with_povray_main",
    "export_povray",
    "farm",
    "freeze",
    "health",
    "light_report",
    "lut",
    "make_skin",
    "register",
    "remove_skin",
    "render_batch",
    "set_medium",
    "show_light_by",
    "state_of",
    "thickness_from_image",
    "unfreeze",
    "unregister",
    "update",
]

_PARTS = (
    bundled_core,
    skin_settings,
    image_pairs,
    scene_settings,
    preferences,
    material_settings,
    thumbnails,
    light_list,
    operators,
    povray_operators,
    material_operators,
    slot_choice,
    measuring_operators,
    freeze_operators,
    farm_operators,
    waiting_operators,
    thickness_operators,
    heat_map,
    presets,
    manual,
    main_panel,
    menus,
    handlers,
    *batch.COMMANDS,
)
_registered = False


def register() -> None:
    """Registers the add-on; a second call does nothing.

    Raises RuntimeError where another copy of it is on, as an extension beside a legacy add-on: both would answer each
    edit, and turning one off would take the settings of skins from the other.
    """
    global _registered
    if _registered:
        return
    if "skinglow" in bpy.types.Object.bl_rna.properties:
        raise RuntimeError("another copy of Skinglow is on: turn that off first, in Preferences > Add-ons")
    for part in _PARTS:
        part.register()
    _registered = True


def unregister() -> None:
    """Reverts `register`; skins in the file keep the lookups they show."""
    global _registered
    if not _registered:
        return
    for part in reversed(_PARTS):
        part.unregister()
    _registered = False


def _registering(function: Callable[..., Any]) -> Callable[..., Any]:
    check = check_of(function)

    @wraps(function)
    def call(*args: Any, **kwargs: Any) -> Any:  # noqa: ANN401
        register()
        check(args, kwargs)
        return function(*args, **kwargs)

    return call


make_skin = _registering(skin.make_skin)
update = _registering(skin.update)
lut = _registering(skin.lut)
light_report = _registering(light_listing.light_report)
health = _registering(skin_health.health)
export_povray = _registering(povray_export.export_povray)
freeze = _registering(freezing.freeze)
unfreeze = _registering(freezing.unfreeze)
bake_thickness = _registering(thickness_map.bake_thickness)
thickness_from_image = _registering(thickness_map.thickness_from_image)
remove_skin = _registering(skin.remove_skin)
set_medium = _registering(skin.set_medium)
state_of = _registering(skin.state_of)
show_light_by = _registering(subsurface.show_light_by)
render_batch = _registering(batch.render_batch)
batch_main = _registering(batch.COMMANDS[0].main)
farm.write_openjd = _registering(farm.write_openjd)
compare_with_povray = _registering(povray_comparison.compare_with_povray)
compare_with_povray_main = _registering(batch.COMMANDS[1].main)
