"""Base colors that are pictures: whatever Blender opens, POV-Ray shows the colors of Blender's own render."""

import zlib

import bpy
import numpy as np
import skinglow_blender as sb

from inside.povray_files import color_of, matt_material, povray, surface_of
from inside.scenes import add_light, camera_above, depsgraph, patch, read_exr, render_settings

#: Format and ending of a file, and what else is odd with it.
FILES = {
    "png": ("PNG", ".png", {}),
    "capital letters": ("PNG", ".PNG", {}),
    "jpeg": ("JPEG", ".jpg", {}),
    "another gamma": ("PNG", ".png", dict(word=1.0)),
    "no ending": ("PNG", "", {}),
    "another's ending": ("PNG", ".jpg", {}),
    "tiff": ("TIFF", ".tif", {}),
    "targa": ("TARGA", ".tga", {}),
    "bmp": ("BMP", ".bmp", {}),
    "exr": ("OPEN_EXR", ".exr", dict(is_float=True)),
    "hdr": ("HDR", ".hdr", dict(is_float=True)),
    "numbers": ("PNG", ".png", dict(is_data=True)),
    "numbers, half transparent": ("PNG", ".png", dict(is_data=True, alpha=0.5)),
    "coded exr": ("OPEN_EXR", ".exr", dict(is_float=True, space="sRGB")),
    "half transparent": ("PNG", ".png", dict(alpha=0.5)),
    "half transparent, its alpha used": ("PNG", ".png", dict(alpha=0.5, alpha_used=True, allowed=1.2e-2)),
    "packed, no name": ("PNG", ".png", dict(packed="")),
    "packed as a GLB's": ("PNG", ".png", dict(packed="//textures/Image_0")),
    "packed, then painted": ("PNG", ".png", dict(packed="//a.png", painted=True)),
    "drawn": (None, "", {}),
    "drawn, half transparent": (None, "", dict(alpha=0.5)),
    "drawn, then packed": (None, "", dict(packed="")),
}


def picture(work, name, kind, ending, odd):
    alpha = odd.get("alpha", 1.0)
    image = bpy.data.images.new(name, 8, 8, alpha=True, float_buffer=odd.get("is_float", False))
    color = np.tile(np.array((0.5, 0.25, 0.75, alpha), np.float32), 64)
    image.pixels.foreach_set(color)
    image.update()
    if kind is not None:
        path = work / f"{name}{ending}"
        image.filepath_raw, image.file_format = str(path), kind
        image.save()
        bpy.data.images.remove(image)
        image = bpy.data.images.load(str(path))
    if odd.get("is_data"):
        image.colorspace_settings.name = "Non-Color"
    if odd.get("space"):
        image.colorspace_settings.name = odd["space"]
    if odd.get("word"):
        add_gamma(path, odd["word"])
        image.reload()
    if "packed" in odd:
        image.pack()
        image.filepath_raw = odd["packed"]
    if odd.get("painted"):
        image.pixels.foreach_set(np.tile(np.array((0.9, 0.3, 0.2, 1.0), np.float32), 64))
        image.update()
    return image


def add_gamma(path, gamma):
    """Puts a gAMA chunk into a PNG, which Blender passes over."""
    content = path.read_bytes()
    chunk = b"gAMA" + round(100000 * gamma).to_bytes(4, "big")
    added = (4).to_bytes(4, "big") + chunk + zlib.crc32(chunk).to_bytes(4, "big")
    path.write_bytes(content[:33] + added + content[33:])


def check_every_picture_is_shown_as_blender_shows_it(work):
    add_light("Sun", "SUN", energy=np.pi, location=(0.0, 0.0, 2.0)).data.angle = 0.0
    obj = patch(material=matt_material())
    obj.data.uv_layers.new()
    sb.make_skin(obj, thickness=[12.0] * 4, mode="existing", strength=0.0)
    camera_above(1.0)
    scene = render_settings(4, 4)
    tree = obj.active_material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    tree.links.new(texture.outputs["Color"], color_of(obj))
    never = tree.nodes.new("ShaderNodeMath")
    never.operation, never.inputs[1].default_value = "GREATER_THAN", 2.0
    tree.links.new(never.outputs[0], color_of(obj).node.inputs["Roughness"])
    found = {}
    for number, (name, (kind, ending, odd)) in enumerate(FILES.items()):
        texture.image = picture(work, f"{number} {name}", kind, ending, odd)
        alpha = texture.outputs["Alpha"]
        if odd.get("alpha_used"):
            tree.links.new(alpha, never.inputs[0])
        scene.render.filepath = str(work / f"{number}.exr")
        bpy.ops.render.render(write_still=True)
        expected = read_exr(work / f"{number}.exr")
        folder = work / f"scene {number}"
        files = sb.export_povray(depsgraph(), folder)
        assert not files.notes, (name, files.notes)
        povray(folder, "-A", "Declare=Skinglow_Part=1")
        shown = read_exr(folder / "scene.exr")
        found[name] = float(np.abs(shown - expected).max())
        for link in list(alpha.links):
            tree.links.remove(link)
        # Half floats, and the 8 bits of colors that were multiplied by alpha; Blender divides some by it again.
        assert found[name] <= odd.get("allowed", 4e-3), (name, found[name], shown[2, 2], expected[2, 2])
    return found


def check_a_picture_without_a_file_is_told(work):
    obj = patch(material=matt_material())
    obj.data.uv_layers.new()
    sb.make_skin(obj, thickness=[12.0] * 4, mode="existing")
    camera_above(1.0)
    tree = obj.active_material.node_tree
    texture = tree.nodes.new("ShaderNodeTexImage")
    tree.links.new(texture.outputs["Color"], color_of(obj))
    for ending in (".png", ".tga"):
        texture.image = picture(work, f"gone{ending}", "PNG", ending, {})
        (work / f"gone{ending}{ending}").unlink()
        texture.image.reload()
        notes = sb.export_povray(depsgraph(), work / "gone").notes
        assert len(notes) == 1 and "whose file is missing" in notes[0], notes


def check_holes_stay_holes(work):
    """An Image Texture whose alpha goes to the shader's."""
    obj = patch()
    obj.data.uv_layers.new()
    sb.make_skin(obj, thickness=[12.0] * 4, mode="existing", strength=0.0)
    camera_above(1.0)
    socket, tree = surface_of(obj)
    texture = tree.nodes.new("ShaderNodeTexImage")
    tree.links.new(texture.outputs["Color"], socket)
    tree.links.new(texture.outputs["Alpha"], socket.node.inputs["Alpha"])
    texture.image = picture(work, "holes", "PNG", ".png", dict(alpha=0.0))
    files = sb.export_povray(depsgraph(), work / "holes")
    assert not files.notes and work / "holes" / "surface.png" in files, files.notes
    texture.image = picture(work, "tiff", "TIFF", ".tif", dict(alpha=0.0))
    files = sb.export_povray(depsgraph(), work / "holes")
    assert len(files.notes) == 1 and "alpha of the picture" in files.notes[0], files.notes
