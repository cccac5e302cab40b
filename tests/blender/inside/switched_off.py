"""Files that are saved and rendered where the add-on is off; and color management without Blender's own names."""

import importlib
import os
import shutil
import subprocess
import sys
from pathlib import Path

import bpy
import numpy as np
import skinglow as sg
import skinglow_blender as sb

from inside.scenes import add_light, assert_fresh, black_material, camera_above, patch, read_exr, render_settings

RENDER = """
import bpy, os
bpy.ops.wm.open_mainfile(filepath={file!r})
bpy.context.scene.render.filepath = {picture!r}
bpy.ops.render.render(write_still=True)
os._exit(0)
"""


def python_command(work, code):
    """A Blender of this version, without the add-on, that runs the code."""
    script = work / "script.py"
    script.write_text(code)
    program = bpy.app.binary_path
    if program and not os.path.basename(program).startswith("python"):
        return [program, "-b", "--factory-startup", "-P", str(script)]
    return [sys.executable, str(script)]


def check_saved_while_off(work):
    add_light(color=(1.0, 0.5, 0.2))
    sb.make_skin(patch(material=black_material()), thickness=[1.0, 2.0, 3.0, 4.0], mode="paper")
    camera_above()
    scene = render_settings()
    scene.render.filepath = str(work / "on.exr")
    bpy.ops.render.render(write_still=True)
    sb.unregister()
    try:
        bpy.ops.wm.save_as_mainfile(filepath=str(work / "off.blend"))
    finally:
        sb.register()
    code = RENDER.format(file=str(work / "off.blend"), picture=str(work / "off.exr"))
    subprocess.run(python_command(work, code), check=True, capture_output=True, timeout=120)
    expected = read_exr(work / "on.exr")
    assert expected.max() > 0.01
    np.testing.assert_array_equal(read_exr(work / "off.exr"), expected)


CONFIG = """ocio_profile_version: 1
roles: {scene_linear: Linear, %s default: sRGB, color_picking: sRGB, texture_paint: sRGB, matte_paint: sRGB,
        color_timing: sRGB, compositing_log: Linear, rendering: Linear, reference: Linear, byte_default: sRGB,
        default_byte: sRGB, default_float: Linear, default_sequencer: sRGB, aces_interchange: Linear,
        cie_xyz_d65_interchange: Linear, XYZ: Linear}
displays:
  sRGB:
    - !<View> {name: Standard, colorspace: sRGB}
    - !<View> {name: Raw, colorspace: Plain}
active_displays: [sRGB]
active_views: [Standard, Raw]
colorspaces:
  - !<ColorSpace> {name: Linear, family: linear, bitdepth: 32f, isdata: false}
  - !<ColorSpace>
    name: sRGB
    family: display
    bitdepth: 32f
    isdata: false
    to_reference: !<ExponentTransform> {value: [2.2, 2.2, 2.2, 1]}
  - !<ColorSpace> {name: Plain, family: data, bitdepth: 32f, isdata: %s}
"""
MAKE = """
import os, sys
sys.path += {folders!r}
import bpy, skinglow_blender as sb
bpy.ops.wm.read_factory_settings(use_empty=True)
mesh = bpy.data.meshes.new("Patch")
mesh.from_pydata([(-1, -1, 0), (1, -1, 0), (1, 1, 0), (-1, 1, 0)], [], [(0, 1, 2, 3)])
obj = bpy.data.objects.new("Patch", mesh)
bpy.context.scene.collection.objects.link(obj)
try:
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    print("RESULT skin", {{image.colorspace_settings.name for image in bpy.data.images}})
except sb.SkinError as error:
    print("RESULT", error, len(bpy.data.images))
sys.stdout.flush()
os._exit(0)
"""


def check_a_second_copy_is_refused(work):
    """As an extension and a legacy add-on, both turned on."""
    add_light()
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[1.0] * 4, mode="paper")
    shutil.copytree(Path(sb.__file__).parent, work / "skinglow_copy")
    sys.path.insert(0, str(work))
    try:
        other = importlib.import_module("skinglow_copy")
        handlers = len(bpy.app.handlers.depsgraph_update_post)
        try:
            other.register()
        except RuntimeError as error:
            assert "another copy of Skinglow is on" in str(error)
        else:
            raise AssertionError("a second copy was registered")
        other.unregister()
        assert len(bpy.app.handlers.depsgraph_update_post) == handlers
        assert_fresh(obj)
        sb.unregister()
        other.register()
        other.unregister()
        sb.register()
        assert_fresh(obj)
    finally:
        sys.path.remove(str(work))


def made_with_config(work, *, has_data):
    config = work / "config.ocio"
    config.write_text(CONFIG % (("data: Plain,", "true") if has_data else ("", "false")))
    # Where the add-on and, for the full program, the core are.
    folders = [str(Path(module.__file__).parents[1]) for module in (sb, sg)]
    command = python_command(work, MAKE.format(folders=folders))
    environment = {**os.environ, "OCIO": str(config)}
    run = subprocess.run(command, check=True, capture_output=True, text=True, timeout=120, env=environment)
    (line,) = (line for line in run.stdout.splitlines() if line.startswith("RESULT"))
    return line


def check_color_management_of_other_names(work):
    """The space for data may have any name; without one the skin is refused, and nothing is left behind."""
    assert made_with_config(work, has_data=True) == "RESULT skin {'Plain'}"
    if bpy.app.version >= (5, 2, 0):
        return  # reports another space as data where the configuration names none
    refused = made_with_config(work, has_data=False)
    assert "no color space for data" in refused and refused.endswith(" 0"), refused
