"""Updates of a window and of a render, which are two threads, take turns."""

import threading

import numpy as np
import skinglow_blender as sb
from skinglow_blender.live.live_update import TURN
from skinglow_blender.session import SESSION

from inside.scenes import add_light, black_material, depsgraph, paper_table, patch

sb.register()


def check_a_window_s_update_comes_after_that_of_a_render(_work):
    """Both at once took each other's lights: frame 2 of an animation was seen with the light of the view's frame 1."""
    key = add_light("Key")
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[0.0, 1.0, 2.0, 3.0], mode="paper")
    before, updates = sb.lut(obj, depsgraph()), SESSION.updates
    has_turn, may_end = threading.Event(), threading.Event()

    def render():
        with TURN:
            has_turn.set()
            may_end.wait(60.0)

    thread = threading.Thread(target=render)
    thread.start()
    SESSION.rendering = True
    try:
        assert has_turn.wait(60.0)
        key.data.color = (1.0, 0.0, 0.0)
        depsgraph()
        assert SESSION.updates == updates
        np.testing.assert_array_equal(sb.lut(obj, depsgraph()), before)
    finally:
        may_end.set()
        thread.join()
        SESSION.rendering = False
    sb.update(depsgraph())
    np.testing.assert_allclose(sb.lut(obj, depsgraph()), paper_table([key]), rtol=1e-6)
