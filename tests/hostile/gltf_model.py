# SPDX-License-Identifier: Apache-2.0
"""gltf_model.py -- a valid glTF model that holds every property of the core and of the KHR_
extensions that `check` knows, and ways to break it: part of gltf_codes.py.
"""
import copy
import json
import math
import os
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
from gltf import data_uri, png  # noqa: E402

PICTURE = png(2, 2, [[10, 20, 30] * 2] * 2)
KINDS = {"SCALAR": 1, "VEC2": 2, "VEC3": 3, "VEC4": 4, "MAT4": 16}
CODES = {"b": 5120, "B": 5121, "h": 5122, "H": 5123, "I": 5125, "f": 5126}
QUAD = [0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0]
EYE4 = [1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1]


class Model:
    """A document and the bytes of its one buffer."""

    def __init__(self):
        self.document = {"asset": {"version": "2.0", "minVersion": "2.0", "generator": "a test",
                                   "copyright": "nobody", "extras": {"any": [1, "thing"]}}}
        self.binary = bytearray()
        self.files = {}  # name -> bytes: beside the document

    def add(self, collection, **item):
        self.document.setdefault(collection, []).append(item)
        return len(self.document[collection]) - 1

    def view(self, data, target=None):
        while len(self.binary) % 4:
            self.binary.append(0)
        members = {"target": target} if target else {}
        view = self.add("bufferViews", buffer=0, byteOffset=len(self.binary),
                        byteLength=len(data), **members)
        self.binary += data
        return view

    def accessor(self, kind, code, numbers, target=None, bounds=False, **more):
        width = KINDS[kind]
        if bounds:
            columns = [numbers[c::width] for c in range(width)]
            more.update(min=[min(c) for c in columns], max=[max(c) for c in columns])
        return self.add("accessors", bufferView=self.view(
            struct.pack(f"<{len(numbers)}{code}", *numbers), target), byteOffset=0,
            componentType=CODES[code], count=len(numbers) // width, type=kind, **more)

    # ---- ways to break it ------------------------------------------------------------------

    def at(self, path):
        """(holder, key) of a place like meshes/0/weights."""
        *way, last = path.split("/")
        value = self.document
        for step in way:
            value = value[int(step) if isinstance(value, list) else step]
        return value, int(last) if isinstance(value, list) else last

    def put(self, path, value):
        holder, key = self.at(path)
        if isinstance(holder, list) and key == len(holder):
            holder.append(value)
        else:
            holder[key] = value

    def drop(self, path):
        holder, key = self.at(path)
        del holder[key]

    def poke(self, accessor, element, code, *values):
        """Other numbers from the accessor's element (a component) on."""
        item = self.document["accessors"][accessor]
        view = self.document["bufferViews"][item["bufferView"]]
        struct.pack_into(f"<{len(values)}{code}", self.binary,
                         view["byteOffset"] + struct.calcsize(code) * element, *values)

    # ---- as files --------------------------------------------------------------------------

    def whole(self, uri=True):
        document = copy.deepcopy(self.document)
        buffer = {"byteLength": len(self.binary)}
        if uri:
            buffer["uri"] = data_uri("application/octet-stream", bytes(self.binary))
        changes = document.pop("buffer", {})
        buffer.update(changes)
        document["buffers"] = [buffer] + document.get("buffers", [])
        return document

    def text(self):
        return json.dumps(self.whole()).encode()

    def glb(self):
        text = json.dumps(self.whole(uri=False)).encode()
        return glb_of([(b"JSON", text + b" " * (-len(text) % 4)),
                       (b"BIN\0", bytes(self.binary) + bytes(-len(self.binary) % 4))])


def glb_of(chunks):
    body = b"".join(struct.pack("<I", len(data)) + kind + data for kind, data in chunks)
    return struct.pack("<4sII", b"glTF", 2, 12 + len(body)) + body


# ---- the model: accessors by name ----------------------------------------------------------

(POSITION, NORMAL, TANGENT, TEXCOORD, COLOR, JOINTS, WEIGHTS, INDICES, MOVED, BINDS, TIMES,
 SHIFTS, TURNS, BLENDS, SPARSE) = range(15)


def add_numbers(m):
    m.accessor("VEC3", "f", QUAD, 34962, True, name="points")
    m.accessor("VEC3", "f", [0, 0, 1] * 4, 34962)
    m.accessor("VEC4", "f", [1, 0, 0, 1] * 4, 34962)
    m.accessor("VEC2", "f", [0, 1, 1, 1, 1, 0, 0, 0], 34962)
    m.accessor("VEC4", "f", [1, 1, 1, 1] * 4, 34962)
    m.accessor("VEC4", "B", [0, 1, 0, 0] * 4, 34962)
    m.accessor("VEC4", "f", [0.5, 0.5, 0, 0] * 4, 34962)
    m.accessor("SCALAR", "H", [0, 1, 2, 0, 2, 3], 34963)
    m.accessor("VEC3", "f", [0, 0, 0.5] * 4, 34962, True)
    m.accessor("MAT4", "f", EYE4 * 2)
    m.accessor("SCALAR", "f", [0, 1], None, True)
    m.accessor("VEC3", "f", [0, 0, 0, 1, 0, 0])
    m.accessor("VEC4", "f", [0, 0, 0, 1] * 2)
    m.accessor("SCALAR", "f", [0, 1])
    m.accessor("SCALAR", "f", [0, 0, 0, 0], None, sparse={
        "count": 2, "indices": {"bufferView": m.view(struct.pack("<2H", 1, 3)),
                                "byteOffset": 0, "componentType": 5123},
        "values": {"bufferView": m.view(struct.pack("<2f", 5, 7)), "byteOffset": 0}})


def texture(index=0, **more):
    return {"index": index, "texCoord": 0, **more}


def add_pictures(m):
    m.add("images", name="kept", bufferView=m.view(PICTURE), mimeType="image/png")
    m.add("images", uri=data_uri("image/png", PICTURE))
    m.add("samplers", magFilter=9729, minFilter=9987, wrapS=10497, wrapT=33071)
    m.add("textures", sampler=0, source=0)
    m.add("textures", source=1)


def extended_material():
    return {"KHR_materials_emissive_strength": {"emissiveStrength": 5},
            "KHR_materials_ior": {"ior": 1.4},
            "KHR_materials_specular": {
                "specularFactor": 1, "specularTexture": texture(),
                "specularColorFactor": [1, 1, 1], "specularColorTexture": texture()},
            "KHR_materials_transmission": {"transmissionFactor": 0.5,
                                           "transmissionTexture": texture()},
            "KHR_materials_volume": {"thicknessFactor": 1, "thicknessTexture": texture(),
                                     "attenuationDistance": 1, "attenuationColor": [1, 1, 1]},
            "KHR_materials_clearcoat": {
                "clearcoatFactor": 1, "clearcoatTexture": texture(),
                "clearcoatRoughnessFactor": 0, "clearcoatRoughnessTexture": texture(),
                "clearcoatNormalTexture": texture(scale=1)},
            "KHR_materials_anisotropy": {"anisotropyStrength": 0.5, "anisotropyRotation": 1,
                                         "anisotropyTexture": texture()},
            "KHR_materials_iridescence": {
                "iridescenceFactor": 1, "iridescenceTexture": texture(), "iridescenceIor": 1.3,
                "iridescenceThicknessMinimum": 100, "iridescenceThicknessMaximum": 400,
                "iridescenceThicknessTexture": texture()},
            "KHR_materials_sheen": {
                "sheenColorFactor": [1, 1, 1], "sheenColorTexture": texture(),
                "sheenRoughnessFactor": 0.3, "sheenRoughnessTexture": texture()},
            "KHR_materials_dispersion": {"dispersion": 0.1},
            "KHR_materials_diffuse_transmission": {
                "diffuseTransmissionFactor": 0.1, "diffuseTransmissionTexture": texture(),
                "diffuseTransmissionColorFactor": [1, 1, 1],
                "diffuseTransmissionColorTexture": texture()}}


def add_materials(m):
    transform = {"KHR_texture_transform": {"offset": [0, 0], "rotation": 1, "scale": [1, 2],
                                           "texCoord": 0}}
    m.add("materials", name="all", pbrMetallicRoughness={
        "baseColorFactor": [1, 1, 1, 1], "baseColorTexture": texture(extensions=transform),
        "metallicFactor": 0, "roughnessFactor": 1, "metallicRoughnessTexture": texture()},
        normalTexture=texture(1, scale=1), occlusionTexture=texture(strength=1),
        emissiveTexture=texture(), emissiveFactor=[1, 1, 1], doubleSided=True,
        extensions=extended_material())
    m.add("materials", alphaMode="MASK", alphaCutoff=0.5)
    m.add("materials", alphaMode="BLEND", extensions={"KHR_materials_unlit": {}})
    m.add("materials", extensions={"KHR_materials_pbrSpecularGlossiness": {
        "diffuseFactor": [1, 1, 1, 1], "diffuseTexture": texture(), "specularFactor": [1, 1, 1],
        "glossinessFactor": 1, "specularGlossinessTexture": texture()}})


def add_shapes(m):
    m.add("meshes", name="sheet", weights=[0.5], primitives=[{
        "attributes": {"POSITION": POSITION, "NORMAL": NORMAL, "TANGENT": TANGENT,
                       "TEXCOORD_0": TEXCOORD, "COLOR_0": COLOR, "JOINTS_0": JOINTS,
                       "WEIGHTS_0": WEIGHTS},
        "indices": INDICES, "material": 0, "mode": 4, "targets": [{"POSITION": MOVED}],
        "extensions": {"KHR_materials_variants": {"mappings": [
            {"variants": [0], "material": 1}, {"variants": [1], "material": 2}]}}}])
    m.add("meshes", primitives=[{"attributes": {"POSITION": POSITION, "_HEAT": SPARSE}}])
    m.document["meshes"][1]["primitives"][0].update(indices=INDICES, material=1)
    m.add("skins", inverseBindMatrices=BINDS, skeleton=2, joints=[2, 3])


PROFILE_TYPE = "application/x-ies-lm-63"
PROFILE = b"IESNA:LM-63-2002\nTILT=NONE\n1 -1 1 2 1 1 2 0 0 0\n1 1 9\n0 90\n0\n100 0\n"


def add_nodes(m):
    m.document["scene"] = 0
    m.add("scenes", name="day", nodes=[0, 2])
    m.add("nodes", name="root", children=[1, 4, 5, 6, 7, 8])
    m.add("nodes", mesh=0, skin=0, weights=[0.25])
    m.add("nodes", children=[3])
    m.add("nodes", translation=[0, 1, 0])
    m.add("nodes", camera=0, rotation=[0, 0, 0, 1], scale=[1, 1, 1], translation=[0, 0, 3])
    m.add("nodes", camera=1, matrix=[2, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1])
    m.add("nodes", extensions={"KHR_lights_punctual": {"light": 0}})
    m.add("nodes", extensions={"KHR_lights_punctual": {"light": 1},
                               "KHR_node_visibility": {"visible": True}})
    m.add("nodes", mesh=1, translation=[2, 0, 0], extensions={
        "EXT_lights_ies": {"light": 0, "multiplier": 2, "color": [1, 0.5, 0]}})
    m.add("cameras", type="perspective", perspective={"aspectRatio": 1.5, "yfov": 0.7,
                                                      "znear": 0.1, "zfar": 100})
    m.add("cameras", type="orthographic", orthographic={"xmag": 1, "ymag": 1, "znear": 0,
                                                        "zfar": 10})


def add_animation(m):
    pointer = {"KHR_animation_pointer": {"pointer": "/materials/1/alphaCutoff"}}
    m.add("animations", name="wave", samplers=[
        {"input": TIMES, "output": SHIFTS, "interpolation": "LINEAR"},
        {"input": TIMES, "output": TURNS}, {"input": TIMES, "output": BLENDS}],
        channels=[{"sampler": 0, "target": {"node": 8, "path": "translation"}},
                  {"sampler": 1, "target": {"node": 8, "path": "rotation"}},
                  {"sampler": 2, "target": {"node": 1, "path": "weights"}},
                  {"sampler": 2, "target": {"path": "pointer", "extensions": pointer}}])


def valid_model():
    m = Model()
    for part in (add_numbers, add_pictures, add_materials, add_shapes, add_nodes,
                 add_animation):
        part(m)
    m.document["extensions"] = {
        "KHR_lights_punctual": {"lights": [
            {"type": "spot", "name": "lamp", "color": [1, 1, 1], "intensity": 5, "range": 10,
             "spot": {"innerConeAngle": 0.1, "outerConeAngle": math.pi / 4}},
            {"type": "point", "intensity": 5}]},
        "EXT_lights_ies": {"lights": [
            {"name": "street", "uri": data_uri(PROFILE_TYPE, PROFILE),
             "mimeType": PROFILE_TYPE}]},
        "KHR_materials_variants": {"variants": [{"name": "day"}, {"name": "night"}]}}
    m.document["extensionsUsed"] = [
        "KHR_lights_punctual", "KHR_materials_variants", "KHR_texture_transform",
        "KHR_node_visibility", "KHR_animation_pointer", "KHR_materials_unlit",
        "KHR_materials_pbrSpecularGlossiness", *extended_material(),
        "EXT_lights_ies"]
    m.document["extensionsRequired"] = ["KHR_texture_transform"]
    return m
