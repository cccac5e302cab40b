"""Random edits of skins that are lit through their shape, and what is compared of them."""

from skinglow_blender.live.shape_update import shape_report
from skinglow_blender.show.tile_image import TILE_PROPERTY

from inside.shape_scenes import BODY_VERTICES, differences, shape_skin, thin_body
from inside.walk_mesh_edits import MeshEdits


class ShapeEdits(MeshEdits):
    """Thin bodies among the skins."""

    def __init__(self, seed, folder):
        super().__init__(seed, folder)
        self.shown = self.through = 0

    def add_body(self):
        """A closed skin of thin flesh, lit through its shape."""
        if len(self.skins()) < 6:
            obj = thin_body("Body", self.pick([None, *self.materials()]))
            obj.location = self.position()
            shape_skin(obj)

    def mode(self):
        obj = self.pick(self.own_skins())
        if obj is not None:
            obj.skinglow.mode = self.random.choice(("EXISTING", "PAPER", "PAPER", "PHYSICAL", "PHYSICAL"))
            obj.skinglow.weights = self.random.choice(("OBJECT", "SHAPE", "SHAPE"))

    def compare_shape(self, obj, graph):
        """A skin that is lit through its shape shows what is solved afresh, or says why it is not."""
        through = obj.get(TILE_PROPERTY, (0.0,) * 4)[3] == 1.0
        if obj.skinglow.mode != "PHYSICAL" or obj.skinglow.weights != "SHAPE":
            assert not through, obj.name
            return
        reason = shape_report(obj).reason
        assert through == (reason is None), (obj.name, through, reason)
        if obj.name.startswith("Body") and not obj.modifiers and len(obj.data.vertices) == BODY_VERTICES:
            assert through, (obj.name, reason)
        # Solving afresh takes long: what every second of them shows.
        self.shown += through
        if through and self.shown % 2:
            error, mean = differences(obj, graph)
            # Of a turned body the last digits differ, by which single cells are in its flesh or not.
            assert error <= 0.03 * mean, (obj.name, error, mean)
            self.through += mean > 0.0
