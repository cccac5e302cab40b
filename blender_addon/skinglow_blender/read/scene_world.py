# SPDX-License-Identifier: GPL-3.0-or-later
"""The world of an evaluated scene as `skinglow.Environment`. It lights skins in mode `physical` only."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import bpy
import numpy as np

from .. import blender_version
from ..errors import SkinError, core
from . import working_space
from .image_pixels import colorspace_note, image_of
from .world_image import environment_of_image
from .world_mapping import IDENTITY
from .world_nodes import Background, read_world_nodes

#: W/(m^2 sr). An Environment takes no more, and no picture tells it from what is brighter.
BRIGHTEST = 1e30


@dataclass(frozen=True)
class World:
    """The world of one scene reading. Its images are read when its light is first needed."""

    name: str
    backgrounds: tuple[Background, ...]
    unlit_reason: str  #: why it emits nothing, or ""
    unsupported: str  #: what in its nodes is not supported, or ""

    @cached_property
    def environment(self) -> Any:  # noqa: ANN401  skinglow.Environment
        """Its radiance as nine spherical-harmonic coefficients; dark if it is unlit or its images cannot be used."""
        total = np.zeros((9, 3))
        for background in self.backgrounds if not self.unlit_reason else ():
            try:
                total += _coefficients(background)
            except SkinError:
                continue
        return core().Environment(np.clip(total, -BRIGHTEST, BRIGHTEST))

    @cached_property
    def irradiance(self) -> tuple[float, float, float]:
        """Irradiance of a whole object, W/m^2: the mean over all surface orientations."""
        return tuple(float(e) for e in self.environment.mean_irradiance)

    @cached_property
    def note(self) -> str:
        """What is not supported, images included, or ""."""
        if self.unsupported or self.unlit_reason:
            return self.unsupported
        for background in self.backgrounds:
            if background.image:
                try:
                    environment_of_image(background.image, background.projection)
                except SkinError as error:
                    return str(error)
                image = image_of(background.image)
                if colorspace_note(image):
                    return colorspace_note(image)
        return ""


def read_world(depsgraph: bpy.types.Depsgraph) -> World | None:
    """Reads the world that lights a depsgraph's view layer; None if the scene has none."""
    layer = depsgraph.view_layer_eval
    world = blender_version.world_override(layer) or depsgraph.scene_eval.world
    if world is None:
        return None
    unlit_reason = ""
    if not layer.use_sky:
        unlit_reason = "the view layer excludes it (Filter, Environment)"
    elif not _visible_to_diffuse(world, depsgraph.mode):
        unlit_reason = "its ray visibility excludes diffuse rays"
    tree = blender_version.shader_tree(world)
    if tree is None:
        return World(world.name, (Background(tuple(world.color), "", "", IDENTITY),), unlit_reason, "")
    found = read_world_nodes(tree, blender_version.output_target(depsgraph.scene))
    return World(world.name, found.backgrounds, unlit_reason, found.note)


def _visible_to_diffuse(world: bpy.types.World, mode: str) -> bool:
    # A property of the Cycles add-on, which may be disabled. Blender 3.4 does not update it in the viewport's evaluated
    # copy.
    visibility = getattr(world.original if mode == "VIEWPORT" else world, "cycles_visibility", None)
    return visibility is None or visibility.diffuse


def _coefficients(background: Background) -> np.ndarray:
    sg = core()
    if not background.image:
        color = working_space.to_rec709(np.array(background.color))
        return sg.Environment((1.0, 1.0, 1.0)).coefficients * color
    environment = environment_of_image(background.image, background.projection)
    world_from_image = np.transpose(background.image_from_world)
    return environment.rotated(world_from_image).coefficients * background.color
