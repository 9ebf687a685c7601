# SPDX-License-Identifier: Apache-2.0
"""marked_scene.py -- inside Blender: marks a small scene by the add-on, exports and renders it,
and writes what it found as JSON. Part of run.py.

    blender -b --factory-startup --python marked_scene.py -- FOLDER PROGRAM

FOLDER has panels/oled.panel and pictures/codes.png. Lengths in metres.
"""
import contextlib
import io
import json
import os
import sys
import time
import types

import addon_utils
import bpy

FOLDER, PROGRAM = sys.argv[sys.argv.index("--") + 1:]
addon = addon_utils.enable("parhelion_addon", default_set=True)
found = {"version": list(bpy.app.version)}


def here(*names):
    return os.path.join(FOLDER, *names)


# ---- the scene -----------------------------------------------------------------------------


def new_material(name):
    material = bpy.data.materials.new(name)
    material.use_nodes = True
    material.use_backface_culling = True
    return material


def upright(name, material, x, z, width, height):
    """A sheet at y = 0 whose front looks to -y, with u to +x and v to +z."""
    mesh = bpy.data.meshes.new(name)
    mesh.from_pydata([(x, 0, z), (x + width, 0, z), (x + width, 0, z + height),
                      (x, 0, z + height)], [], [(0, 1, 2, 3)])
    corners = mesh.uv_layers.new(name="UV").data
    for corner, uv in zip(corners, ((0, 0), (1, 0), (1, 1), (0, 1))):
        corner.uv = uv
    mesh.materials.append(material)
    sheet = bpy.data.objects.new(name, mesh)
    bpy.context.scene.collection.objects.link(sheet)
    return sheet


def build():
    for thing in list(bpy.data.objects):
        bpy.data.objects.remove(thing)
    scene = bpy.context.scene
    cluster = new_material("cluster")
    marks = cluster.parhelion
    marks.kind, marks.panel, marks.level = "DISPLAY", here("panels", "oled.panel"), 0.5
    marks.content = here("pictures", "codes.png")
    upright("screen", cluster, -0.1, -0.05, 0.2, 0.1)
    pane = new_material("windscreen")
    pane.parhelion.kind = "GLAZING"
    for thickness, ior in ((2.1, 1.52), (0.76, 1.485), (2.1, 1.52)):
        layer = pane.parhelion.layers.add()
        layer.thickness_mm, layer.ior = thickness, ior
    pane.parhelion.layers[1].wedge_mrad = 0.3
    pane.parhelion.haze_share = 0.01
    pane.parhelion.coating_inside = "mgf2"
    upright("pane", pane, 1, 0, 0.5, 0.5)
    cover = new_material("cover")
    cover.parhelion.coating = "layers"
    cover.parhelion.thin_layers.add()
    upright("cover", cover, 2, 0, 0.5, 0.5)
    eye = bpy.data.objects.new("driver", None)
    eye.location, eye.parhelion.is_eye, eye.parhelion.fov_deg = (0, -2, 0), True, 2
    scene.collection.objects.link(eye)
    scene.parhelion.eye, scene.parhelion.spp = eye.name, 16
    scene.render.resolution_x, scene.render.resolution_y = 80, 40
    scene.render.resolution_percentage = 100
    scene.parhelion.latitude, scene.parhelion.longitude = 47.5, -8.25
    scene.parhelion.heading_deg, scene.parhelion.forward = 90, "-Y"
    return cluster


def attempt(operator, **arguments):
    """(what it printed, the error's text)."""
    out, error = io.StringIO(), ""
    with contextlib.redirect_stdout(out):
        try:
            operator(**arguments)
        except RuntimeError as fault:
            error = str(fault)
    return out.getvalue(), error


# ---- what is tried -------------------------------------------------------------------------


def export_whole():
    scene = bpy.context.scene
    scene.parhelion.has_sky = True
    found["lost"] = addon.export_scene(here("whole", "scene.gltf"))
    found["lost_glb"] = addon.export_scene(here("whole", "scene.glb"))
    scene.parhelion.has_sky = False
    found["operator"] = attempt(bpy.ops.parhelion.export, filepath=here("whole", "dark.gltf"))


def lose_marks(cluster):
    """Marks that are taken away are missed, by their material's name."""
    document = addon.read_document(here("whole", "scene.gltf"))
    folder = here("whole")
    bpy.context.scene.parhelion.has_sky = True
    wanted = addon.marked(bpy.context.scene, folder)
    bpy.context.scene.parhelion.has_sky = False
    lines = {"none": addon.lost(document, wanted)}
    for what, change in {
            "extension": lambda d: d["materials"][place]["extensions"].pop(addon.DISPLAY),
            "level": lambda d: display(d).update(level=1),
            "content": lambda d: display(d)["content"].update(index=99),
            "material": lambda d: d["materials"].pop(place),
            "listed": lambda d: d.pop("extensionsUsed"),
            "coordinates": lambda d: [p["attributes"].pop("TEXCOORD_0") for m in d["meshes"]
                                      for p in m["primitives"]],
            "environment": lambda d: d["scenes"][0].pop("extensions"),
            "eye": lambda d: [n.pop("camera", None) for n in d["nodes"]]}.items():
        broken = json.loads(json.dumps(document))
        place = [m["name"] for m in broken["materials"]].index(cluster.name)

        def display(d, place=place):
            return d["materials"][place]["extensions"][addon.DISPLAY]
        change(broken)
        lines[what] = addon.lost(broken, wanted)
    found["lines"] = lines


