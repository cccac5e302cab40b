"""The same in EEVEE, which draws in software here: seconds for each frame, so few frames."""

import bpy
import numpy as np
import skinglow_blender as sb

from inside.freeze import FIRST, moving_scene, pictures_of, render_without_add_on
from inside.scenes import render_settings

LAST = FIRST + 1


def check_frozen_as_live_in_eevee(work):
    for weights in ("object", "surface"):
        bpy.ops.wm.read_factory_settings(use_empty=True)
        bpy.context.scene.world = bpy.data.worlds.new("World")
        moving_scene(work, mode="physical", weights=weights)
        scene = render_settings(16, 16, "EEVEE")
        scene.frame_end = LAST
        scene.render.filepath = f"{work}/live_{weights}/####"
        bpy.ops.render.render(animation=True)
        live = pictures_of(work / f"live_{weights}", FIRST, LAST)
        assert live.max() > 0.05 and not np.array_equal(live[0], live[1])
        sb.freeze()
        frozen = render_without_add_on(work, f"without_{weights}", LAST)
        np.testing.assert_array_equal(frozen, live, err_msg=weights)
