"""The random walk's edits of lights, collections, instances and frames, by name."""

import random

import bpy

from inside.scenes import add_light, link, render_settings

EARLY = bpy.app.version < (4, 0, 0)


class SceneEdits:
    """Data is looked up afresh each time, as undo and load replace it all."""

    def __init__(self, seed, folder):
        self.random = random.Random(seed)
        self.folder = folder
        self.undone = False
        self.copies = 0  #: of node groups, since the file was loaded

    # What there is.
    def objects(self, kind):
        return [o for o in bpy.context.scene.objects if o.type == kind]

    def lights(self):
        """Those of this file: what belongs to a library is edited there."""
        return [o for o in bpy.data.objects if o.type == "LIGHT" and not o.library and not o.data.library]

    def skins(self):
        return [o for o in self.objects("MESH") if o.skinglow.enabled]

    def own_skins(self):
        return [o for o in self.skins() if not o.library and not o.data.library]

    def window(self):
        return bpy.context.window_manager.windows[0]

    def pick(self, things):
        return self.random.choice(things) if things else None

    def position(self):
        return [self.random.uniform(-3.0, 3.0) for _ in range(3)]

    def color(self):
        return [self.random.choice((0.0, 0.25, 1.0, self.random.random())) for _ in range(3)]

    def collection(self):
        return self.pick([bpy.context.scene.collection, bpy.data.collections["Rig"], bpy.data.collections["Store"]])

    # Edits of lights.
    def new_light(self):
        if len(self.lights()) < 24:
            kind = self.random.choice(("POINT", "SUN", "SPOT", "AREA"))
            add_light("Lamp", kind, self.color(), self.random.uniform(0.1, 50), self.position(), self.collection())

    def delete_light(self):
        obj = self.pick(self.lights())
        if obj is not None:
            bpy.data.objects.remove(obj)

    def duplicate_light(self):
        obj = self.pick(self.lights())
        if obj is not None and len(self.lights()) < 24:
            copy = link(obj.copy(), self.collection())
            copy.location = self.position()
            if self.random.random() < 0.5:
                copy.data = copy.data.copy()

    def rename_light(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.name = self.random.choice(("Lamp", "Key", "Patch", "Lamp.001"))

    def recolor(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.data.color = self.color()

    def power(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.data.energy = self.random.choice((0.0, 1.0, 100.0))

    def kind(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.data.type = self.random.choice(("POINT", "SUN", "SPOT", "AREA"))

    def move_light(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.location = self.position()

    def hide_light(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.hide_viewport = not obj.hide_viewport

    def hide_light_in_renders(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.hide_render = not obj.hide_render

    def hide_with_h(self):
        # Not by name: a library's light has the name of its override.
        shown = set(bpy.context.view_layer.objects)
        obj = self.pick([o for o in self.lights() if o in shown])
        if obj is not None:
            obj.hide_set(not obj.hide_get())

    def parent(self):
        obj, holder = self.pick(self.lights()), self.pick(self.objects("EMPTY") + self.skins())
        if obj is not None:
            obj.parent = None if self.random.random() < 0.3 else holder

    def constrain(self):
        obj, target = self.pick(self.lights()), self.pick(self.objects("EMPTY"))
        if obj is not None:
            obj.constraints.clear()
            if target is not None and self.random.random() < 0.7:
                obj.constraints.new("COPY_LOCATION").target = target

    def key(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.keyframe_insert("location")
            obj.data.keyframe_insert("color")

    def drive(self):
        obj = self.pick(self.lights())
        if obj is not None:
            obj.data.driver_remove("energy")
            obj.data.driver_add("energy").driver.expression = self.random.choice(("frame - 3", "0", "frame * 2"))

    # Edits of collections, instances and frames.
    def exclude(self):
        layer = self.pick(list(bpy.context.view_layer.layer_collection.children))
        layer.exclude = not layer.exclude

    def add_view_layer(self):
        # In 3.4 frame_set would evaluate such a graph (others_are_broken).
        if len(bpy.context.scene.view_layers) < 3 and not EARLY:
            bpy.context.scene.view_layers.new("Layer")

    def switch_view_layer(self):
        if not self.others_are_broken():
            self.window().view_layer = self.pick(list(bpy.context.scene.view_layers))

    def others_are_broken(self):
        """Undo leaves Blender 3.4's graphs of layers that are not shown with dangling pointers, and it crashes."""
        return self.undone and EARLY

    def switch_scene(self):
        if not self.others_are_broken():
            self.window().scene = self.pick(list(bpy.data.scenes))

    def hide_collection(self):
        collection = self.pick([bpy.data.collections["Rig"], bpy.data.collections["Store"]])
        collection.hide_viewport = not collection.hide_viewport

    def close_eye(self):
        layer = self.pick(list(bpy.context.view_layer.layer_collection.children))
        layer.hide_viewport = not layer.hide_viewport

    def instance(self):
        if len(self.objects("EMPTY")) < 6:
            empty = link(bpy.data.objects.new("Empty", None))
            empty.location = self.position()
            if self.random.random() < 0.7:
                empty.instance_type, empty.instance_collection = "COLLECTION", bpy.data.collections["Store"]

    def move_empty(self):
        obj = self.pick(self.objects("EMPTY"))
        if obj is not None:
            obj.location = self.position()
            obj.scale = [self.random.choice((1.0, 2.0))] * 3

    def delete_empty(self):
        obj = self.pick(self.objects("EMPTY"))
        if obj is not None:
            bpy.data.objects.remove(obj)

    def frame(self):
        bpy.context.scene.frame_set(self.random.randint(1, 8))

    def engine(self):
        """EEVEE is only chosen: its first picture takes half a minute in software (rendered_eevee looks at those)."""
        render_settings(2, 2, self.random.choice(("CYCLES", "EEVEE")))
