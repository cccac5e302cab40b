"""Runs inside Blender: every mode on the head of the first picture, and the POV-Ray scene."""

from __future__ import annotations

import time
from collections.abc import Iterator
from contextlib import contextmanager
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import skinglow_blender as sb
from mathutils import Vector

from studies import scenes as stage
from studies.demo import light_rigs
from studies.heads import studio
from studies.heads.ears import Ear
from studies.in_blender import Steps

MODES = ("existing", "paper")
WEIGHTS = ("object", "surface")  # of mode physical
# Lookups are dark at the 3 to 8 mm of an ear; shaders that use them scale them up by hand. So does the demo, by one
# factor for both modes, which the page states.
STRENGTH = 40.0
BULB_W = 2.0
# Transmitted light is dark compared with direct light: the picture of mode physical is exposed for it.
EXPOSURE_STOPS = 2.0
ORANGE, BLUE = (1.0, 112 / 255, 69 / 255), (15 / 255, 64 / 255, 1.0)  # two lights of Table 1

#: As POV-Ray samples pixels; transmitted light alone has no noise.
EXACT = {
    "pixel_filter_type": "BOX",
    "samples": 64,
    "use_denoising": False,
    "use_adaptive_sampling": False,
    "sample_clamp_direct": 0.0,
}


@contextmanager
def soft_shadows() -> Iterator[None]:
    """Gives lights of hardly any size one while they are rendered: the shadow of an ear under them looks like a cut."""
    sizes = {"POINT": ("shadow_soft_size", 0.05), "SPOT": ("shadow_soft_size", 0.05), "SUN": ("angle", 0.15)}
    kept = []
    for light in bpy.data.lights:
        name, size = sizes.get(light.type, ("", 0.0))
        if name and getattr(light, name) < 0.2 * size:
            kept.append((light, name, getattr(light, name)))
            setattr(light, name, size)
    try:
        yield
    finally:
        for light, name, size in kept:
            setattr(light, name, size)


