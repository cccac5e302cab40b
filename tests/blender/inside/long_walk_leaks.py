"""A long walk sees what an edit leaves behind."""

from pathlib import Path

import bpy

from inside.long_walk import LongWalk, begin

LEAK = "Skinglow leak"


def unused_image():
    bpy.data.images.new(LEAK, 1, 1)


def kept_image():
    unused_image()
    bpy.data.images[-1].use_fake_user = True


def kept_group():
    bpy.data.node_groups.new(LEAK, "ShaderNodeTree").use_fake_user = True


def check_a_leak_an_edit_is_seen(work):
    """Of what nothing uses, which the next load drops, and of what only a fake user keeps."""
    begin(Path(work), 20261127)
    for leak, told in (
        (unused_image, "12 of ours are unused after 12 edits"),
        (kept_image, LEAK),
        (kept_group, "no object uses"),
    ):
        walk = LongWalk(20261127, Path(work), False)
        for _ in range(12):
            leak()
            walk.done.append("leak")
        try:
            walk.save_and_load()
        except AssertionError as error:
            assert told in str(error), error
        else:
            raise AssertionError(f"{leak.__name__} was not seen")
        for kind in (bpy.data.images, bpy.data.node_groups):
            for one in [one for one in kind if one.name.startswith(LEAK)]:
                kind.remove(one)
    walk = LongWalk(20261127, Path(work), False)
    walk.save_and_load()
    return {"sizes": walk.sizes}
