# SPDX-License-Identifier: GPL-3.0-or-later
"""What the add-on remembers about the open file, in one object that is cleared in one step."""

from __future__ import annotations

import threading
import time
from collections.abc import Iterable
from typing import TYPE_CHECKING, Any

import bpy

from .identity import key_of

if TYPE_CHECKING:
    from .commands.freezing import Freezing
    from .commands.material_health import Fault
    from .live.newest_wins import NewestWins
    from .live.shape_update import ShapeState
    from .read.known_objects import Known
    from .read.possible_lights import PlacedLight
    from .read.scene_reading import SceneReading
    from .read.shown_mesh import ShownMeshes
    from .show.lut_image import Atlas
    from .show.tile_image import TileAtlas
    from .table.occlusion import Occluders
    from .table.skin_tables import PreparedLights
    from .thickness.measuring import Measuring


class Session:
    """State kept between updates. Undo and load invalidate it: they replace all data.

    Objects and node groups are keys by identity.key_of.
    """

    def __init__(self) -> None:
        #: (node group, depsgraph mode) to the contents of its images.
        self.atlases: dict[tuple[str, str], Atlas] = {}
        self.tile_atlases: dict[tuple[str, str], TileAtlas] = {}
        #: Node group to the first row and the number of rows of each skin's tiles.
        self.tile_rows: dict[str, dict[str, tuple[int, int]]] = {}
        #: Skin to what is wrong with it, as text; '*' is what concerns no single skin.
        self.faults: dict[str, str] = {}
        #: The same as the last render told it, with the frame: the viewport's updates after it know nothing of that.
        self.render_faults: dict[str, str] = {}
        #: (node group, row) to the object that owns the row.
        self.owners: dict[tuple[str, int], str] = {}
        #: Frozen skin to the frame at which the viewport was last looked at, and what its light depends on there.
        self.marks: dict[str, tuple[int, str]] = {}
        self.rendering = False
        self.is_background = bpy.app.background
        self.render_frame: float | None = None
        #: Whether nodes or images changed while rendering, so that the viewport's table has to be laid out anew.
        self.built_while_rendering = False
        #: Renders that wait in a thread for light through shapes.
        self.waiting = 0
        #: Whether the user ended what the last update waited for, and the signals that said so.
        self.interrupted = False
        self.signals: list[int] = []
        #: What the last update read, and of which depsgraph; None if undo or load made its objects invalid.
        self.reading: tuple[int, SceneReading] | None = None
        #: Address of a depsgraph to the objects of it that matter, as of its last reading.
        self.known: dict[int, Known] = {}
        #: The light objects of a scene that may shine in a render, and what they were found by (possible_lights.py).
        self.light_objects: tuple[tuple, list[PlacedLight]] | None = None
        #: The skins of a scene that a render may show, and what they were found by; of those that are hidden, what
        #: their nodes were made ready for (hidden_skins.py).
        self.scene_skins: tuple[tuple, list[bpy.types.Object]] | None = None
        self.made_ready: dict[str, list] = {}
        #: Whether the file was seen to have no skin; None: not looked at since data was added.
        self.has_none: bool | None = None
        #: Whether a skin may have become one whose mesh lacks tiles since all were looked at.
        self.may_lack_tiles = True
        #: Skins whose weights were painted since their masks were stored; None: maybe all, as after an undo.
        self.painted: set[str] | None = None
        #: Material to the skin node groups it had when it was last reported to have changed.
        self.material_groups: dict[str, frozenset[str]] = {}
        #: Keys of the objects that skins take their reference point from.
        self.reference_objects: frozenset[str] = frozenset()
        #: Addresses of the depsgraphs of layers that were not shown during an undo, nor evaluated anew since.
        self.undone_graphs: set[int] = set()
        #: Number of updates, one per edit: anything derived at a lower number may be out of date.
        self.updates = 0
        #: The core's lights made from the last reading.
        self.prepared_lights: PreparedLights | None = None
        #: Depsgraph mode to what casts shadows there: viewport and render show different objects.
        self.occluders: dict[str, Occluders] = {}
        #: (lasting_key_of an image, projection) to (source of the pixels, skinglow.Environment or the error).
        self.world_images: dict[tuple[str, str], tuple[tuple, Any]] = {}
        #: Key of a base lookup that is an image to its skinglow.BaseLut.
        self.base_images: dict[tuple, Any] = {}
        #: Skin to the (updates, scene, view layer) of its filled list of lights, and of the list that was asked for.
        self.filled_lists: dict[str, tuple[int, str, str]] = {}
        self.requested_lists: dict[str, tuple[int, str, str]] = {}
        #: Skin to the (scene, view layer, measured slots) that its faults of thickness are of, None once its mesh
        #: changed, and these faults; those that were asked for; and when one of these meshes changed last, seconds.
        self.thickness_faults: dict[str, tuple[tuple | None, tuple[Fault, ...]]] = {}
        self.requested_faults: dict[str, tuple] = {}
        self.reshaped_at = 0.0
        #: Thumbnail to what it was drawn from, and the thickness at its right end, mm.
        self.thumbnails: dict[str, tuple[tuple, float]] = {}
        #: (skin, depsgraph mode) to its light through its shape, the meshes that this is solved in, and the thread.
        self.shapes: dict[tuple[str, str], ShapeState] = {}
        self.shown_meshes: ShownMeshes | None = None
        self.shape_worker: NewestWins | None = None
        #: The thickness measurement that runs in a thread.
        self.measuring: Measuring | None = None
        #: Light that a window is freezing to images, frame by frame.
        self.freezing: Freezing | None = None

    def is_layout_fixed(self) -> bool:
        """Whether nodes and images have to stay as they are: while a render runs beside a window."""
        return self.rendering and not (self.is_background and threading.current_thread() is threading.main_thread())

    def told(self) -> dict[str, str]:
        """What is wrong now, and what was in the last render, by skin."""
        return {**self.render_faults, **self.faults}

    def reading_of(self, depsgraph: bpy.types.Depsgraph) -> SceneReading | None:
        """What the last update read, if it was of that depsgraph and no change was reported since."""
        address, reading = self.reading or (None, None)
        return reading if address == depsgraph.as_pointer() else None

    def note_reshaped(self, changed: Iterable[bpy.types.ID]) -> None:
        """Has what was found of the thickness of skins looked at again: these, or their meshes, changed."""
        keys: set[str] = set()
        for each in changed:
            mesh = getattr(each.original, "data", None)
            # The modifiers of one object matter to others with the same mesh.
            keys |= {key_of(each)} if mesh is None or mesh.users < 2 else self.thickness_faults.keys()
        for key in keys:
            if key in self.thickness_faults:
                self.thickness_faults[key] = (None, self.thickness_faults[key][1])
                self.reshaped_at = time.monotonic()

    def forget_tables(self) -> None:
        """Drops all tables, so that the next update recomputes and shows every one."""
        self.atlases.clear()
        self.tile_atlases.clear()
        self.tile_rows.clear()
        self.owners.clear()
        self.faults.clear()
        self.render_faults.clear()
        self.marks.clear()
        self.base_images.clear()
        self.known.clear()
        self.light_objects = self.scene_skins = None
        self.made_ready.clear()
        self.material_groups.clear()
        self.reading = self.has_none = None

    def forget(self) -> None:
        """Resets to the state before the first update; measuring, freezing and light through shapes go on."""
        names = (
            "measuring",
            "freezing",
            "waiting",
            "interrupted",
            "is_background",
            "signals",
            "updates",
            "undone_graphs",
            "shapes",
            "shown_meshes",
            "shape_worker",
            "render_faults",
        )
        kept = {name: getattr(self, name) for name in names}
        self.__init__()
        self.__dict__.update(kept)
        if self.shown_meshes is not None:
            self.shown_meshes.reread()


SESSION = Session()
