"""The same in EEVEE, which draws in software here: seconds for each frame, so few frames."""

import bpy
import numpy as np
import skinglow_blender as sb

from inside.rendered_frames import assert_frames, render_animation, scene_with_moving_light
from inside.scenes import BLOOD, add_light, black_material, camera_above, gray, patch, read_exr, render_settings


def check_animation_in_eevee(work):
    scene, _ = scene_with_moving_light()
    render_settings(16, 4, "EEVEE")
    scene.frame_end = 4
    render_animation(work / "eevee")
    # EEVEE hands out half floats.
    assert_frames(work / "eevee", 2e-3, last=4)


def check_objects_on_one_material_keep_apart(work):
    """Nine skins on one material in both engines, one a million times as bright; each shows its own lookup."""
    material = black_material()
    key = add_light("Key", location=(0.0, 0.0, 4.0))
    skins = []
    for i in range(9):
        obj = patch(f"Skin {i}", size=1.0, location=(i % 3 - 1.0, i // 3 - 1.0, 0.0), material=material)
        blood = (1e6, 1e6, 1e6) if i == 4 else (0.1 * i, 1.0 - 0.1 * i, 0.5)
        sb.make_skin(obj, thickness=[3.0] * 4, mode="paper", blood_weight=blood, reference_point=(0, 0, 0))
        skins.append(obj)
    assert len({obj.skinglow.row for obj in skins}) == 9
    camera_above(3.0)
    for engine, tolerance in (("CYCLES", 2e-5), ("EEVEE", 2e-3)):
        render_settings(9, 9, engine).render.filepath = str(work / f"apart_{engine}.exr")
        bpy.ops.render.render(write_still=True)
        picture = read_exr(work / f"apart_{engine}.exr")
        table = gray()
        entry = 3.0 / 12.0 * 255
        brightness = np.interp(entry, np.arange(256), table)
        for i, obj in enumerate(skins):
            blood = np.array(obj.skinglow.blood_weight, dtype=float)
            if engine == "EEVEE" and i == 4:
                continue  # beyond EEVEE's half floats
            expected = brightness * (blood + np.array(key.data.color) / 17.0)
            np.testing.assert_allclose(picture[3 * (i // 3) + 1, 3 * (i % 3) + 1], expected, rtol=tolerance)


def check_engines_agree(work):
    """Cycles and EEVEE on a flat patch: root of the mean square below 1/255."""
    scene_with_moving_light(64)
    pictures = []
    for engine in ("CYCLES", "EEVEE"):
        scene = render_settings(64, 64, engine)
        scene.render.filepath = str(work / f"agree_{engine}.exr")
        bpy.ops.render.render(write_still=True)
        pictures.append(read_exr(work / f"agree_{engine}.exr")[1:-1, 1:-1])
    rms = float(np.sqrt(np.mean((pictures[0] - pictures[1]) ** 2)))
    assert pictures[0].max() > 0.5
    assert rms <= 1 / 255, rms
    return rms


def check_batch_of_rigs(work):
    """Rig after rig in one process, the first one twice: each picture shows its own lookup."""
    colors = {"red": (1.0, 0.2, 0.0), "blue": (0.0, 0.2, 1.0)}
    for name, color in colors.items():
        add_light(name, color=color)
    sb.make_skin(patch(material=black_material()), thickness=[0.0] * 4, mode="paper")
    camera_above()
    render_settings(4, 4, "EEVEE")
    result = sb.render_batch(work / "batch", 1, {"first": "red", "second": "blue", "third": "red"})
    assert len(result.rendered) == 3, result
    for path, lit in zip(result.rendered, ("red", "blue", "red"), strict=True):
        expected = gray()[0] * (BLOOD + np.array(colors[lit]) / 2.0)
        np.testing.assert_allclose(read_exr(path)[2, 2], expected, rtol=2e-3, err_msg=str(path))
