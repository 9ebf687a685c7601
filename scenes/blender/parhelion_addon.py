# SPDX-License-Identifier: Apache-2.0
"""parhelion_addon.py -- Parhelion in Blender (3.4 and newer): install this one file.

Marks materials as displays, laminated panes and coated glass, empties as eyes, and a scene with
its place, moment and heading. The marks are written by Blender's own glTF exporter, as the
extensions that the program reads, and looked for again in what was written. "Render with
Parhelion" exports, runs the program and loads its picture.

Blender's +Y is glTF's -Z. Files are written relative to the .gltf.
"""
import json
import math
import os
import queue
import shutil
import struct
import subprocess
import threading
import time
import urllib.parse

import bpy
from bpy.props import (BoolProperty, CollectionProperty, EnumProperty, FloatProperty,
                       IntProperty, PointerProperty, StringProperty)

bl_info = {
    "name": "Parhelion",
    "author": "Parhelion's authors",
    "version": (1, 0, 0),
    "blender": (3, 4, 0),
    "location": "Properties: Material, Object and Scene",
    "description": "Measured displays, panes and daylight; renders with Parhelion",
    "category": "Render",
}

DISPLAY, GLAZING, COATING, ENVIRONMENT = (
    "PARHELION_" + name for name in ("display", "glazing", "coating", "environment"))
PICTURES = (".png", ".jpg", ".jpeg")
STACKS = [("none", "None", "no coating"),
          ("bare", "Bare", "glass of n 1.52: 4.3 % a face"),
          ("mgf2", "MgF2", "one layer: 1.3 %, purple"),
          ("broadband_ar", "Broadband AR", "four layers: 0.1 %"),
          ("ir_windscreen", "Heat-reflecting", "silver between oxides")]


class Wrong(Exception):
    """What the user is to mend, in one line."""


def plain(number):
    """Blender keeps single precision; 48.14 is meant, not 48.13999938964844."""
    return float(f"{number:.7g}")


# ---- what is marked ------------------------------------------------------------------------


class ParhelionGlassLayer(bpy.types.PropertyGroup):
    """One layer of a pane."""
    thickness_mm: FloatProperty(name="Thickness", default=2.1, min=0.001, max=100, precision=3,
                                description="mm")
    ior: FloatProperty(name="Index", default=1.52, min=1, max=4, precision=3)
    transmission: FloatProperty(name="Transmission", default=1, min=0, max=1, precision=3,
                                description="Along the normal, faces not included")
    file: StringProperty(name="Measured", subtype="FILE_PATH",
                         description="CSV of nm,value in place of the number")
    wedge_mrad: FloatProperty(name="Wedge", default=0, min=0, max=10, precision=3)
    toward: EnumProperty(name="Thicker towards", items=[(w, w, "") for w in
                                                        ("+u", "-u", "+v", "-v")],
                         default="+v")


class ParhelionThinLayer(bpy.types.PropertyGroup):
    """One layer of a coating."""
    n: FloatProperty(name="n", default=1.38, min=0, max=100, precision=4)
    k: FloatProperty(name="k", default=0, min=0, max=100, precision=4)
    file: StringProperty(name="Measured", subtype="FILE_PATH",
                         description="CSV of nm,n,k in place of the numbers")
    thickness_nm: FloatProperty(name="Thickness", default=99.6, min=0, max=1e6, precision=1)


class ParhelionMaterial(bpy.types.PropertyGroup):
    kind: EnumProperty(name="Material is", items=[
        ("NONE", "As Blender shows it", ""), ("DISPLAY", "A display", "a measured panel"),
        ("GLAZING", "A laminated pane", "one sheet of faces, its front outside")])
    panel: StringProperty(name="Panel", subtype="FILE_PATH",
                          description="The fitted .panel file")
    content: StringProperty(name="Content", subtype="FILE_PATH",
                            description="PNG or JPEG of the codes that the panel receives; "
                            "empty: full white")
    level: FloatProperty(name="Level", default=1, min=0, max=1, precision=3,
                         description="Backlight; multiplies all that the display emits")
    uv_map: IntProperty(name="UV map", default=0, min=0, max=7,
                        description="Place of the content's UV map in the mesh's list")
    layers: CollectionProperty(type=ParhelionGlassLayer)
    haze_share: FloatProperty(name="Haze", default=0, min=0, max=1, precision=4,
                              description="Share of the light that dirt scatters forward")
    haze_width_deg: FloatProperty(name="Width", default=8, min=0.1, max=60)
    coating_outside: EnumProperty(name="Coating outside", items=STACKS)
    coating_inside: EnumProperty(name="Coating inside", items=STACKS)
    coating: EnumProperty(name="Coating", items=STACKS + [("layers", "Own layers", "")])
    thin_layers: CollectionProperty(type=ParhelionThinLayer)
    faces: EnumProperty(name="Faces", items=[("both", "Both", ""), ("front", "Front", ""),
                                             ("back", "Back", "")])