def lose_by_others():
    """Another add-on takes the extension away; then the menu's export without the object."""
    class Thief:
        def gather_material_hook(self, material, _blender_material, _settings):
            material.extensions.pop(addon.DISPLAY, None)
    sys.modules["thief"] = types.ModuleType("thief")
    sys.modules["thief"].glTF2ExportUserExtension = Thief
    entry = bpy.context.preferences.addons.new()
    entry.module = "thief"
    os.makedirs(here("menu"))
    found["thief"] = addon.export_scene(here("thief", "scene.gltf"))
    found["thief_menu"] = attempt(bpy.ops.export_scene.gltf, filepath=here("menu", "a.gltf"),
                                  export_format="GLTF_SEPARATE", export_cameras=True)
    bpy.context.preferences.addons.remove(entry)
    found["menu"] = attempt(bpy.ops.export_scene.gltf, filepath=here("menu", "b.gltf"),
                            export_format="GLTF_SEPARATE", export_cameras=True)


def break_panel(cluster):
    good = cluster.parhelion.panel
    for name, path in (("missing", here("panels", "none.panel")), ("empty", ""),
                       ("other", here("pictures", "codes.png"))):
        cluster.parhelion.panel = path
        found[f"broken_{name}"] = attempt(bpy.ops.parhelion.export,
                                          filepath=here("broken", "own.gltf"))[1]
        found[f"broken_{name}_menu"] = attempt(
            bpy.ops.export_scene.gltf, filepath=here("broken", "menu.gltf"),
            export_format="GLTF_SEPARATE")[1]
    cluster.parhelion.panel = good


def write_extras(cluster):
    """What a tool without the add-on can do: custom properties."""
    marks = {"panel": "../panels/oled.panel", "level": 0.25}
    cluster.parhelion.kind = "NONE"
    for name, value in (("object", marks), ("text", json.dumps(marks))):
        cluster[addon.DISPLAY] = value
        addon.export_scene(here("extras", name + ".gltf"))
    del cluster[addon.DISPLAY]
    cluster.parhelion.kind = "DISPLAY"


def render():
    preferences = bpy.context.preferences.addons["parhelion_addon"].preferences
    preferences.program = PROGRAM
    scene = bpy.context.scene
    scene.parhelion.folder = here("render")
    found["render"] = attempt(bpy.ops.parhelion.render)
    found["picture"] = [list(i.size) for i in bpy.data.images if i.name.endswith("scene.png")]
    scene.parhelion.has_sky, scene.parhelion.when = True, "yesterday"
    found["refused"] = attempt(bpy.ops.parhelion.render)
    scene.parhelion.has_sky = False
    preferences.program = here("no_program")
    found["no_program"] = attempt(bpy.ops.parhelion.render)
    preferences.program = PROGRAM


def cancel():
    """As ESC does it."""
    scene = bpy.context.scene
    scene.parhelion.spp = 1 << 20
    path = here("whole", "dark.gltf")
    run = addon.Run(addon.render_command(bpy.context, path))
    until = time.time() + 60
    while run.poll() is None and run.fraction <= 0 and time.time() < until:
        time.sleep(0.05)
    found["progress"] = run.fraction
    found["was_at_work"] = run.poll() is None
    run.stop()
    found["stopped"] = run.process.returncode


def export_lamps():
    """An area lamp of each shape, one of a narrow spread; what stood for them is gone."""
    scene = bpy.context.scene
    for i, shape in enumerate(("SQUARE", "RECTANGLE", "DISK", "ELLIPSE")):
        lamp = bpy.data.lights.new("Area", "AREA")
        lamp.shape, lamp.size, lamp.size_y, lamp.energy = shape, 0.5, 0.25, 10
        item = bpy.data.objects.new(f"Area.{i:03}", lamp)
        item.location, item.scale = (i, 0, 2), (2, 3, 1) if i == 1 else (1, 1, 1)
        scene.collection.objects.link(item)
    point = bpy.data.objects.new("point", bpy.data.lights.new("point", "POINT"))
    scene.collection.objects.link(point)
    before = [len(kind) for kind in (bpy.data.objects, bpy.data.meshes, bpy.data.materials)]
    found["lamps"] = [attempt(bpy.ops.parhelion.export, filepath=here("out", "lamps.gltf"))]
    found["left"] = [len(kind) - was for kind, was in zip(
        (bpy.data.objects, bpy.data.meshes, bpy.data.materials), before)]
    lamp.spread = 1
    found["lamps"].append(attempt(bpy.ops.parhelion.export, filepath=here("out", "no.gltf")))


def main():
    cluster = build()
    export_whole()
    lose_marks(cluster)
    lose_by_others()
    break_panel(cluster)
    write_extras(cluster)
    render()
    cancel()
    export_lamps()
    with open(here("found.json"), "w", encoding="utf-8") as file:
        json.dump(found, file)


main()
