"""Another add-on, of somebody who edits in handlers: a light follows the objects and the frame.

What it does is what add-ons do. Data is written in depsgraph and frame handlers, datablocks are made and removed there,
names and custom properties are set, and all is set up again after undo and loading. It writes only what differs.
"""

from types import SimpleNamespace

import bpy

NAME, MARK = "Follower", "follows"
#: fresh: since it was asked last; total: of this process.
EDITS = SimpleNamespace(fresh=0, total=0, busy=False)


def take_edits():
    """How many edits there were since this was called before."""
    fresh, EDITS.fresh = EDITS.fresh, 0
    return fresh


def note():
    EDITS.fresh += 1
    EDITS.total += 1


def write(owner, name, value):
    """Sets a property that differs."""
    now = getattr(owner, name)
    same = all(abs(a - b) < 1e-5 for a, b in zip(now, value, strict=True)) if hasattr(now, "__len__") else now == value
    if not same:
        setattr(owner, name, value)
        note()


def ensure(scene):
    """The light of a scene, made where there is none."""
    # By a property: names are edited.
    found = next((o for o in scene.collection.objects if o.type == "LIGHT" and MARK in o), None)
    if found is None:
        light = bpy.data.lights.new(NAME, "POINT")
        found = bpy.data.objects.new(f"{NAME} {scene.name}", light)
        found[MARK] = True
        scene.collection.objects.link(found)
        note()
    return found


def follow(scene, _depsgraph=None):
    """The light stands above the first skin, colored and as bright as the frame says."""
    if EDITS.busy or scene.library:
        return
    EDITS.busy = True
    try:
        skin = next((o for o in scene.objects if o.type == "MESH"), None)
        light = ensure(scene)
        if skin is not None and light.parent is None and not light.constraints and light.animation_data is None:
            write(light, "location", [a + b for a, b in zip(skin.location, (0.3, 0.1, 1.2), strict=True)])
            if skin.library is None and skin.get("followed") != light.name:
                skin["followed"] = light.name
                note()
        if light.data.animation_data is None:
            write(light.data, "energy", 5.0 * (1 + scene.frame_current % 4))
            write(light.data, "color", [1.0, 0.25 * (scene.frame_current % 4), 0.5])
    finally:
        EDITS.busy = False


def scratch(scene, _depsgraph=None):
    """A datablock for a moment, as exporters and calculations make them."""
    if EDITS.busy:
        return
    EDITS.busy = True
    try:
        mesh = bpy.data.meshes.new("Scratch")
        bpy.data.meshes.remove(mesh)
    finally:
        EDITS.busy = False


@bpy.app.handlers.persistent
def on_depsgraph(scene, depsgraph=None):
    follow(scene, depsgraph)
    scratch(scene)


@bpy.app.handlers.persistent
def on_frame(scene, depsgraph=None):
    follow(scene, depsgraph)


@bpy.app.handlers.persistent
def on_data(*_ignored):
    for scene in bpy.data.scenes:
        follow(scene)


HANDLERS = (
    ("depsgraph_update_post", on_depsgraph),
    ("frame_change_post", on_frame),
    ("undo_post", on_data),
    ("redo_post", on_data),
    ("load_post", on_data),
    ("save_pre", on_data),
)


def register():
    """Its handlers behind those that are there."""
    unregister()
    EDITS.fresh = EDITS.total = 0
    for name, handler in HANDLERS:
        getattr(bpy.app.handlers, name).append(handler)
    on_data()


def unregister():
    for name, handler in HANDLERS:
        handlers = getattr(bpy.app.handlers, name)
        if handler in handlers:
            handlers.remove(handler)