class ParhelionObject(bpy.types.PropertyGroup):
    is_eye: BoolProperty(name="Eye", description="This empty is an eye: it looks along its +Y "
                         "(green), its +Z (blue) is up")
    fov_deg: FloatProperty(name="Field of view", default=40, min=1, max=170,
                           description="Of the picture's height, degrees")


FORWARD = {"+Y": [0, 0, -1], "-Y": [0, 0, 1], "+X": [1, 0, 0], "-X": [-1, 0, 0]}


class ParhelionScene(bpy.types.PropertyGroup):
    has_sky: BoolProperty(name="Daylight", description="A clear sky of this place and moment")
    latitude: FloatProperty(name="Latitude", default=48.14, min=-90, max=90, precision=4)
    longitude: FloatProperty(name="Longitude", default=11.58, min=-180, max=180, precision=4)
    altitude_m: FloatProperty(name="Altitude", default=500, min=-450, max=20000)
    when: StringProperty(name="When", default="2026-06-21T08:30+02:00",
                         description="Date, time and the offset from UTC")
    turbidity: FloatProperty(name="Turbidity", default=2.5, min=1, max=30)
    heading_deg: FloatProperty(name="Heading", min=-360, max=360,
                               description="Compass heading of the vehicle, degrees")
    forward: EnumProperty(name="Vehicle points to", items=[(w, w, "") for w in FORWARD])
    eye: StringProperty(name="Seen from", description="An eye or a camera; empty: the scene's")
    spp: IntProperty(name="Samples", default=64, min=1, max=1 << 20)
    folder: StringProperty(name="Folder", subtype="DIR_PATH",
                           description="Where scene and frame go; empty: a temporary folder")


# ---- marks as extensions -------------------------------------------------------------------


def absolute(path):
    return os.path.normpath(os.path.abspath(bpy.path.abspath(path)))


def uri_of(path, folder):
    try:
        path = os.path.relpath(absolute(path), folder)
    except ValueError as error:  # another drive
        raise Wrong(f"{path}: {error}") from error
    return urllib.parse.quote(path.replace(os.sep, "/"))


def file_uri(path, folder, what, magic=b""):
    """The URI of a file that is there and begins with these bytes."""
    found = absolute(path)
    try:
        with open(found, "rb") as file:
            begin = file.read(len(magic))
    except OSError as error:
        raise Wrong(f"{what} {found}: {error.strerror}") from error
    if begin != magic:
        raise Wrong(f"{what} {found} is no file of that kind")
    return uri_of(found, folder)


def picture_uri(path, folder):
    """The file itself is named: codes are no colours that Blender might convert."""
    if not path.lower().endswith(PICTURES):
        raise Wrong(f"content {absolute(path)}: PNG or JPEG is required")
    return file_uri(path, folder, "content")


def display_of(marks, folder):
    if not marks.panel:
        raise Wrong("the display has no panel")
    out = {"panel": file_uri(marks.panel, folder, "panel", b"PHPANEL\n"),
           "level": plain(marks.level)}
    if marks.content:
        out["content"] = {"uri": picture_uri(marks.content, folder), "texCoord": marks.uv_map}
    return out


def glass_layer(layer, folder):
    out = {"thickness_m": plain(layer.thickness_mm / 1000), "ior": plain(layer.ior),
           "transmission": file_uri(layer.file, folder, "transmission") if layer.file
           else plain(layer.transmission)}
    if layer.wedge_mrad > 0:
        out.update(wedge_rad=plain(layer.wedge_mrad / 1000), wedge_toward=layer.toward)
    return out


