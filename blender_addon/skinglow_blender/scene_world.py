# SPDX-License-Identifier: GPL-3.0-or-later
"""The world of an evaluated scene as `skinglow.Environment`. It lights skin of mode `physical` alone."""

from dataclasses import dataclass
from functools import cached_property
from typing import Any

import bpy
import numpy as np

from . import blender_version, working_space
from .errors import SkinError, core
from .image_pixels import colorspace_note
from .world_image import environment_of_image
from .world_mapping import IDENTITY
from .world_nodes import Background, follow_world


@dataclass(frozen=True)
class World:
    """The world as it shines at one look at a scene. Images are read when it is first asked what it gives."""

    name: str
    backgrounds: tuple[Background, ...]
    left_out: str  #: why it gives no light, or ""
    unfollowed: str  #: what of its nodes could not be taken over, or ""

    @cached_property
    def environment(self) -> Any:  # noqa: ANN401  skinglow.Environment
        """Its radiance as nine coefficients; dark where it is left out or its images cannot be used."""
        total = np.zeros((9, 3))
        for background in self.backgrounds if not self.left_out else ():
            try:
                total += _coefficients(background)
            except SkinError:
                continue
        return core().Environment(total)

    @cached_property
    def irradiance(self) -> tuple[float, float, float]:
        """What it brings to a whole object, W/m^2: the mean over all directions that a surface can face."""
        return tuple(float(e) for e in self.environment.mean_irradiance)

    @cached_property
    def note(self) -> str:
        """What could not be taken over, images included, or ""."""
        if self.unfollowed or self.left_out:
            return self.unfollowed
        for background in self.backgrounds:
            if background.image:
                try:
                    environment_of_image(background.image, background.projection)
                except SkinError as error:
                    return str(error)
                image = next(i for i in bpy.data.images if i.name_full == background.image)
                if colorspace_note(image):
                    return colorspace_note(image)
        return ""


def read_world(depsgraph: bpy.types.Depsgraph) -> World | None:
    """Reads the world that a depsgraph's view layer is lit by; None where the scene has none."""
    layer = depsgraph.view_layer_eval
    world = blender_version.world_override(layer) or depsgraph.scene_eval.world
    if world is None:
        return None
    left_out = ""
    if not layer.use_sky:
        left_out = "the view layer leaves it out (Filter, Environment)"
    elif not _visible_to_diffuse(world, depsgraph.mode):
        left_out = "its ray visibility leaves diffuse light out"
    tree = blender_version.shader_tree(world)
    if tree is None:
        return World(world.name, (Background(tuple(world.color), "", "", IDENTITY),), left_out, "")
    followed = follow_world(tree)
    return World(world.name, followed.backgrounds, left_out, followed.note)


def _visible_to_diffuse(world: bpy.types.World, mode: str) -> bool:
    # A property of the Cycles add-on, which may be off. Blender 3.4 does not bring it up to date in the viewport's
    # evaluated copy.
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