class Studio:
    """The scene and the results so far."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.out = Path(job["out"])
        bpy.ops.wm.open_mainfile(filepath=str(self.out / "head.blend"))
        self.scene = bpy.context.scene
        studio.settings(self.scene, job["size"], job["size"], job["samples"])
        studio.show_as_it_is(self.scene)
        studio.quicken(self.scene)
        self.head = bpy.data.objects["head"]
        self.ear = ear = Ear(np.array(job["ear"]["center"]), job["ear"]["size"], job["ear"]["side"])
        self.cameras = {
            "": studio.portrait_camera(self.scene, ear),
            "_ear": studio.camera(self.scene, ear, (-0.012, 0.0, 0.0), 0.11, light_rigs.CAMERA_AZIMUTH_DEGREES),
        }
        # Of rigs, and the reference point of distances.
        self.center = Vector((job["middle_x"], *ear.center[1:]))
        self.picture_s = 1.0 + job["render_s_per_sample"] * job["size"] ** 2 * job["samples"]
        self.tables: dict[str, np.ndarray] = {}
        self.lights: dict[str, Any] = {}

    def takes(self, pictures: int) -> str:
        """How long that many pictures take at the pace of the first one."""
        return f"{pictures} pictures, about {pictures * self.picture_s:.0f} s"

    def render(self, name: str, view: str) -> None:
        self.scene.camera = self.cameras[view]
        self.scene.render.filepath = str(self.out / name)
        bpy.ops.render.render(write_still=True)

    def show(self, name: str) -> None:
        """Renders head and ear in both modes with the current lights, and records the tables."""
        for mode in MODES:
            sb.make_skin(self.head, mode=mode)
            self.tables[f"{name}_{mode}"] = sb.lut(self.head, bpy.context.evaluated_depsgraph_get())
            with soft_shadows():
                for view in self.cameras:
                    self.render(f"{name}_{mode}{view}.png", view)
        self.lights[name] = sb.light_report(self.head, bpy.context.evaluated_depsgraph_get())

    def show_physical(self) -> None:
        """Mode physical, W/m^2 unscaled, a light behind the ear: lit per object and per pixel."""
        stage.remove_lights()
        studio.bulb(self.scene, self.ear, BULB_W)
        bpy.context.view_layer.update()
        self.scene.view_settings.exposure = EXPOSURE_STOPS
        for weights in WEIGHTS:
            sb.make_skin(self.head, mode="physical", weights=weights, strength=1.0)
            for view in self.cameras:
                self.render(f"physical_{weights}{view}.png", view)
        self.lights["physical"] = sb.light_report(self.head, bpy.context.evaluated_depsgraph_get())

    def show_light_output(self) -> None:
        """The picture, and the Light of the Skinglow node as an AOV: both linear, in an array file."""
        stage.add_light_aov(self.scene, self.head)
        settings = self.scene.render.image_settings
        settings.file_format, settings.color_depth = "OPEN_EXR", "32"
        self.render("light_output_picture.exr", "_ear")
        with stage.shown_pass(self.scene, stage.AOV):
            self.render("light_output_aov.exr", "_ear")
        settings.file_format, settings.color_depth = "PNG", "8"
        names = ("picture", "aov")
        np.savez(
            self.out / "light_output.npz", **{n: stage.pixels_of(self.out / f"light_output_{n}.exr") for n in names}
        )

    def render_transmitted_light(self) -> None:
        """Renders only the glow, as linear EXR: a box filter as in POV-Ray, alpha for the outline."""
        scene, settings = self.scene, self.scene.render.image_settings
        kept = {name: getattr(scene.cycles, name) for name in EXACT}
        for name, value in EXACT.items():
            setattr(scene.cycles, name, value)
        scene.render.film_transparent = True
        settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
        with stage.transmitted_light_only(self.head):
            self.render("light_through_blender.exr", "_ear")
        settings.file_format, settings.color_depth, settings.color_mode = "PNG", "8", "RGB"
        bpy.data.images["Render Result"].save_render(str(self.out / "light_through_blender.png"))
        scene.render.film_transparent = False
        for name, value in kept.items():
            setattr(scene.cycles, name, value)


def main(job: dict[str, Any]) -> dict[str, Any]:
    started = time.monotonic()
    step = Steps(of=9)
    step("opening the scene of the first picture: a second")
    made = Studio(job)
    stage.add_rig(made.scene, job["rigs"]["table1"], made.center)
    sb.register()
    state = sb.make_skin(made.head, mode="paper", weights="object", strength=STRENGTH, reference_point=made.center)
    step(f"Cycles: lights of Table 1, {made.takes(4)}")
    made.show("table1")
    step(f"Cycles: transmitted light only, {made.takes(1)}")
    made.render_transmitted_light()
    step("exporting the scene to POV-Ray: a few seconds")
    # The ear alone: eyes and hair are no skin, and are not written.
    made.scene.camera = made.cameras["_ear"]
    sb.export_povray(bpy.context.evaluated_depsgraph_get(), made.out / "povray")
    # For cross-checking, the POV-Ray macros compute the lookup themselves, from the lights and the base.
    sb.export_povray(
        bpy.context.evaluated_depsgraph_get(), made.out / "povray_light_through", surface=False, compute_lut=True
    )

    stage.remove_lights()
    bulb = studio.bulb(made.scene, made.ear, BULB_W)
    for color, values in (("orange", ORANGE), ("blue", BLUE)):
        step(f"Cycles: {color} light behind the ear, {made.takes(4)}")
        bulb.data.color = values
        made.show(color)
    step(f"Cycles: the rim lights, {made.takes(4)}")
    stage.add_rig(made.scene, job["rigs"]["rim"], made.center)
    made.show("rim")
    step(f"Cycles: mode physical, a light behind the ear, {made.takes(4)}")
    made.show_physical()
    step(f"Cycles: the transmitted light as an AOV, {made.takes(2)}")
    made.show_light_output()
    np.savez(made.out / "tables.npz", **made.tables)
    return {
        "blender": job["host"],
        "lights": made.lights,
        "strength": STRENGTH,
        "exposure_stops": EXPOSURE_STOPS,
        "max_thickness_mm": state.max_thickness_mm,
        "vertices": len(made.head.data.vertices),
        "blender_seconds": round(time.monotonic() - started, 1),
    }
