"""Ten thousand updates leave nothing behind: no datablock, no memory."""

import gc
import os
from pathlib import Path

import bpy
import skinglow_blender as sb

from inside.scenes import add_light, black_material, depsgraph, patch

UPDATES = 10_000
#: MB by which a process may grow besides: allocators keep what they had.
ALLOWED_MB = 8.0


def datablocks():
    """How many there are of each kind."""
    collections = [p.identifier for p in bpy.data.bl_rna.properties if p.type == "COLLECTION"]
    return {name: len(getattr(bpy.data, name)) for name in collections}


def ours():
    """Datablocks that the add-on makes, of this file."""
    kinds = bpy.data.node_groups, bpy.data.images, bpy.data.materials, bpy.data.texts, bpy.data.meshes
    return [one for kind in kinds for one in kind if "Skinglow" in one.name and not one.library]


def unused():
    """How many of ours nothing uses: Blender keeps what lost its last user until the file is loaded anew."""
    return sum(not one.users for one in ours())


def require_used():
    """After a load: all of ours leads to an object that shows it, or to something that the next load drops."""
    users = bpy.data.user_map()
    uses = {}
    for one, by in users.items():
        for user in by:
            uses.setdefault(user, set()).add(one)
    # A load drops what has no user, and leaves what only that used for the next one.
    reached, ahead = set(), [one for one in users if isinstance(one, bpy.types.Object) or not one.users]
    while ahead:
        one = ahead.pop()
        if one not in reached:
            reached.add(one)
            ahead += uses.get(one, ())
    left = [one.name for one in ours() if one not in reached]
    assert not left, f"no object uses {left}"


def resident_mb():
    gc.collect()
    pages = int(Path("/proc/self/statm").read_text().split()[1])
    return pages * os.sysconf("SC_PAGE_SIZE") / 2**20


def check_ten_thousand_updates(_work):
    """Of a light's color and place, each seen by the handlers, each a new table."""
    add_light("Key")
    obj = patch(material=black_material())
    sb.make_skin(obj, thickness=[0.0, 1.0, 2.0, 3.0], mode="paper")
    depsgraph()
    layer, key = bpy.context.view_layer, bpy.data.objects["Key"]

    def change(count):
        shown = set()
        for i in range(count):
            key.data.color = (i % 97 / 97, i % 89 / 89, i % 83 / 83)
            key.location.x = i % 101 / 101
            layer.update()
            if i % 500 == 0:
                shown.add(sb.lut(obj, bpy.context.evaluated_depsgraph_get()).tobytes())
        return len(shown)

    # What is remembered of lights and tables is full by then, and grows no more.
    change(5000)
    before, memory = datablocks(), resident_mb()
    assert change(UPDATES) == UPDATES // 500
    assert datablocks() == before
    grown = resident_mb() - memory
    assert grown < ALLOWED_MB, grown
    return {"grown_mb": grown, "resident_mb": memory}
