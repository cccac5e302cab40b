"""What a random walk starts from, and what its file has to hold: apart from its edits."""

from functools import cache

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.show.lut_image import images_of, shown_image
from skinglow_blender.show.tile_image import TILES

from inside.scenes import add_light, black_material, depsgraph, fresh_physical_table, fresh_table, patch

THIN = [0.0, 1.0, 2.0, 3.0]
LIBRARY = "library.blend"


@cache
def light_skin(size):
    return sg.base_lut(sg.TISSUE_PRESETS["light"], size, 12.0)


def expected(obj, graph):
    settings = obj.skinglow
    if settings.mode == "EXISTING":
        return sg.six_gaussian_lookup(settings.size, 12.0).astype(np.float32)
    if settings.mode == "PHYSICAL":
        return fresh_physical_table(obj, graph, light_skin(settings.size))
    return fresh_table(obj, graph, settings.size)


def write_library(path):
    """A file with a skin and a light, from which they are appended and linked."""
    sb.make_skin(patch("Library skin", material=black_material("Library")), thickness=THIN, mode="paper")
    add_light("Library lamp", color=(0.2, 0.9, 0.4), location=(1.0, 1.0, 1.0))
    depsgraph()
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    bpy.ops.wm.read_factory_settings(use_empty=True)


def require_images_in_use():
    """No image is left that no node group has."""
    ours = {image for image in bpy.data.images if "Skinglow" in image.name and image.users and not image.library}
    groups = [tree for tree in bpy.data.node_groups if tree.name.startswith("Skinglow")]
    assert ours <= {i for group in groups for i in (shown_image(group), *images_of(group), *TILES.all_of(group))}, ours
