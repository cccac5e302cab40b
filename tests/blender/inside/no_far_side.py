"""Vertices that find no way out of the mesh are told: in the operator's report and in the panel."""

import os
import tempfile
from contextlib import contextmanager

import bpy
import skinglow_blender as sb
from skinglow_blender.ui.thickness_panel import draw_thickness

from inside.measured_as_shown import plate


class Labels:
    """A layout that keeps the texts of its labels."""

    def __init__(self):
        self.texts = []

    def column(self, **_):
        return self

    row = column

    def drawn(self, *_args, **_kwargs):
        """What has no text of ours."""

    prop = operator = template_icon = separator = drawn

    def label(self, text="", **_):
        self.texts.append(text)


@contextmanager
def printed():
    """What is written to standard output meanwhile, by C as well: Blender writes its reports there."""
    said = []
    kept = os.dup(1)
    with tempfile.TemporaryFile() as file:
        os.dup2(file.fileno(), 1)
        try:
            yield said
        finally:
            os.dup2(kept, 1)
            os.close(kept)
            file.seek(0)
            said.append(file.read().decode(errors="replace"))


def measured(obj):
    """What the panel and the report say after the operator measured."""
    sb.make_skin(obj, thickness=[2.0] * len(obj.data.vertices))
    bpy.ops.object.select_all(action="DESELECT")
    obj.select_set(True)
    bpy.context.view_layer.objects.active = obj
    with printed() as said:
        assert bpy.ops.skinglow.measure_thickness() == {"FINISHED"}
    layout = Labels()
    draw_thickness(layout, obj, bpy.context)
    return " ".join(layout.texts), said[0]


def check_an_open_mesh_is_told(_work):
    panel, report = measured(plate(closed=False))
    for text in (panel, report):
        assert "100.0% of the vertices found no far side" in text, text
    assert "Plate" in report


def check_a_closed_mesh_says_nothing(_work):
    for text in measured(plate()):
        assert "far side" not in text, text


def check_the_note_goes_when_the_mesh_is_closed(_work):
    obj = plate(closed=False)
    assert "no far side" in measured(obj)[0]
    obj.modifiers.new("Solid", "SOLIDIFY").thickness = 0.002
    panel, report = measured(obj)
    assert "far side" not in panel and "far side" not in report
