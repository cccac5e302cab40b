# SPDX-License-Identifier: GPL-3.0-or-later
"""The operators that measure thickness: in the background of a window, synchronously from scripts."""

import bpy
import numpy as np
from bpy.props import CollectionProperty, EnumProperty, FloatProperty

from ..commands import skin
from ..commands.health import thickness_faults
from ..errors import SkinError
from ..identity import HAS_UID, key_of
from ..preferences import of_new_skins
from ..read.measured_geometry import Geometry, read_geometry
from ..session import SESSION
from ..setting_choices import LIGHTINGS, MODES
from ..setting_values import as_typed
from ..thickness import thickness_attribute
from ..thickness.measuring import Measuring
from ..thickness.tile_attribute import ensure_tiles
from ..tissue_presets import PRESETS
from . import slot_choice
from .light_list import redraw_panels
from .operators import SKIN, check_kept, may_act, selected_meshes, selected_skins
from .status_text import end_progress, show_status

#: Seconds between two checks of the thread.
INTERVAL = 0.1
#: Settings that Make Skin Glow offers in Adjust Last Operation.
CHOICES = ("mode", "weights", "preset", "unit_mm")
#: What was measured last, by the digest of its geometry.
_last_measured: dict[str, tuple[np.ndarray, np.ndarray]] = {}
#: Of the measurement that runs.
_timers: list[bpy.types.Timer] = []


