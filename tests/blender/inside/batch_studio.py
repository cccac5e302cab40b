"""A scene for batches, and what is compared before and after them."""

import json
from pathlib import Path

import bpy
import numpy as np
import skinglow_blender as sb

from inside.scenes import (
    BLOOD,
    add_light,
    black_material,
    camera_above,
    depsgraph,
    gray,
    patch,
    read_exr,
    render_settings,
)

DATA = Path(__file__).parents[2] / "data"
FRAMES = (1, 2, 3)
RIGS = ("warm", "cold")


def color_at(rig, frame):
    return np.array((1.0, 0.25 * frame, 0.0) if rig == "warm" else (0.0, 0.5, 0.3 * frame))


def studio():
    """A patch of no thickness, and a collection of one light for each rig, its color keyed on every frame."""
    for rig in RIGS:
        collection = bpy.data.collections.new(rig)
        bpy.context.scene.collection.children.link(collection)
        obj = add_light(f"{rig} lamp", location=(0.0, 0.0, 1.0), collection=collection)
        for frame in FRAMES:
            obj.data.color = color_at(rig, frame)
            obj.data.keyframe_insert("color", frame=frame)
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[0.0] * 4, mode="paper")
    camera_above()
    scene = render_settings(4, 4)
    scene.frame_start, scene.frame_end = FRAMES[0], FRAMES[-1]
    scene.frame_set(2)
    return scene, obj


def expected(*lights):
    """Eq. 1 to 3 at no thickness for lights of (color, distance)."""
    weight = BLOOD + sum(np.asarray(color, np.float32).astype(float) / (1.0 + d**2) for color, d in lights)
    return gray()[0] * weight


def shown_in(path):
    return read_exr(path)[2, 2]


def manifest_of(folder):
    return [json.loads(line) for path in sorted(folder.glob("*.jsonl")) for line in path.read_text().splitlines()]


def names(paths, folder):
    return sorted(path.relative_to(folder).as_posix() for path in paths)


def raises(text, function, *arguments, **named):
    try:
        function(*arguments, **named)
    except sb.SkinError as error:
        assert text in str(error), f"'{error}' does not say '{text}'"
        return str(error)
    raise AssertionError(f"nothing was refused; expected: {text}")


def everything():
    """What a batch may not change: settings of the scene, of every object and light, and which data there are."""
    scene = bpy.context.scene
    depsgraph()
    state = {
        "scene": (scene.frame_current, scene.frame_subframe, scene.render.filepath, scene.render.use_lock_interface),
        "objects": {
            o.name: (o.hide_render, o.hide_viewport, [list(row) for row in o.matrix_world], o.users)
            for o in bpy.data.objects
        },
        "collections": {c.name: (c.hide_render, len(c.objects)) for c in bpy.data.collections},
        "lights": {x.name: (list(x.color), x.energy) for x in bpy.data.lights},
        "curves": [c.mute for o in bpy.data.objects if o.animation_data for c in o.animation_data.drivers],
        "data": {kind: sorted(getattr(bpy.data, kind).keys()) for kind in ("meshes", "images", "materials", "worlds")},
        "handlers": {
            name: len(handlers)
            for name, handlers in ((n, getattr(bpy.app.handlers, n)) for n in dir(bpy.app.handlers))
            if isinstance(handlers, list)
        },
        "lut": {o.name: sb.lut(o, depsgraph()).tolist() for o in bpy.data.objects if o.skinglow.enabled},
    }
    state["data"]["images"] = [name for name in state["data"]["images"] if name != "Render Result"]
    return state


def assert_same(before):
    after = everything()
    for part, value in before.items():
        assert after[part] == value, f"{part}: {str(value)[:2000]} became {str(after[part])[:2000]}"
