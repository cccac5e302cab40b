"""Random edits, after each of which the light through a skin's shape is compared with a fresh computation.

The seed is part of every failure; SKINGLOW_SEED repeats a walk, SKINGLOW_STEPS changes its length.
"""

import os

import bpy
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.show.tile_image import TILE_PROPERTY

from inside.scenes import camera_above, depsgraph, link, render_settings
from inside.shape_scenes import differences, lobe, shape_skin, sun
from inside.walk_edits import SceneEdits


class ShapeWalk(SceneEdits):
    """Edits of lights and of what a skin consists of; lengths in mm."""

    def __init__(self, seed, folder):
        super().__init__(seed, folder)
        self.undoable = 0
        self.through = 0

    def position(self):
        return [self.random.uniform(-25.0, 25.0) for _ in range(3)]

    def skin(self):
        return self.pick(self.own_skins())

    def sun(self):
        sun(energy=self.random.uniform(0.5, 5.0), direction=self.position())

    def move_skin(self):
        self.skin().location, self.skin().rotation_euler = self.position(), self.position()

    def scale(self):
        self.skin().scale = [self.random.choice((-1.0, 0.8, 1.0, 1.3)) for _ in range(3)]

    def deform(self):
        self.skin().data.vertices[self.random.randrange(20)].co.z += 0.3

    def modifier(self):
        obj = self.skin()
        if obj.modifiers:
            obj.modifiers.clear()
        else:
            obj.modifiers.new("Modifier", self.random.choice(("SUBSURF", "MIRROR", "TRIANGULATE", "SMOOTH")))

    def lighting(self):
        self.skin().skinglow.weights = self.random.choice(("OBJECT", "SHAPE", "SHAPE", "SURFACE"))

    def settings(self):
        self.skin().skinglow.reentries = self.random.choice((0, 2))
        self.skin().skinglow.cell_mm = self.random.choice((1.0, 1.3))

    def medium(self):
        if "skinglow_medium" in self.skin():
            sb.set_medium(self.skin())
        else:
            sb.set_medium(self.skin(), (0.03, 0.1, 0.3), (0.8, 0.9, 1.0))

    def duplicate_skin(self):
        if len(self.skins()) < 2:
            copy = link(self.skin().copy())
            copy.location = self.position()
            if self.random.random() < 0.5:
                copy.data = copy.data.copy()

    def push_undo(self):
        depsgraph()
        bpy.ops.ed.undo_push(message="step")
        self.undoable = min(self.undoable + 1, 20)

    def undo(self):
        self.push_undo()
        if self.undoable > 1:
            bpy.ops.ed.undo()
            self.undoable -= 1
        self.push_undo()

    def save_and_load(self):
        path = str(self.folder / "walk.blend")
        bpy.ops.wm.save_as_mainfile(filepath=path)
        bpy.ops.wm.open_mainfile(filepath=path)
        self.undoable = 0
        self.push_undo()

    def render(self):
        render_settings(2, 2)
        bpy.ops.render.render()

    def step(self):
        edits = (self.recolor, self.power, self.kind, self.move_light, self.hide_light, self.new_light, self.sun,
                 self.sun, self.duplicate_light, self.delete_light, self.exclude, self.hide_collection, self.frame,
                 self.move_skin, self.scale, self.deform, self.modifier, self.lighting, self.settings, self.medium,
                 self.duplicate_skin, self.push_undo, self.undo, self.save_and_load, self.render)  # fmt: skip
        edit = self.random.choice(edits)
        edit()
        return edit.__name__

    def compare(self, graph):
        for obj in self.skins():
            settings = obj.skinglow
            use = obj.get(TILE_PROPERTY, (0.0, 0.0, 0.0, 0.0))[3]
            mirrored = any(m.type == "MIRROR" for m in obj.modifiers)
            assert use == float(settings.weights == "SHAPE" and not mirrored), (obj.name, use, settings.weights)
            if use:
                compare_tiles(obj, graph)
                self.through += 1


def compare_tiles(obj, graph):
    medium = obj.get("skinglow_medium")
    flesh = {"tissue": sg.TISSUE_PRESETS["light"]}
    if medium is not None:
        flesh = {"absorption": medium[:3], "reduced_scattering": medium[3:6], "refractive_index": medium[6]}
    settings = obj.skinglow
    more = {"flesh": flesh, "cell_mm": settings.cell_mm, "reentries": settings.reentries}
    error, mean = differences(obj, graph, **more)
    # Of a turned body the last digits differ, by which single cells are in its flesh or not: these are large here.
    turned = any(obj.rotation_euler) or min(obj.scale) < 0.0
    assert error <= (0.03 if turned else 1e-2) * mean, (obj.name, error, mean)


def check_random_walk_through_the_shape(work):
    seed = int(os.environ.get("SKINGLOW_SEED", "20261126"))
    steps = int(os.environ.get("SKINGLOW_STEPS", "24"))
    print(f"random walk through the shape: SKINGLOW_SEED={seed}, {steps} steps", flush=True)
    for name in ("Rig", "Store"):
        bpy.context.scene.collection.children.link(bpy.data.collections.new(name))
    shape_skin(lobe(levels=2))
    sun()
    camera_above(30.0)
    walk = ShapeWalk(seed, work)
    walk.push_undo()
    done = []
    try:
        for _ in range(steps):
            done.append(walk.step())
            graph = depsgraph()
            sb.update(graph)
            walk.compare(depsgraph())
    except BaseException as error:
        raise AssertionError(f"seed {seed}, step {len(done)}, the last edits: {done[-12:]}\n{error}") from error
    assert walk.through > steps / 4, walk.through
    return {"seed": seed, "steps": steps, "through": walk.through}
