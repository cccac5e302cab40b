"""Runs in Blender: writes the same thing again and again, in two versions by turns, until it is killed.

Arguments: KIND FOLDER [one]. With `one` it writes each version once, to FOLDER/0 and FOLDER/1, and ends.
KIND is save, bake, freeze, batch or export; or open, which opens all blend files of FOLDER and looks at what they show.
"""

import itertools
import os
import sys
from pathlib import Path

HERE = Path(__file__).parent
sys.path[:0] = [str(HERE), str(HERE.parents[1] / "blender_addon")]
if os.environ.get("SKINGLOW_SITE"):
    sys.path.append(os.environ["SKINGLOW_SITE"])

import bpy  # noqa: E402
import numpy as np  # noqa: E402
import skinglow_blender as sb  # noqa: E402
from inside.scenes import (  # noqa: E402
    add_light,
    black_material,
    camera_above,
    depsgraph,
    fresh_table,
    patch,
    render_settings,
)
from process_end import run_and_exit  # noqa: E402
from skinglow_blender.show.lut_image import shown_image  # noqa: E402

#: Of the light, by version.
COLORS = ((1.0, 0.2, 0.1), (0.1, 0.3, 1.0))
FRAMES = 3


def scene():
    """A skin with a map, a light and a camera."""
    obj = patch("Patch", material=black_material())
    layer = obj.data.uv_layers.new(name="UV")
    for loop, uv in zip(layer.data, ((0, 0), (1, 0), (1, 1), (0, 1)), strict=True):
        loop.uv = uv
    add_light("Lamp", location=(0.3, 0.2, 1.0))
    camera_above()
    render_settings(8, 8)
    for name in ("date", "time", "render_time", "filename", "memory", "hostname"):
        setattr(bpy.context.scene.render, f"use_stamp_{name}", False)
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    return obj


def set_version(obj, version):
    """Another color of the light, another position of the camera, another thickness: each file differs."""
    bpy.data.lights["Lamp"].color = COLORS[version]
    bpy.context.scene.camera.location.x = 0.1 * version
    bpy.data.objects["Lamp"].location.x = 0.3 + version
    if "bake" in sys.argv:
        sb.make_skin(obj, thickness=[1.0 + version] * 4, mode="paper")
    depsgraph()


def save(_obj, folder):
    bpy.ops.wm.save_as_mainfile(filepath=str(folder / "scene.blend"))


def bake(obj, folder):
    sb.bake_thickness(obj, folder / "thickness.png", 64, "PNG_16", 8.0)


def freeze(obj, folder):
    sb.freeze([obj], 1, FRAMES, folder)
    sb.unfreeze([obj])


def batch(_obj, folder):
    sb.render_batch(folder / "pictures", range(1, FRAMES + 1), resume=False)


def export(obj, folder):
    sb.export_povray(depsgraph(), folder / "scene", obj)


WRITERS = {"save": save, "bake": bake, "freeze": freeze, "batch": batch, "export": export}


def open_all(folder):
    """The light that a file shows when it is opened, before any update, is that of its own lights."""
    paths = sorted(folder.glob("*.blend"))
    for path in paths:
        bpy.ops.wm.open_mainfile(filepath=str(path))
        obj = bpy.data.objects["Patch"]
        color = [round(x, 3) for x in bpy.data.lights["Lamp"].color]
        assert color in [[round(x, 3) for x in each] for each in COLORS], color
        image = shown_image(obj.skinglow.group)
        assert image is not None and image.has_data, path
        np.testing.assert_allclose(
            sb.lut(obj, depsgraph()), fresh_table(obj, depsgraph()), rtol=3e-6, err_msg=str(path)
        )
    print(f"{len(paths)} files are whole", flush=True)


def main() -> None:
    kind, folder, *one = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    folder = Path(folder)
    if kind == "open":
        sb.register()
        open_all(folder)
        return
    write = WRITERS[kind]
    bpy.ops.wm.read_factory_settings(use_empty=True)
    obj = scene()
    if one:
        for version in (0, 1):
            (folder / str(version)).mkdir(parents=True)
            set_version(obj, version)
            write(obj, folder / str(version))
        return
    for version in itertools.cycle((0, 1)):
        set_version(obj, version)
        write(obj, folder)
        print("written", flush=True)


run_and_exit(main)
