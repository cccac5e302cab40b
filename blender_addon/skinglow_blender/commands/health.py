# SPDX-License-Identifier: GPL-3.0-or-later
"""Whether everything that makes an object glow agrees: its nodes, images, materials, thickness and mesh."""

from collections.abc import Callable, Iterable, Iterator

import bpy
import numpy as np

from ..errors import SkinError
from ..identity import key_of
from ..live.needed_nodes import REMEDIES
from ..live.shape_update import EDIT_MODE, shape_report
from ..read.enabled_objects import is_followed
from ..read.measured_size import is_reshaped, is_stretched
from ..read.mesh_reading import evaluated_mesh, vertices_of_slots
from ..session import SESSION
from ..show.frozen import frozen_frames, frozen_mark, is_frozen, missing_file
from ..show.group_nodes import nodes_of
from ..show.image_pairs import SLOTS
from ..show.lut_image import images_of, shown_image
from ..show.tile_image import TILES
from ..thickness import thickness_attribute
from ..thickness.thickness_attribute import KNOWN_ATTRIBUTE, THICKNESS_ATTRIBUTE
from .freezing import unfreeze
from .material_health import CHOOSE_MASK, REPAIR, UNMUTE, Fault, layer_faults, material_faults, measured_slots
from .rendered_objects import RenderedObjects
from .skin import remake_skin, skin_settings_of

MEASURE = "press Measure Thickness"
MEASURE_APPLIED = f"{MEASURE}; if a modifier makes these vertices, apply it first"
CHOOSE_REFERENCE = "Choose them in the panel Lookup Table, under Light Distance From"
INCLUDE_REFERENCE = "include it, or hide it with the eye"
OWN_MESH = (
    "give it a mesh of its own (Object > Relations > Make Single User > Object & Data), then press Measure Thickness"
)
FREEZE_AGAIN = "unfreeze it, or then freeze it again"
FREEZE_MORE = "unfreeze it, or then freeze more frames"
#: What no button does.
BY_HAND = frozenset({CHOOSE_MASK, CHOOSE_REFERENCE, INCLUDE_REFERENCE, OWN_MESH, UNMUTE})


def health(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph | None = None) -> list[Fault]:
    """What is wrong with a skin, worst first, and what to do about each; empty: all is well.

    What the last render had to tell is kept, until the next one, or until the skin has the nodes that it lacked.

    obj        a skin; raises SkinError for any other object
    depsgraph  whose evaluated mesh is looked at; None: the context's
    """
    if obj.type != "MESH" or not obj.skinglow.enabled:
        skin_settings_of(obj)
    faults = _faults_now(obj, depsgraph or bpy.context.evaluated_depsgraph_get())
    told = SESSION.render_faults.get(key_of(obj))
    # What is said of now need not be said again of then.
    if told is not None and not any(fault.what in told for fault in faults):
        faults.append(_as_fault(told))
    return faults


