"""Runs in Blender, from a copy in a folder of its own: installs a package, or uses the one installed before.

Usage: installed_package.py RESULT.json (install ZIP | use | subscribe URL | upgrade)
What it finds goes into the JSON file; test_packages.py judges it.
"""

import json
import os
import sys
import traceback
import webbrowser
from pathlib import Path

OPENED: list[str] = []
sys.addaudithook(lambda event, args: OPENED.append(str(args[0])) if event == "open" else None)

import bpy  # noqa: E402

ADDON = "skinglow_blender"
TAKES_EXTENSIONS = bpy.app.version >= (4, 2, 0)


def addon_name():
    """What the preferences call the add-on; nothing while it is not enabled."""
    enabled = bpy.context.preferences.addons.keys()
    return next((name for name in enabled if name.split(".")[-1] == ADDON), None)


def install(package):
    """As a person does: from the file, enabled, kept in the preferences."""
    if TAKES_EXTENSIONS:
        bpy.ops.extensions.package_install_files(repo="user_default", filepath=package, enable_on_install=True)
    else:
        bpy.ops.preferences.addon_install(filepath=package)
        bpy.ops.preferences.addon_enable(module=ADDON)
    bpy.ops.wm.save_userpref()
    return {"enabled": addon_name()}


def subscribe(url):
    """As a person does with a repository: adds its address, and installs from it."""
    bpy.context.preferences.system.use_online_access = True
    bpy.ops.preferences.extension_repo_add(name="Ours", remote_url=url, type="REMOTE")
    repos = bpy.context.preferences.extensions.repos
    index = next(i for i, repo in enumerate(repos) if repo.remote_url == url)
    bpy.ops.extensions.repo_sync(repo_index=index)
    bpy.ops.extensions.package_install(repo_index=index, pkg_id=ADDON, enable_on_install=True)
    bpy.ops.wm.save_userpref()
    return installed_version()


def upgrade():
    """What the repository has anew."""
    bpy.ops.wm.read_userpref()
    bpy.ops.extensions.repo_sync_all()
    bpy.ops.extensions.package_upgrade_all()
    return installed_version()


def installed_version():
    """Of the extension that is enabled, by its manifest, and whether it works."""
    import skinglow_blender as sb

    name = addon_name()
    manifest = Path(sys.modules[name].__file__).with_name("blender_manifest.toml").read_text()
    version = next(line for line in manifest.splitlines() if line.startswith("version"))
    clear_scene()
    thickness = sb.make_skin(add_ball()).thickness_mm
    return {"enabled": name, "version": version.split('"')[1], "thickest_mm": float(max(thickness))}


def use():
    """In a new process: the core, the add-on by its own name, a skin, a render, and the way out."""
    if addon_name() is None:  # the bpy module starts without the user's preferences
        if bpy.app.version[:2] == (4, 2):  # that module crashes when it reads them, with no add-on either
            bpy.ops.preferences.addon_enable(module=f"bl_ext.user_default.{ADDON}")
        else:
            bpy.ops.wm.read_userpref()
    found = {"enabled": addon_name(), "search_path": sys.path[:]}
    import skinglow as sg
    import skinglow_blender as sb

    found["skinglow"], found["core"] = sg.__file__, sg._core.__file__
    found["addon"] = sb.make_skin.__code__.co_filename
    names = ("make_skin", "update", "lut", "render_batch", "batch_main")
    found["functions"] = [name for name in names if not callable(getattr(sb, name))]
    found["visible"] = follow_a_blocker(sb)
    found |= follow_a_light(sg, sb)
    found["preferences"] = use_preferences(sb, found["enabled"])
    found["refused"] = refusals(sg)
    found["rays"] = sys.modules["skinglow._rays"].__file__
    found["render"] = render()
    found["batch"] = batch(sb)
    found["warnings"] = warnings()
    found["manual"] = manual()
    found["opened"] = sorted({os.path.realpath(name) for name in OPENED if name.startswith("/")})
    maps = Path("/proc/self/maps").read_text().splitlines()
    found["mapped"] = sorted({line.split(None, 5)[5] for line in maps if "/" in line})
    bpy.ops.preferences.addon_disable(module=found["enabled"])
    handlers = [h for name in dir(bpy.app.handlers) for h in listed(getattr(bpy.app.handlers, name))]
    found["handlers_left"] = [h.__module__ for h in handlers if ADDON in h.__module__]
    found["removed"] = remove()
    return found