def glazing_of(marks, folder):
    if not marks.layers:
        raise Wrong("the pane has no layers")
    out = {"layers": [glass_layer(layer, folder) for layer in marks.layers]}
    if marks.haze_share > 0:
        out["haze"] = {"share": plain(marks.haze_share),
                       "width_deg": plain(marks.haze_width_deg)}
    for face in ("coating_outside", "coating_inside"):
        if getattr(marks, face) != "none":
            out[face] = {"stack": getattr(marks, face)}
    return out


def thin_layer(layer, folder):
    out = {"thickness_nm": plain(layer.thickness_nm)}
    if layer.file:
        return {**out, "n": file_uri(layer.file, folder, "index")}
    return {**out, "n": plain(layer.n), "k": plain(layer.k)}


def coating_of(marks, folder):
    if marks.coating != "layers":
        out = {"stack": marks.coating}
    elif marks.thin_layers:
        out = {"layers": [thin_layer(layer, folder) for layer in marks.thin_layers]}
    else:
        raise Wrong("the coating has no layers")
    if marks.faces != "both":
        out["faces"] = marks.faces
    return out


def extensions_of(material, folder):
    """{extension: its object} of a material; a content is {"uri", "texCoord"}."""
    marks, out = material.parhelion, {}
    try:
        if marks.kind == "DISPLAY":
            out[DISPLAY] = display_of(marks, folder)
        if marks.kind == "GLAZING":
            out[GLAZING] = glazing_of(marks, folder)
        elif marks.coating != "none":
            out[COATING] = coating_of(marks, folder)
    except Wrong as error:
        raise Wrong(f'material "{material.name}": {error}') from error
    return out


def environment_of(marks):
    if not marks.has_sky:
        return {}
    out = {"type": "sky", "when": marks.when, "turbidity": plain(marks.turbidity),
           "where": [plain(x) for x in (marks.latitude, marks.longitude, marks.altitude_m)],
           "heading_deg": plain(marks.heading_deg)}
    if marks.forward != "+Y":
        out["forward"] = FORWARD[marks.forward]
    return {ENVIRONMENT: out}


def objects_of(scene):
    """Those of the scene, and of the collections that stand in it as instances."""
    seen, waiting = [], list(scene.objects)
    while waiting:
        item = waiting.pop()
        if item in seen:
            continue
        seen.append(item)
        if item.instance_type == "COLLECTION" and item.instance_collection:
            waiting += list(item.instance_collection.all_objects)
    return seen


def marked(scene, folder):
    """What the scene's file has to hold: materials and eyes by name, and the sky."""
    objects, materials = objects_of(scene), {}
    for item in objects:
        for slot in item.material_slots:
            if slot.material and slot.material.name not in materials:
                found = extensions_of(slot.material, folder)
                if found:
                    materials[slot.material.name] = found
    return {"materials": materials, "environment": environment_of(scene.parhelion),
            "eyes": [o.name for o in objects if o.type == "EMPTY" and o.parhelion.is_eye]}


# ---- area lamps: glTF has none, a sheet that glows as they do takes their place -------------

LUMENS_A_WATT = 683  # as Blender's exporter writes its other lamps
LAMP_WATTS = "area_lamp_w"  # in the extras of what stands for a lamp


def outline_of(lamp):
    """Corners of an area lamp in its own plane, whose front looks along its -Z."""
    across = lamp.size
    along = lamp.size_y if lamp.shape in ("RECTANGLE", "ELLIPSE") else across
    if lamp.shape in ("SQUARE", "RECTANGLE"):
        corners = [(.5, .5), (.5, -.5), (-.5, -.5), (-.5, .5)]
    else:
        turns = [-math.tau * i / 32 for i in range(32)]
        corners = [(.5 * math.cos(turn), .5 * math.sin(turn)) for turn in turns]
    return [(across * x, along * y, 0) for x, y in corners]


