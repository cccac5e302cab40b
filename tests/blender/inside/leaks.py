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