def listed(value):
    return value if isinstance(value, list) else []


def clear_scene():
    for obj in list(bpy.data.objects):
        bpy.data.objects.remove(obj)


def add_ball():
    bpy.ops.mesh.primitive_uv_sphere_add(radius=0.01, segments=48, ring_count=24)
    return bpy.context.object


def add_light(x):
    light = bpy.data.objects.new("Light", bpy.data.lights.new("Light", "POINT"))
    light.location, light.data.shadow_soft_size = (x, 0.0, 0.0), 0.0
    bpy.context.scene.collection.objects.link(light)
    return light


def follow_a_blocker(sb):
    """What a closed skin sees of its light with Occlusion on, and its brightness: alone, and behind walls.

    It would shadow itself if Embree had no occlusion filters, and fail if the modules did not share the type of lights.
    """
    clear_scene()
    bpy.context.scene.world = None  # its light passes no wall
    obj, light = add_ball(), add_light(1.0)
    sb.make_skin(obj, thickness=[3.0] * len(obj.data.vertices), mode="physical")
    found = {"off": shown_by(sb, obj, light)}
    bpy.context.scene.skinglow.occlusion = True
    found["alone"] = shown_by(sb, obj, light)
    bpy.ops.mesh.primitive_plane_add(size=0.5, location=(0.5, 0.25, 0.0), rotation=(0.0, 1.5707963, 0.0))
    wall = bpy.context.object
    found["half"] = shown_by(sb, obj, light)
    wall.location.y = 0.0
    found["wall"] = shown_by(sb, obj, light)
    bpy.context.scene.skinglow.occlusion = False
    return found


def shown_by(sb, obj, light):
    """The visible share of the light, and the sum of the skin's lookup table."""
    bpy.context.view_layer.update()
    depsgraph = bpy.context.evaluated_depsgraph_get()
    (row,) = (row for row in sb.light_report(obj, depsgraph) if row["name"] == light.name)
    return [row["visible"], float(sb.lut(obj, depsgraph).sum())]


def use_preferences(sb, addon):
    """The mode of a new skin by the preferences, and whether it followed a light with *live* off and on."""
    clear_scene()
    preferences = bpy.context.preferences.addons[addon].preferences
    preferences.mode = "PAPER"
    obj, light = add_ball(), add_light(0.02)
    bpy.ops.skinglow.make()
    followed = []
    for preferences.live in (False, True):
        before = sb.lut(obj, bpy.context.evaluated_depsgraph_get())
        light.location.x += 0.5
        bpy.context.view_layer.update()
        followed.append(bool((sb.lut(obj, bpy.context.evaluated_depsgraph_get()) != before).any()))
    preferences.property_unset("mode")
    return [obj.skinglow.mode, *followed]


def follow_a_light(sg, sb):
    """A ball of 20 mm, measured by rays, and what it shows before and after its light moves, by Eq. 1-3."""
    clear_scene()
    obj, light = add_ball(), add_light(0.0)
    light.data.color = (0.25, 0.5, 1.0)
    state = sb.make_skin(obj, mode="paper", reference_point=(0.0, 0.0, 0.0), max_thickness_mm=24.0)
    found = {"thickness_mm": list(state.thickness_mm), "shown": [], "expected": []}
    for x in (1.0, 3.0):
        light.location = (x, 0.0, 0.0)
        bpy.context.view_layer.update()
        found["shown"].append(sb.lut(obj, bpy.context.evaluated_depsgraph_get())[0].tolist())
        pairs = zip((1.8, 0.5, 0.4), light.data.color, strict=True)
        weight = [blood + color / (1.0 + x * x) for blood, color in pairs]
        found["expected"].append(sg.recolor(sg.six_gaussian_base(256, 24.0), weight)[0].tolist())
    return found