def sheet_for(item):
    """Blender's area lamp of P watts shines with P / (4 area) W/(m2 sr), whatever its shape."""
    lamp, mesh = item.data, bpy.data.meshes.new(item.name)
    if lamp.spread < math.pi - 1e-4:
        raise Wrong(f'area lamp "{item.name}": its spread is {math.degrees(lamp.spread):g} '
                    f'degrees, required: 180: what glows has no other')
    corners = outline_of(lamp)
    mesh.from_pydata(corners, [], [tuple(range(len(corners)))])
    material = bpy.data.materials.new(f"{item.name} (area lamp)")
    material.use_nodes = material.use_backface_culling = True
    material[LAMP_WATTS] = lamp.energy
    inputs = material.node_tree.nodes["Principled BSDF"].inputs
    inputs["Base Color"].default_value = (0, 0, 0, 1)
    inputs["Emission" if "Emission" in inputs else "Emission Color"].default_value = (
        *lamp.color, 1)
    mesh.materials.append(material)
    sheet = bpy.data.objects.new(material.name, mesh)
    sheet.matrix_world = item.matrix_world
    places = [sheet.matrix_world @ vertex.co for vertex in mesh.vertices]
    area = abs(sum(((b - places[0]).cross(c - places[0]).length for b, c in
                    zip(places[1:], places[2:])), 0)) / 2
    inputs["Emission Strength"].default_value = LUMENS_A_WATT * lamp.energy / (4 * area)
    return sheet


def put_sheets(scene):
    """A sheet beside each area lamp that is shown, until the export is over."""
    bpy.context.view_layer.update()
    for item in list(scene.objects):
        if item.type != "LIGHT" or item.data.type != "AREA" or not item.visible_get():
            continue
        sheet = sheet_for(item)
        _export["sheets"].append(sheet)
        scene.collection.objects.link(sheet)
        sheet.select_set(item.select_get())
    bpy.context.view_layer.update()


def take_sheets():
    for sheet in _export["sheets"]:
        mesh, material = sheet.data, sheet.data.materials[0]
        bpy.data.objects.remove(sheet)
        bpy.data.meshes.remove(mesh)
        bpy.data.materials.remove(material)
    _export["sheets"] = []


# ---- what became of the marks --------------------------------------------------------------


def read_document(path):
    """The JSON of a .gltf or .glb."""
    with open(path, "rb") as file:
        data = file.read()
    if data[:4] == b"glTF":
        data = data[20:20 + struct.unpack_from("<I", data, 12)[0]]
    return json.loads(data)


def item(document, collection, index):
    items = document.get(collection) or []
    return items[index] if isinstance(index, int) and 0 <= index < len(items) else {}


def as_marked(document, name, value):
    """An extension as extensions_of would say it."""
    value = dict(value)
    if name == DISPLAY and "content" in value:
        info = value["content"]
        texture = item(document, "textures", info.get("index"))
        image = item(document, "images", texture.get("source"))
        value["content"] = {"uri": image.get("uri"), "texCoord": info.get("texCoord", 0)}
    return value


def lost_of_material(document, index, name, wanted):
    found = document["materials"][index].get("extensions") or {}
    for extension, value in wanted.items():
        if extension not in found:
            yield f'material "{name}": {extension} was lost'
        elif as_marked(document, extension, found[extension]) != value:
            yield f'material "{name}": {extension} is not as it was marked'
        elif extension not in (document.get("extensionsUsed") or []):
            yield f'material "{name}": {extension} is not listed in extensionsUsed'
    needs = "TEXCOORD_%d" % wanted.get(DISPLAY, {}).get("content", {}).get("texCoord", 0)
    if DISPLAY in wanted and any(
            part.get("material") == index and needs not in part["attributes"]
            for mesh in document.get("meshes") or [] for part in mesh["primitives"]):
        yield f'material "{name}": a mesh that wears the display has no UV map ({needs})'


def lost(document, wanted):
    """One line for each mark that the document does not hold."""
    lines, names = [], [m.get("name") for m in document.get("materials") or []]
    for name, extensions in wanted["materials"].items():
        if name not in names:
            lines.append(f'material "{name}" was lost: nothing that was exported wears it')
        for index in (i for i, own in enumerate(names) if own == name):
            lines += lost_of_material(document, index, name, extensions)
    scene = item(document, "scenes", document.get("scene", 0)).get("extensions") or {}
    for extension, value in wanted["environment"].items():
        if scene.get(extension) != value:
            lines.append(f"scene: {extension} was lost")
    seeing = [n.get("name") for n in document.get("nodes") or [] if "camera" in n]
    lines += [f'eye "{name}" was lost' for name in wanted["eyes"] if name not in seeing]
    return lines


