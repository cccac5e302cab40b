"""Runs inside Blender: makes the head glow, renders it, writes the POV-Ray scene, reports to hosts.Host."""

from __future__ import annotations

import math
import time
from pathlib import Path
from typing import Any

import bpy
import numpy as np
import skinglow_blender as sb

from studies import scenes as stage
from studies.in_blender import Steps

MODES = ("existing", "paper")
WEIGHTS = ("object", "surface")  # of mode physical
# Lookups are dark at the 3 to 8 mm of an ear; shaders that use them scale them up by hand. So does the demo, by one
# factor for both modes, which the page states.
STRENGTH = 20.0
# Transmitted light is dark compared with direct light: the picture of mode physical is exposed for it.
EXPOSURE_STOPS = 2.0
ORANGE, BLUE = (1.0, 112 / 255, 69 / 255), (15 / 255, 64 / 255, 1.0)  # two lights of Table 1


class Studio:
    """The scene and the results so far."""

    def __init__(self, job: dict[str, Any]) -> None:
        self.out = Path(job["out"])
        self.scene = stage.empty_scene()
        self.scene.render.resolution_x = self.scene.render.resolution_y = job["size"]
        self.scene.cycles.samples = job["samples"]
        self.head = stage.load_head(job)
        stage.skin_surface(self.head, job["color_map"], job["normal_map"])
        azimuth = math.radians(job["camera_azimuth_degrees"])
        views = stage.views_of(self.head)
        self.cameras = {v: stage.aim_camera(self.scene, at, height, azimuth) for v, (at, height) in views.items()}
        self.center = stage.center_of(self.head)
        self.tables: dict[str, np.ndarray] = {}
        self.lights: dict[str, Any] = {}

    def render(self, name: str, view: str) -> None:
        self.scene.camera = self.cameras[view]
        self.scene.render.filepath = str(self.out / name)
        bpy.ops.render.render(write_still=True)

    def show(self, name: str) -> None:
        """Renders head and ear in both modes with the current lights, and records the tables."""
        for mode in MODES:
            sb.make_skin(self.head, mode=mode)
            self.tables[f"{name}_{mode}"] = sb.lut(self.head, bpy.context.evaluated_depsgraph_get())
            for view in self.cameras:
                self.render(f"{name}_{mode}{view}.png", view)
        self.lights[name] = sb.light_report(self.head, bpy.context.evaluated_depsgraph_get())

    def show_physical(self) -> None:
        """Mode physical, W/m^2 unscaled, a light behind the ear: lit per object and per pixel."""
        stage.light_behind_ear(self.scene, self.head)
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
        kept = scene.cycles.pixel_filter_type, scene.cycles.samples
        scene.cycles.pixel_filter_type, scene.cycles.samples = "BOX", 64
        scene.render.film_transparent = True
        settings.file_format, settings.color_depth, settings.color_mode = "OPEN_EXR", "32", "RGBA"
        with stage.transmitted_light_only(self.head):
            self.render("light_through_blender.exr", "_ear")
        settings.file_format, settings.color_depth, settings.color_mode = "PNG", "8", "RGB"
        bpy.data.images["Render Result"].save_render(str(self.out / "light_through_blender.png"))
        scene.render.film_transparent = False
        scene.cycles.pixel_filter_type, scene.cycles.samples = kept


def main(job: dict[str, Any]) -> dict[str, Any]:
    started = time.monotonic()
    step = Steps(of=10)
    step("loading the head")
    studio = Studio(job)
    stage.add_rig(studio.scene, job["rigs"]["table1"], studio.center)
    step(f"measuring the thickness of the skin at {len(studio.head.data.vertices):,} vertices")
    state = sb.make_skin(studio.head, mode="paper", strength=STRENGTH)
    bpy.ops.wm.save_as_mainfile(filepath=str(studio.out / "head.blend"))

    step("Cycles: lights of Table 1")
    studio.show("table1")
    step("Cycles: transmitted light only")
    studio.render_transmitted_light()
    step("exporting the scene to POV-Ray")
    studio.scene.camera = studio.cameras[""]
    sb.export_povray(bpy.context.evaluated_depsgraph_get(), studio.out / "povray")
    # For cross-checking, the POV-Ray macros compute the lookup themselves, from the lights and the base.
    studio.scene.camera = studio.cameras["_ear"]
    sb.export_povray(
        bpy.context.evaluated_depsgraph_get(), studio.out / "povray_light_through", surface=False, compute_lut=True
    )

    for name in ("Light1", "Light3"):
        bpy.data.objects.remove(bpy.data.objects[name])
    for color, values in (("orange", ORANGE), ("blue", BLUE)):
        step(f"Cycles: {color} light behind the ear")
        bpy.data.objects["Light2"].data.color = values
        studio.show(color)
    step("Cycles: the rim lights")
    stage.add_rig(studio.scene, job["rigs"]["rim"], studio.center)
    studio.show("rim")
    step("Cycles: mode physical, a light behind the ear")
    studio.show_physical()
    step("Cycles: the transmitted light as an AOV")
    studio.show_light_output()
    np.savez(studio.out / "tables.npz", **studio.tables)
    return {
        "blender": job["host"],
        "lights": studio.lights,
        "strength": STRENGTH,
        "exposure_stops": EXPOSURE_STOPS,
        "max_thickness_mm": state.max_thickness_mm,
        "vertices": len(studio.head.data.vertices),
        "blender_seconds": round(time.monotonic() - started, 1),
    }