def refusals(sg):
    """The exceptions of both modules, each of which has to know its own; [] where there is none."""
    triangle = ([(0.0, 0.0, 0.0), (1.0, 0.0, 0.0), (0.0, 1.0, 0.0)], [(0, 1, 2)])
    light = sg.Light("POINT", power=1.0, position=(0.0, 0.0, 1.0))
    point = ([light], [(0.0, 0.0, 0.0)], [(0.0, 0.0, 1.0)])
    occluders = sg.Occluders([triangle])
    return {
        "attenuation": refusal(lambda: sg.attenuation(-1.0)),
        "file": refusal(lambda: sg.read_light_rig("/no/such/rig.json")),
        "type in _core": refusal(lambda: sg.six_gaussian_base("many")),
        "thickness": refusal(lambda: sg.thickness([(0, 0, 0)], [(0, 1, 2)])),
        "type in _rays": refusal(lambda: sg._rays_loader.load_rays().thickness_report(*triangle, "many")),
        "raised by progress": refusal(lambda: sg.thickness(*triangle, progress=lambda done: 1 / 0)),
        "cancelled": refusal(lambda: sg.thickness(*triangle, progress=lambda done: False)),
        "mesh": refusal(lambda: sg.Occluders([triangle, 5])),
        "samples": refusal(lambda: occluders.visible_fraction(*point, samples=0)),
        "no light": refusal(lambda: occluders.visible_fraction([5], *point[1:])),
    }


def refusal(function):
    try:
        function()
    except Exception as error:
        return [type(error).__name__, str(error)]
    return []


def render():
    """Cycles, by the Embree that Blender brings, in one process with ours: the picture's brightest value."""
    scene = bpy.context.scene
    scene.render.engine = "CYCLES"
    scene.cycles.device, scene.cycles.samples, scene.cycles.use_denoising = "CPU", 4, False
    scene.render.resolution_x = scene.render.resolution_y = 16
    scene.render.image_settings.file_format = "OPEN_EXR"
    scene.render.filepath = os.path.join(os.getcwd(), "picture.exr")
    scene.camera = bpy.data.objects.new("Camera", bpy.data.cameras.new("Camera"))
    scene.collection.objects.link(scene.camera)
    scene.camera.location, scene.camera.data.clip_start = (0.0, 0.0, 0.05), 1e-3
    bpy.ops.render.render(write_still=True)
    picture = bpy.data.images.load(scene.render.filepath)
    pixels = picture.pixels[:]
    return max(value for channel in range(3) for value in pixels[channel::4])


def batch(sb):
    """Two frames by a rig file, then again: how many were rendered and kept each time, and the manifest's lines."""
    rig = {"skinglow_rig": 1, "lights": [{"kind": "POINT", "power": 5.0, "position": [0.1, 0.0, 0.0]}]}
    Path("rig.json").write_text(json.dumps(rig))
    folder = Path.cwd() / "batch"
    runs = [sb.render_batch(folder, "1-2", ["rig.json"]) for _ in range(2)]
    counts = [[len(run.rendered), len(run.kept), len(run.failed)] for run in runs]
    return {"counts": counts, "lines": [json.loads(line)["rig"] for line in (folder / "manifest.jsonl").open()]}


def manual():
    """The page that the manual's button opens."""
    opened = []
    webbrowser.open = opened.append
    bpy.ops.skinglow.manual()
    return opened


def warnings():
    """What Blender holds against extensions: modules or search paths that break its rules."""
    import addon_utils

    find = getattr(addon_utils, "_extensions_warnings_get", None)
    return {name: list(texts) for name, texts in find().items()} if find else {}


def remove():
    """Takes an extension away by Blender's own uninstaller; what is left. Before 4.2 that needs a window."""
    if not TAKES_EXTENSIONS:
        return []
    repos = bpy.context.preferences.extensions.repos
    index = next(i for i, repo in enumerate(repos) if repo.module == "user_default")
    bpy.ops.extensions.package_uninstall(repo_index=index, pkg_id=ADDON)
    profile = Path(os.environ["BLENDER_USER_RESOURCES"])
    return [str(path.relative_to(profile)) for path in profile.rglob("*skinglow*")]


def main():
    result, task, *arguments = sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else sys.argv[1:]
    found = {"install": install, "use": use, "subscribe": subscribe, "upgrade": upgrade}[task](*arguments)
    Path(result).write_text(json.dumps(found, indent=1))


code = 0
try:
    main()
except BaseException:
    traceback.print_exc()
    code = 3
sys.stdout.flush()
sys.stderr.flush()
# The 4.5 wheel never comes back from an ordinary exit.
os._exit(code)