# ---- the exporter's hooks (found by their names) -------------------------------------------

_export = {"wanted": None, "faults": [], "tree": None, "is_ours": False, "sheets": []}


def glTF2_pre_export_callback(export_settings):
    """An exception here ends the export before anything is written, in every version."""
    folder = os.path.normpath(export_settings["gltf_filedirectory"])
    _export.update(faults=[], tree=None, wanted=None)
    take_sheets()
    try:
        _export["wanted"] = marked(bpy.context.scene, folder)
        if export_settings.get("gltf_lights", True):
            put_sheets(bpy.context.scene)
    except Wrong as error:
        _export["faults"].append(str(error))
        raise


def glTF2_post_export_callback(export_settings):
    """Runs before the file is written: whoever exported by the menu is told a moment later."""
    take_sheets()
    if _export["faults"]:
        raise Wrong(_export["faults"][0])
    if _export["is_ours"] or not _export["wanted"]:
        return
    if not bpy.app.background:
        path, wanted = export_settings["gltf_filepath"], _export["wanted"]
        bpy.app.timers.register(lambda: tell_lost(path, wanted), first_interval=0.2)
    elif _export["tree"]:
        for line in lost(_export["tree"].to_dict(), _export["wanted"]):
            print("Parhelion:", line)


def tell_lost(path, wanted):
    lines = lost(read_document(path), wanted)

    def draw(menu, _context):
        for line in lines:
            menu.layout.label(text=line)
    if lines:
        bpy.context.window_manager.popup_menu(draw, title="Parhelion", icon="ERROR")


class glTF2ExportUserExtension:
    is_critical = True  # since 2025 a hook's fault ends the export; before, post_export does

    def __init__(self):
        from io_scene_gltf2.io.com import gltf2_io
        from io_scene_gltf2.io.com.gltf2_io_extensions import Extension
        self.types, self.extension, self.textures = gltf2_io, Extension, {}

    def clean(self, owner):
        """Some versions take an add-on's properties for custom ones."""
        if isinstance(owner.extras, dict):
            owner.extras.pop("parhelion", None)
            owner.extras = owner.extras or None

    def put(self, owner, name, value):
        if owner.extensions is None:
            owner.extensions = {}
        owner.extensions[name] = self.extension(name=name, extension=value, required=False)

    def texture_info(self, content):
        uri, types = content["uri"], self.types
        if uri not in self.textures:
            image = types.Image(buffer_view=None, extensions=None, extras=None, mime_type=None,
                                name=os.path.basename(urllib.parse.unquote(uri)), uri=uri)
            sampler = types.Sampler(extensions=None, extras=None, mag_filter=9728,
                                    min_filter=9728, name=None, wrap_s=33071, wrap_t=33071)
            self.textures[uri] = types.Texture(extensions=None, extras=None, name=None,
                                               sampler=sampler, source=image)
        return types.TextureInfo(extensions=None, extras=None, index=self.textures[uri],
                                 tex_coord=content["texCoord"])

    def gather_material_hook(self, gltf2_material, blender_material, export_settings):
        self.clean(gltf2_material)
        folder = os.path.normpath(export_settings["gltf_filedirectory"])
        try:
            found = extensions_of(blender_material, folder)
        except Wrong as error:  # of a material that pre_export did not find in the scene
            _export["faults"].append(str(error))
            raise
        if LAMP_WATTS in blender_material:
            gltf2_material.extras = {LAMP_WATTS: blender_material[LAMP_WATTS]}
        for name, value in found.items():
            if "content" in value:
                value = {**value, "content": self.texture_info(value["content"])}
            self.put(gltf2_material, name, value)

    def gather_node_hook(self, gltf2_node, blender_object, _export_settings):
        self.clean(gltf2_node)
        if blender_object and blender_object.type == "LIGHT" and (
                blender_object.data.type == "AREA"):
            gltf2_node.extras = {**(gltf2_node.extras or {}),
                                 LAMP_WATTS: blender_object.data.energy}
        if not blender_object or blender_object.type != "EMPTY" or (
                not blender_object.parhelion.is_eye):
            return
        types = self.types
        lens = types.CameraPerspective(
            aspect_ratio=None, extensions=None, extras=None, zfar=None, znear=0.01,
            yfov=math.radians(blender_object.parhelion.fov_deg))
        gltf2_node.camera = types.Camera(
            extensions=None, extras=None, name=blender_object.name, orthographic=None,
            perspective=lens, type="perspective")

    def gather_scene_hook(self, gltf2_scene, blender_scene, _export_settings):
        self.clean(gltf2_scene)
        for name, value in environment_of(blender_scene.parhelion).items():
            self.put(gltf2_scene, name, value)

    def gather_gltf_extensions_hook(self, gltf2, _export_settings):
        _export["tree"] = gltf2