def _faults_now(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> list[Fault]:
    faults = with_thickness_faults(quick_faults(obj), lambda: thickness_faults(obj, depsgraph))
    told = SESSION.faults.get(key_of(obj))
    if told is not None and not faults:
        faults.append(_as_fault(told))
    return faults


def _as_fault(told: str) -> Fault:
    """What an update told of a skin, with the remedy that it named if Repair is none."""
    for remedy in REMEDIES:
        if told.endswith(f": {remedy}"):
            return Fault(told.removesuffix(f": {remedy}"), remedy)
    return Fault(told, REPAIR)


def with_thickness_faults(quick: list[Fault], find: Callable[[], Iterable[Fault]]) -> list[Fault]:
    """The faults of a skin: the quick ones, and those of its thickness unless a quick one says that already."""
    if any(fault.remedy == MEASURE and not fault.is_hint for fault in quick):
        return quick
    return [*quick, *find()]


def quick_faults(obj: bpy.types.Object) -> list[Fault]:
    """Those that cost next to nothing to find, whatever the size of the mesh: for drawing."""
    faults = []
    group = obj.skinglow.group
    if group is None:
        faults.append(Fault("Its node group was deleted", REPAIR))
    else:
        faults += _group_faults(group)
        faults += material_faults(obj)
        if is_frozen(group):
            faults += _frozen_faults(obj, group)
    if bpy.context.view_layer is not None:
        faults += layer_faults(obj, bpy.context.view_layer)
    report = shape_report(obj)
    if report is not None and report.reason not in (None, EDIT_MODE):
        what, remedy = report.reason
        faults.append(Fault(f"It is lit per pixel, not through its shape: {what}", remedy))
    faults += _reference_faults(obj)
    mesh = obj.data
    if obj.material_slots and not any(measured_slots(obj)):
        return faults
    if any(name not in mesh.attributes for name in (THICKNESS_ATTRIBUTE, KNOWN_ATTRIBUTE)):
        faults.append(Fault("Its thickness is not known, so it does not glow", MEASURE))
    elif is_reshaped(mesh) and thickness_attribute.is_from_measurement(mesh):
        faults.append(Fault("Its mesh was edited after its thickness was measured", MEASURE))
    elif what := thickness_attribute.measured_otherwise(obj, bpy.context.scene):
        other = thickness_attribute.user_that_fits(obj)
        if other is not None:
            what = f"{what}; it is that of '{other.name}', which has the same mesh"
        faults.append(Fault(what, MEASURE if other is None else OWN_MESH))
    elif thickness_attribute.is_from_measurement(mesh) and is_stretched(obj):
        # Hints: animation may squash and stretch it.
        other = next((o for o in thickness_attribute.sharing_skins(obj) if not is_stretched(o)), None)
        what = "It was scaled unevenly after its thickness was measured"
        if other is not None:
            what = f"It is scaled unlike '{other.name}', which has the same mesh and so its thickness"
        faults.append(Fault(what, MEASURE if other is None else OWN_MESH, is_hint=True))
    return faults


def _group_faults(group: bpy.types.NodeTree) -> Iterator[Fault]:
    images = images_of(group)
    if len(images) != len(SLOTS):
        yield Fault("An image of its lookup was deleted", REPAIR)
    elif group.library is None and images[0].library is not None:
        yield Fault("Its node group was made local without its images", REPAIR)
    if nodes_of(group).tiles and len(TILES.all_of(group)) != len(SLOTS):
        yield Fault("An image of its tiles was deleted", REPAIR)


def _reference_faults(obj: bpy.types.Object) -> Iterator[Fault]:
    settings, layer = obj.skinglow, bpy.context.view_layer
    if settings.reference != "OBJECT":
        return
    reference, bone = settings.reference_object, settings.reference_bone
    if reference is None or (bone and (reference.pose is None or bone not in reference.pose.bones)):
        yield Fault("The object or bone that it measures light distances from is missing", CHOOSE_REFERENCE)
    # Of a skin that this layer does not show, another one knows more.
    elif layer is not None and obj.name in layer.objects and not is_followed(reference, layer):
        what = f"'{reference.name}' is not evaluated in this view layer (excluded or disabled)"
        yield Fault(f"{what}: the distance of its lights does not follow it", INCLUDE_REFERENCE)


def _frozen_faults(obj: bpy.types.Object, group: bpy.types.NodeTree) -> list[Fault]:
    """At the frame that the viewport showed last; none before it was looked at."""
    if key_of(obj) not in SESSION.marks:
        return []
    frame, mark = SESSION.marks[key_of(obj)]
    first, last = frozen_frames(group)
    missing = missing_file(group, frame) if shown_image(group) is not None else None
    if missing is not None:
        return [Fault(f"Its frozen image {missing} is missing", FREEZE_AGAIN)]
    if not first <= frame <= last:
        nearest = min(max(frame, first), last)
        return [Fault(f"It is frozen from frame {first} to {last}: frame {frame} shows frame {nearest}", FREEZE_MORE)]
    if frozen_mark(group, obj.skinglow.row, frame) not in ("", mark):
        return [Fault("Its lights, position or settings changed after it was frozen", FREEZE_AGAIN)]
    return []


def thickness_faults(obj: bpy.types.Object, depsgraph: bpy.types.Depsgraph) -> list[Fault]:
    """What a look at every vertex finds: a thickness that is not known where it is shown, or of another mesh."""
    slots = measured_slots(obj)
    if obj.material_slots and not any(slots):
        return []
    empty = [slot.material is None for slot in obj.material_slots]
    has_empty_faces = False
    with evaluated_mesh(obj.evaluated_get(depsgraph)) as mesh:
        if any(empty):
            has_empty_faces = bool(vertices_of_slots(mesh, empty).any())
        _thickness, known = thickness_attribute.read(mesh)
        if not known.all() and not all(slots):
            known = known[vertices_of_slots(mesh, slots)]
    faults = []
    if not known.all():
        share = np.count_nonzero(~known) / len(known)
        what = f"The thickness is not known at {share:.1%} of the vertices shown, which do not glow"
        faults.append(Fault(what, MEASURE_APPLIED))
    elif thickness_attribute.is_from_measurement(obj.data):
        user = thickness_attribute.measured_as(obj)
        if user is None:
            faults.append(Fault("Its mesh or its modifiers were edited after its thickness was measured", MEASURE))
        elif user != obj:
            what = f"Its thickness is that of '{user.name}', which has the same mesh and other modifiers"
            faults.append(Fault(what, OWN_MESH, is_hint=True))
    if has_empty_faces:
        faults.append(
            Fault("Faces in a material slot that is empty do not glow", "give the slot a material", is_hint=True)
        )
    return faults


def repair(obj: bpy.types.Object) -> None:
    """Makes a skin anew as far as something is wrong with it: nodes, images, thickness.

    A thickness that nothing is wrong with stays, as that of another skin with the same mesh, which would have the fault
    instead, or that of modifiers which are hidden only to work faster.
    """
    settings = obj.skinglow
    if is_frozen(settings.group) and shown_image(settings.group) is None:
        unfreeze([obj])
    measure = _asks_to_measure(obj)
    remake_skin(obj, measure=measure)
    if not measure and _asks_to_measure(obj):  # of a material that only now has the node
        remake_skin(obj, measure=True)


def _asks_to_measure(obj: bpy.types.Object) -> bool:
    return any(fault.remedy in (MEASURE, MEASURE_APPLIED) for fault in health(obj))


def require_health(scene: bpy.types.Scene, frames: Iterable[int]) -> None:
    """Raises SkinError with the faults of all skins that the scene renders, in these frames, but not for hints."""
    faults = []
    rendered = RenderedObjects(scene)
    depsgraph = bpy.context.evaluated_depsgraph_get()
    for obj in scene.objects:
        if obj.type != "MESH" or not obj.skinglow.enabled or not rendered.shows(obj):
            continue
        # The scene may be at any frame, and what the last render told the next one will tell.
        passed_over = {FREEZE_MORE}
        reference = obj.skinglow.reference_object
        if reference is not None and rendered.follows(reference):
            passed_over.add(INCLUDE_REFERENCE)  # what is disabled in the viewport alone
        now = _faults_now(obj, depsgraph)
        found = [fault for fault in now if not fault.is_hint and fault.remedy not in passed_over]
        if is_frozen(obj.skinglow.group):
            first, last = frozen_frames(obj.skinglow.group)
            missing = [frame for frame in frames if not first <= frame <= last]
            if missing:
                found.append(Fault(f"Frame {missing[0]} is not among its frozen ones, {first} to {last}", FREEZE_MORE))
        faults += [f"'{obj.name}': {fault}" for fault in found]
    if faults:
        raise SkinError("; ".join(faults))