class _MeasuringOperator:
    """Measures first and changes the file only when everything is measured: canceling loses nothing."""

    bl_options = {"REGISTER", "UNDO"}

    def to_measure(self, context: bpy.types.Context) -> dict[str, Geometry]:
        """The geometry to measure, by key of the object; raises SkinError for a mesh that cannot be measured."""
        raise NotImplementedError

    def before_storing(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> None:
        """Runs before the thickness of the meshes is stored."""

    def finish(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> str:
        """Runs after the thickness of the meshes is stored; returns the message to report."""
        raise NotImplementedError

    def targets(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        """The objects that the operator acts on."""
        raise NotImplementedError

    def execute(self, context: bpy.types.Context) -> set[str]:
        try:
            self._names = {key_of(obj): obj.name for obj in self.targets(context)}
            geometries = self.to_measure(context)
            thicknesses = {key: _measured(geometry) for key, geometry in geometries.items()}
        except (SkinError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self._store(context, geometries, thicknesses)

    def invoke(self, context: bpy.types.Context, _event: bpy.types.Event) -> set[str]:
        if bpy.app.background:
            return self.execute(context)
        try:
            self._names = {key_of(obj): obj.name for obj in self.targets(context)}
            geometries = self.to_measure(context)
            if not geometries:
                return self._store(context, {}, {})
            SESSION.measuring = Measuring(geometries, [self._names[key] for key in geometries])
        except (SkinError, ValueError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        _timers.append(context.window_manager.event_timer_add(INTERVAL, window=context.window))
        context.window_manager.modal_handler_add(self)
        _show_progress(context)
        return {"RUNNING_MODAL"}

    def modal(self, context: bpy.types.Context, event: bpy.types.Event) -> set[str]:
        measuring = SESSION.measuring
        if measuring is None:
            return {"CANCELLED"}
        if event.type == "ESC" and event.value == "PRESS":
            measuring.canceled = True
            return {"RUNNING_MODAL"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        _show_progress(context)
        # The thread first finishes a block of vertices. If the user has entered Edit Mode meanwhile, the result waits
        # until they leave it.
        if measuring.running or (context.mode != "OBJECT" and not measuring.canceled):
            return {"PASS_THROUGH"}
        _end()
        if measuring.canceled:
            self.report({"INFO"}, "Measuring canceled, nothing was changed")
            return {"CANCELLED"}
        try:
            thicknesses = measuring.wait()
        except (SkinError, ValueError, RuntimeError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        return self._store(context, measuring.geometries, thicknesses)

    def cancel(self, _context: bpy.types.Context) -> None:
        """Called by Blender when a file is loaded or the window is closed."""
        stop_measuring()

    def _store(self, context: bpy.types.Context, geometries: dict, thicknesses: dict) -> set[str]:
        try:
            objects = _objects(self._names)
            self.before_storing(context, list(objects.values()))
            _remember(geometries, thicknesses)
            for key, values in thicknesses.items():
                thickness_attribute.store_measured(objects[key], context.scene, geometries[key], *values)
            self.report({"INFO"}, self.finish(context, list(objects.values())))
            for key in thicknesses:
                if text := thickness_attribute.no_far_side_text(objects[key].data):
                    self.report({"WARNING"}, f"{objects[key].name}: {text}")
            depsgraph = context.evaluated_depsgraph_get()
            for obj in objects.values():
                for fault in thickness_faults(obj, depsgraph):
                    self.report({"WARNING"}, f"{obj.name}: {fault}")
        except (SkinError, ValueError) as error:
            self.report({"ERROR"}, str(error))
        # Also after an error: some meshes may have changed, and Undo reverts that.
        return {"FINISHED"}


def _measured(geometry: Geometry) -> tuple[np.ndarray, np.ndarray]:
    """What `measure` returns; Adjust Last Operation undoes a measurement and asks for it again at each change."""
    found = _last_measured.get(geometry.digest())
    return found if found is not None else thickness_attribute.measure(geometry)


def _remember(geometries: dict[str, Geometry], thicknesses: dict[str, tuple[np.ndarray, np.ndarray]]) -> None:
    if thicknesses:
        _last_measured.clear()
        _last_measured.update({geometries[key].digest(): values for key, values in thicknesses.items()})


def _objects(names: dict[str, str]) -> dict[str, bpy.types.Object]:
    """The objects of these keys, in their order. Undo invalidates all references, so they are looked up."""
    found = {key_of(obj): obj for obj in bpy.data.objects}
    for key, name in names.items():
        if key not in found:
            raise SkinError(f"'{name}' was deleted{'' if HAS_UID else ' or renamed'} while it was measured")
    return {key: found[key] for key in names}


def _show_progress(context: bpy.types.Context) -> None:
    measuring = SESSION.measuring
    names = ", ".join(measuring.names)
    if measuring.canceled:
        text = f"Canceling: the thickness of {names} is kept"
    elif measuring.running:
        text = f"Measuring the thickness of {names}: {measuring.done:.0%}      Esc: cancel"
    else:
        text = f"The thickness of {names} is measured: return to Object Mode to apply it      Esc: cancel"
    show_status(context, text)
    redraw_panels()


def stop_measuring() -> None:
    """Stops a running measurement, as when Blender quits or the add-on is disabled, which calls no operator."""
    if SESSION.measuring is not None:
        SESSION.measuring.cancel()
        _end()


def _end() -> None:
    SESSION.measuring = None
    end_progress(_timers)


def _may_measure(cls: type, context: bpy.types.Context, *, found: bool, what: str = SKIN) -> bool:
    if SESSION.measuring is not None:
        cls.poll_message_set("Thickness is being measured, Esc cancels")
        return False
    return may_act(cls, context, found=found, what=what)


class SKINGLOW_OT_make(_MeasuringOperator, bpy.types.Operator):  # noqa: N801  Blender's naming
    """Turns the selected meshes into skins."""

    bl_idname = "skinglow.make"
    bl_label = "Make Skin Glow"
    bl_description = (
        "Measure the thickness of the selected meshes and let the light of the scene shine through their materials"
    )

    mode: EnumProperty(name="Mode", items=MODES, default="PHYSICAL", options={"SKIP_SAVE"})
    weights: EnumProperty(name="Lighting", items=LIGHTINGS, default="SHAPE", options={"SKIP_SAVE"})
    preset: EnumProperty(name="Preset", items=PRESETS[1:], default="LIGHT", options={"SKIP_SAVE"})
    unit_mm: FloatProperty(
        name="Unit",
        subtype="DISTANCE_CAMERA",
        min=0.0,
        max=1e9,
        options={"SKIP_SAVE"},
        description="Length of one Blender unit; 0 uses the unit scale of the scene",
    )
    slots: CollectionProperty(name="Slots", type=slot_choice.SlotChoice, options={"SKIP_SAVE"})

    def draw(self, _context: bpy.types.Context) -> None:
        layout = self.layout
        layout.use_property_split, layout.use_property_decorate = True, False
        for name in CHOICES:
            layout.prop(self, name)
        slot_choice.draw(layout, self.slots)

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _may_measure(cls, context, found=bool(selected_meshes(context)), what="Select a mesh to make glow")

    def targets(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return selected_meshes(context)

    def to_measure(self, context: bpy.types.Context) -> dict[str, Geometry]:
        found = {}
        check_kept(self.targets(context))
        for obj in self.targets(context):
            geometry = read_geometry(obj, context.scene)
            unit = as_typed(self._settings(obj).get("unit_mm", 0.0))
            if unit > 0.0:
                geometry = geometry._replace(unit_mm=unit)
            if not thickness_attribute.is_measured(obj, geometry):
                found[key_of(obj)] = geometry
        return found

    def before_storing(self, _context: bpy.types.Context, objects: list[bpy.types.Object]) -> None:
        for obj in objects:
            obj.skinglow.unit_mm = self._settings(obj).get("unit_mm", obj.skinglow.unit_mm)

    def finish(self, _context: bpy.types.Context, objects: list[bpy.types.Object]) -> str:
        states = [self._make(obj) for obj in objects]
        slot_choice.offer(self.slots, objects)
        self._show_choices(objects)
        return "; ".join(f"{s.name}: {s.thickness_mm[0]:.2f} to {s.thickness_mm[1]:.2f} mm thick" for s in states)

    def _make(self, obj: bpy.types.Object) -> skin.SkinState:
        settings = self._settings(obj)
        state = skin.make_skin(obj, slots=slot_choice.chosen(self.slots, obj), **settings)
        # Nobody asked for light through the shape of this one: it begins with what serves it.
        is_asked = self.properties.is_property_set("weights") or "weights" in of_new_skins()
        if "weights" in settings and not is_asked and state.shape is not None and state.shape.reason is not None:
            state = skin.make_skin(obj, weights="OBJECT")
        return state

    def _show_choices(self, objects: list[bpy.types.Object]) -> None:
        """Has Adjust Last Operation show what the skins have in common, as by the preferences, rather than defaults."""
        for name in CHOICES:
            values = {getattr(obj.skinglow, name) for obj in objects}
            if len(values) == 1 and values != {"CUSTOM"}:
                setattr(self, name, values.pop())

    def _settings(self, obj: bpy.types.Object) -> dict[str, object]:
        """What was chosen in Adjust Last Operation; for a new skin, what the preferences say of the rest."""
        chosen = {name: getattr(self, name) for name in CHOICES if self.properties.is_property_set(name)}
        return chosen if obj.skinglow.enabled else {"weights": self.weights} | of_new_skins() | chosen


class SKINGLOW_OT_measure_thickness(_MeasuringOperator, bpy.types.Operator):  # noqa: N801
    """Measures the thickness of skins again."""

    bl_idname = "skinglow.measure_thickness"
    bl_label = "Measure Thickness"
    bl_description = (
        "Measure the thickness of the selected skins again, for example after editing the mesh; Esc cancels"
    )

    @classmethod
    def poll(cls, context: bpy.types.Context) -> bool:
        return _may_measure(cls, context, found=bool(selected_skins(context)))

    def targets(self, context: bpy.types.Context) -> list[bpy.types.Object]:
        return selected_skins(context)

    def to_measure(self, context: bpy.types.Context) -> dict[str, Geometry]:
        return {key_of(o): read_geometry(o, context.scene) for o in self.targets(context)}

    def finish(self, context: bpy.types.Context, objects: list[bpy.types.Object]) -> str:
        for obj in objects:
            if obj.skinglow.weights == "SHAPE" and obj.skinglow.mode == "PHYSICAL":
                ensure_tiles(obj, context.scene)
            obj.update_tag(refresh={"OBJECT"})
        return "; ".join(f"{obj.name}: {len(obj.data.vertices)} vertices measured" for obj in objects)


class SKINGLOW_OT_cancel_measuring(bpy.types.Operator):  # noqa: N801
    """Cancels a measurement from the panel."""

    bl_idname = "skinglow.cancel_measuring"
    bl_label = "Cancel Measuring Thickness"
    bl_description = "Stop measuring without changing anything"
    bl_options = {"INTERNAL"}

    @classmethod
    def poll(cls, _context: bpy.types.Context) -> bool:
        return SESSION.measuring is not None

    def execute(self, _context: bpy.types.Context) -> set[str]:
        # The operator that started the measurement checks this and ends.
        SESSION.measuring.canceled = True
        return {"FINISHED"}


CLASSES = (SKINGLOW_OT_make, SKINGLOW_OT_measure_thickness, SKINGLOW_OT_cancel_measuring)


def register() -> None:
    """Adds the operators."""
    for each in CLASSES:
        bpy.utils.register_class(each)


def unregister() -> None:
    """Removes the operators, also when Blender quits: no thread may run Python then."""
    stop_measuring()
    _last_measured.clear()
    for each in reversed(CLASSES):
        bpy.utils.unregister_class(each)