def export_scene(path):
    """Exports the scene; one line for each mark that is not in the file."""
    export = bpy.ops.export_scene.gltf
    known = export.get_rna_type().properties.keys()
    wanted = {"export_format": "GLB" if path.endswith(".glb") else "GLTF_SEPARATE",
              "export_cameras": True, "export_lights": True, "export_apply": True,
              "export_animations": False, "export_extras": True, "use_active_scene": True}
    os.makedirs(os.path.dirname(path), exist_ok=True)
    _export.update(is_ours=True, faults=[])
    try:
        export(filepath=path, **{key: value for key, value in wanted.items() if key in known})
    except RuntimeError as error:  # an operator's: a traceback
        raise Wrong((_export["faults"] or [str(error).strip()])[0]) from error
    finally:
        _export["is_ours"] = False
        take_sheets()
    return lost(read_document(path), _export["wanted"])


# ---- rendering -----------------------------------------------------------------------------


def program():
    addon = bpy.context.preferences.addons.get(__name__)
    path = addon.preferences.program if addon else ""
    found = absolute(path) if path else shutil.which("parhelion")
    if not found or not os.path.isfile(found):
        raise Wrong(f"the program {path or 'parhelion'} is not there: set it in the add-on's "
                    "preferences")
    return found


def outside_root(path):
    """A file may name what lies in the parent of its folder; --root adds one more folder."""
    folder, uris = os.path.dirname(path), []

    def collect(value):
        for key, own in value.items() if isinstance(value, dict) else enumerate(value):
            if key in ("uri", "panel", "n", "k", "transmission") and isinstance(own, str):
                uris.append(own)
            elif isinstance(own, (dict, list)):
                collect(own)
    collect(read_document(path))
    files = [os.path.realpath(os.path.join(folder, urllib.parse.unquote(uri)))
             for uri in uris if not uri.startswith("data:")]
    home = os.path.dirname(os.path.realpath(folder))
    if all(os.path.commonpath([home, file]) == home for file in files):
        return []
    return ["--root", os.path.commonpath([os.path.dirname(file) for file in files])]


def render_command(context, path):
    scene, base = context.scene, os.path.splitext(path)[0]
    share = scene.render.resolution_percentage / 100
    size = [max(1, round(n * share)) for n in (scene.render.resolution_x,
                                               scene.render.resolution_y)]
    eye = scene.parhelion.eye or (scene.camera.name if scene.camera else "")
    command = [program(), "render", path, "-o", base + ".exr", "--png", base + ".png", "--size",
               f"{size[0]}x{size[1]}", "--spp", str(scene.parhelion.spp), "--layers", "all",
               "--progress", "json"]
    return command + (["--camera", eye] if eye else []) + outside_root(path)


class Run:
    """The program at work: how far it is, and what it says."""

    def __init__(self, command):
        self.fraction, self.lines, self.queue = 0.0, [], queue.Queue()
        self.process = subprocess.Popen(command, stdin=subprocess.DEVNULL,
                                        stdout=subprocess.DEVNULL, stderr=subprocess.PIPE,
                                        text=True, encoding="utf-8", errors="replace")
        self.listener = threading.Thread(target=self.listen, daemon=True)
        self.listener.start()

    def listen(self):
        for line in self.process.stderr:
            self.queue.put(line.rstrip("\n"))

    def poll(self):
        """The exit status; None while it works."""
        status = self.process.poll()
        if status is not None:
            self.listener.join(5)  # the last lines are on their way
        while not self.queue.empty():
            line = self.queue.get()
            try:
                self.fraction = json.loads(line)["progress"]["fraction"]
            except (ValueError, KeyError, TypeError):
                self.lines.append(line)
        return status

    def stop(self):
        """The program ends at TERM; whoever does not is killed."""
        self.process.terminate()
        try:
            self.process.wait(10)
        except subprocess.TimeoutExpired:
            self.process.kill()
            self.process.wait()


