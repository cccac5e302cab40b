"""A random walk of any length in one file: each process takes some steps, saves, and the next one goes on from there.

`scripts/test --edits STEPS` runs as many such parts as it takes; the check here is two short ones, the second beside
another add-on that edits in its handlers. Every edit and what is compared after it are those of random_walk.py.
"""

import faulthandler
import json
import os
from pathlib import Path

import bpy
import skinglow_blender as sb

from inside import second_addon
from inside.leaks import datablocks, require_used, resident_mb, unused
from inside.random_walk import Walk, begin_walk
from inside.scenes import depsgraph
from inside.walk_files import LIBRARY, require_images_in_use, write_library

#: What a walk goes on from: written last, so that it always names a complete file.
STATE = "state.json"
LOG = "parts.jsonl"
#: Datablocks of ours that nothing uses before a load: none was seen in 700 edits. An edit of any of the fifty
#: kinds that leaves one whenever it is made goes beyond.
UNUSED_AT_MOST, UNUSED_PER_EDIT = 1, 0.02


class LongWalk(Walk):
    """Remembers how large the process was, and what the file held, each time it was loaded anew."""

    def __init__(self, seed, folder, beside):
        super().__init__(seed, folder)
        self.beside = beside
        if beside:  # its handlers make datablocks, over which Blender crashes in undo
            self.in_a_window = 0.0
        self.sizes = []
        self.steps_at_load = 0

    def settle(self):
        """Lets Blender evaluate what the other add-on edited in its handlers, until that edits nothing more."""
        graph = depsgraph()
        while self.beside and second_addon.take_edits():
            graph = depsgraph()
        return graph

    def take_late(self, reasons):
        """Blender tells nobody of what is edited in a handler behind ours; it evaluates that without handlers."""
        if not self.beside:
            super().take_late(reasons)

    def playback(self):
        for frame in range(1, 5):
            bpy.context.scene.frame_set(frame)
            graph = self.settle()
            if self.beside:
                sb.update(graph)
            self.compare(graph)

    def require_few_unused(self):
        """An edit that leaves a datablock whenever it is made, or one that leaves several, is seen here."""
        edits, left = len(self.done) - self.steps_at_load, unused() - self.copies
        self.steps_at_load, self.copies = len(self.done), 0
        assert left <= UNUSED_AT_MOST + edits * UNUSED_PER_EDIT, f"{left} of ours are unused after {edits} edits"

    def save_and_load(self):
        self.require_few_unused()
        super().save_and_load()
        self.settle()
        require_images_in_use()
        require_used()
        self.sizes.append((round(resident_mb(), 1), sum(datablocks().values())))


def begin(folder, seed):
    """A file with two scenes, a skin and a light in each, and a library beside it."""
    write_library(folder / LIBRARY)
    walk = begin_walk(seed, folder)
    keep(walk, 0, 0, seed)


def keep(walk, step, part, seed):
    """Saves the file under a new name, then the state that names it, then removes the file of the state before."""
    path = walk.folder / f"walk_{part}.blend"
    bpy.ops.wm.save_as_mainfile(filepath=str(path))
    random = walk.random.getstate()
    state = {"step": step, "part": part, "seed": seed, "blend": path.name, "random": random, "tries": 0}
    written = walk.folder / f".{STATE}"
    written.write_text(json.dumps(state))
    written.replace(walk.folder / STATE)
    for old in walk.folder.glob("walk_*.blend*"):
        if not old.name.startswith(path.name):
            old.unlink()


def go_on(folder, steps, beside):
    """Takes some steps from where the walk stopped; returns what was seen, which is added to the log."""
    state = json.loads((folder / STATE).read_text())
    walk = LongWalk(state["seed"], folder, beside)
    version, numbers, gauss = state["random"]
    walk.random.setstate((version, tuple(numbers), gauss))
    walk.ways.seed(f"{state['seed']} {state['step']} {state['tries']}")
    if state["tries"]:  # Blender ended in the steps that come now: others
        walk.random.seed(f"{state['seed']} {state['step']} {state['tries']}")
    bpy.ops.wm.open_mainfile(filepath=str(folder / state["blend"]))
    if beside:
        second_addon.register()
    sb.update(walk.settle())
    walk.push_undo()
    try:
        for _ in range(steps):
            walk.advance()
        walk.save_and_load()
        walk.compare(walk.settle())
        edited = second_addon.EDITS.total
    except BaseException as error:
        where = f"seed {state['seed']}, step {state['step'] + len(walk.done)}"
        raise AssertionError(f"{where}, the last edits: {walk.done[-12:]}\n{error}") from error
    finally:
        second_addon.unregister()
    keep(walk, state["step"] + steps, state["part"] + 1, state["seed"])
    seen = {
        "steps": state["step"] + steps,
        "compared": walk.compared,
        "through": walk.through,
        "late": walk.late,
        "different": len(walk.tables),
        "edits_beside": edited,
        "sizes": walk.sizes,
        "datablocks": {name: count for name, count in datablocks().items() if count},
    }
    with (folder / LOG).open("a") as log:
        log.write(json.dumps(seen) + "\n")
    return seen


def check_a_walk_in_parts(work):
    """Of any folder, and of any length, as the environment says."""
    faulthandler.enable()
    folder = Path(os.environ.get("SKINGLOW_EDITS", work))
    seed = int(os.environ.get("SKINGLOW_SEED", "20261127"))
    steps = int(os.environ.get("SKINGLOW_STEPS", "20"))
    if not (folder / STATE).exists():
        begin(folder, seed)
    if "SKINGLOW_EDITS" in os.environ:
        return go_on(folder, steps, "SKINGLOW_BESIDE" in os.environ)
    first, second = (go_on(folder, steps, beside) for beside in (False, True))
    assert (first["steps"], second["steps"]) == (steps, 2 * steps)
    assert second["edits_beside"] > 0
    return second
