"""Runs inside Blender: the add-on's own skins in the medium of the studies."""

from __future__ import annotations

from collections.abc import Iterator
from contextlib import contextmanager
from typing import Any
from unittest import mock

import bpy
import skinglow as sg
import skinglow_blender as sb
from skinglow_blender.table import skin_tables

from studies import rendering
from studies.medium import INDEX, Medium


@contextmanager
def tables_of(medium: Medium) -> Iterator[None]:
    """The add-on's tables are of skin; within, of this medium, so that all methods are compared in one."""
    of_skin = skin_tables.base_lut

    def base_lut(key: tuple) -> sg.BaseLut:
        return medium.base_lut(key[1], key[2]) if key[0] == "TISSUE" else of_skin(key)

    with (
        mock.patch.object(skin_tables, "base_lut", base_lut),
        mock.patch.object(skin_tables, "_angular_weight", lambda _key: None),
    ):
        yield


def make(head: bpy.types.Object, medium: Medium, **settings: Any) -> None:  # noqa: ANN401
    """A skin with these settings of `make_skin` over a black surface: nothing but what comes through is seen."""
    rendering.assign_material(head, rendering.black())
    sb.make_skin(head, strength=1.0, **settings)
    sb.set_medium(head, medium.absorption, medium.reduced_scattering, refractive_index=INDEX)
    update(head)


def update(head: bpy.types.Object) -> None:
    """What is shown follows lights that changed."""
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    sb.update(depsgraph)
    shape = sb.state_of(head, depsgraph).shape
    if shape is not None and shape.reason is not None:
        raise RuntimeError(shape.reason)