def load_picture(path):
    image = bpy.data.images.load(path, check_existing=True)
    image.reload()
    return image


class PARHELION_OT_export(bpy.types.Operator):
    bl_idname = "parhelion.export"
    bl_label = "Export for Parhelion"
    bl_description = "Writes a .gltf or .glb, and looks whether all marks are in it"
    filepath: StringProperty(subtype="FILE_PATH")
    filter_glob: StringProperty(default="*.gltf;*.glb", options={"HIDDEN"})

    def invoke(self, context, _event):
        self.filepath = self.filepath or bpy.path.ensure_ext(
            os.path.splitext(bpy.data.filepath)[0] or "scene", ".gltf")
        context.window_manager.fileselect_add(self)
        return {"RUNNING_MODAL"}

    def execute(self, _context):
        path = absolute(self.filepath)
        if not path.endswith((".gltf", ".glb")):
            path += ".gltf"
        try:
            for line in export_scene(path):
                self.report({"WARNING"}, line)
            root = outside_root(path)
        except Wrong as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        if root:
            self.report({"INFO"}, "files lie outside: render with --root " + root[1])
        return {"FINISHED"}


class PARHELION_OT_render(bpy.types.Operator):
    bl_idname = "parhelion.render"
    bl_label = "Render with Parhelion"
    bl_description = "Exports the scene, renders it and loads the picture; ESC cancels"

    def start(self, context):
        folder = context.scene.parhelion.folder
        folder = absolute(folder) if folder else os.path.join(bpy.app.tempdir, "parhelion")
        name = os.path.splitext(os.path.basename(bpy.data.filepath))[0] or "scene"
        path = os.path.join(folder, name + ".gltf")
        lines = export_scene(path)
        if lines:
            raise Wrong("; ".join(lines))
        command = render_command(context, path)
        self.picture = command[command.index("--png") + 1]
        self.run = Run(command)

    def finish(self, status):
        if status != 0:
            self.report({"ERROR"}, "\n".join(self.run.lines) or f"parhelion: status {status}")
            return {"CANCELLED"}
        for line in self.run.lines:
            self.report({"WARNING" if "warning" in line else "INFO"}, line)
        image = load_picture(self.picture)
        for area in bpy.context.screen.areas if bpy.context.screen else []:
            if area.type == "IMAGE_EDITOR":
                area.spaces.active.image = image
        return {"FINISHED"}

    def execute(self, context):
        """Without windows, and from scripts: until it is done."""
        try:
            self.start(context)
        except (Wrong, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        while self.run.poll() is None:
            time.sleep(0.05)
        return self.finish(self.run.poll())

    def invoke(self, context, _event):
        try:
            self.start(context)
        except (Wrong, OSError) as error:
            self.report({"ERROR"}, str(error))
            return {"CANCELLED"}
        manager = context.window_manager
        manager.progress_begin(0, 100)
        self.timer = manager.event_timer_add(0.2, window=context.window)
        manager.modal_handler_add(self)
        return {"RUNNING_MODAL"}

    def modal(self, context, event):
        if event.type == "ESC":
            self.run.stop()
            self.leave(context)
            self.report({"WARNING"}, "Parhelion: cancelled")
            return {"CANCELLED"}
        if event.type != "TIMER":
            return {"PASS_THROUGH"}
        status = self.run.poll()
        if status is None:
            context.window_manager.progress_update(100 * self.run.fraction)
            context.workspace.status_text_set(
                f"Parhelion: {100 * self.run.fraction:.0f} %, ESC cancels")
            return {"RUNNING_MODAL"}
        self.leave(context)
        return self.finish(status)

    def leave(self, context):
        context.window_manager.event_timer_remove(self.timer)
        context.window_manager.progress_end()
        context.workspace.status_text_set(None)


# ---- what the user sees --------------------------------------------------------------------


class PARHELION_OT_layer(bpy.types.Operator):
    bl_idname = "parhelion.layer"
    bl_label = "Layer"
    bl_options = {"UNDO", "INTERNAL"}
    which: StringProperty()
    remove: IntProperty(default=-1)

    def execute(self, context):
        layers = getattr(context.material.parhelion, self.which)
        if self.remove >= 0:
            layers.remove(self.remove)
        else:
            layers.add()
        return {"FINISHED"}


def draw_layers(layout, marks, which, names):
    for i, layer in enumerate(getattr(marks, which)):
        box = layout.box()
        for name in names:
            box.prop(layer, name)
        button = box.operator("parhelion.layer", text="Remove", icon="X")
        button.which, button.remove = which, i
    layout.operator("parhelion.layer", text="Add a layer", icon="ADD").which = which


class PARHELION_PT_material(bpy.types.Panel):
    bl_label = "Parhelion"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "material"

    @classmethod
    def poll(cls, context):
        return context.material is not None

    def draw(self, context):
        layout, marks = self.layout, context.material.parhelion
        layout.use_property_split = True
        layout.prop(marks, "kind")
        if marks.kind == "DISPLAY":
            layout.prop(marks, "panel")
            for name in ("content", "level", "uv_map"):
                layout.prop(marks, name)
        if marks.kind == "GLAZING":
            draw_layers(layout, marks, "layers", ("thickness_mm", "ior", "transmission", "file",
                                                  "wedge_mrad", "toward"))
            for name in ("haze_share", "haze_width_deg", "coating_outside", "coating_inside"):
                layout.prop(marks, name)
            return
        layout.prop(marks, "coating")
        if marks.coating == "layers":
            draw_layers(layout, marks, "thin_layers", ("n", "k", "file", "thickness_nm"))
        if marks.coating != "none":
            layout.prop(marks, "faces")


class PARHELION_PT_object(bpy.types.Panel):
    bl_label = "Parhelion"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "object"

    @classmethod
    def poll(cls, context):
        return context.object is not None and context.object.type == "EMPTY"

    def draw(self, context):
        self.layout.prop(context.object.parhelion, "is_eye")
        self.layout.prop(context.object.parhelion, "fov_deg")


class PARHELION_PT_scene(bpy.types.Panel):
    bl_label = "Parhelion"
    bl_space_type, bl_region_type, bl_context = "PROPERTIES", "WINDOW", "scene"

    def draw(self, context):
        layout, marks = self.layout, context.scene.parhelion
        layout.use_property_split = True
        layout.prop(marks, "has_sky")
        if marks.has_sky:
            for name in ("latitude", "longitude", "altitude_m", "when", "turbidity",
                         "heading_deg", "forward"):
                layout.prop(marks, name)
        layout.prop_search(marks, "eye", context.scene, "objects")
        layout.prop(marks, "spp")
        layout.prop(marks, "folder")
        layout.operator("parhelion.export")
        layout.operator("parhelion.render", icon="RENDER_STILL")


class ParhelionPreferences(bpy.types.AddonPreferences):
    bl_idname = __name__
    program: StringProperty(name="Program", subtype="FILE_PATH",
                            description="parhelion; empty: found by PATH")

    def draw(self, _context):
        self.layout.prop(self, "program")


CLASSES = (ParhelionGlassLayer, ParhelionThinLayer, ParhelionMaterial, ParhelionObject,
           ParhelionScene, ParhelionPreferences, PARHELION_OT_export, PARHELION_OT_render,
           PARHELION_OT_layer, PARHELION_PT_material, PARHELION_PT_object, PARHELION_PT_scene)


def register():
    for cls in CLASSES:
        bpy.utils.register_class(cls)
    bpy.types.Material.parhelion = PointerProperty(type=ParhelionMaterial)
    bpy.types.Object.parhelion = PointerProperty(type=ParhelionObject)
    bpy.types.Scene.parhelion = PointerProperty(type=ParhelionScene)


def unregister():
    for owner in (bpy.types.Material, bpy.types.Object, bpy.types.Scene):
        del owner.parhelion
    for cls in reversed(CLASSES):
        bpy.utils.unregister_class(cls)
