# SPDX-License-Identifier: Apache-2.0
"""From Blender's meshes to the committed glTF: coordinates, export, materials, extensions."""
import json
import os

import bpy

from materials import MATERIALS, TILE
from shapes import apply_modifiers, box_project
from tangents import add_tangents

GENERATOR = "model_car.py of Parhelion, with Blender's glTF exporter"
LINEAR_REPEAT = {"magFilter": 9729, "minFilter": 9987, "wrapS": 10497, "wrapT": 10497}
NEAREST_CLAMP = {"magFilter": 9728, "minFilter": 9728, "wrapS": 33071, "wrapT": 33071}


def scale_coordinates(item):
    """Metres along the surface become tiles of the material's textures."""
    tile = TILE.get(item.data.materials[0].name)
    layer = item.data.uv_layers.active
    if item.get("keep_uv") or not tile or not layer:
        return
    for corner in layer.data:
        corner.uv = corner.uv / tile


def needs_coordinates(item):
    entry = MATERIALS[item.data.materials[0].name]
    return bool(item.get("keep_uv") or {"texture", "normal", "glazing", "brushed"} & set(entry))


def finish_meshes():
    done = set()
    for item in [o for o in bpy.context.scene.objects if o.type == "MESH"]:
        if item.data.name in done:  # copies share one mesh
            continue
        apply_modifiers(item)
        done.add(item.data.name)
        if not needs_coordinates(item):
            while item.data.uv_layers:
                item.data.uv_layers.remove(item.data.uv_layers[0])
            continue
        if not item.data.uv_layers:
            box_project(item)
        scale_coordinates(item)


def export(path):
    bpy.ops.export_scene.gltf(
        filepath=path,
        export_format="GLTF_SEPARATE",
        export_apply=False,
        export_yup=True,
        export_normals=True,
        export_tangents=False,
        export_colors=False,
        export_cameras=True,
        export_lights=True,
        export_animations=False,
        export_skins=False,
        export_morph=False,
        export_materials="EXPORT",
        export_extras=False,
    )


class Textures:
    """Images, samplers and textures of one glTF, each made once."""

    def __init__(self, gltf):
        self.gltf = gltf
        self.known = {}
        for key in ("images", "samplers", "textures"):
            gltf.pop(key, None)

    def index(self, uri, sampler):
        if (uri, id(sampler)) not in self.known:
            self.known[(uri, id(sampler))] = self._append(
                "textures",
                {
                    "sampler": self._shared("samplers", sampler),
                    "source": self._shared(
                        "images",
                        {"uri": uri, "name": os.path.splitext(os.path.basename(uri))[0]},
                    ),
                },
            )
        return self.known[(uri, id(sampler))]

    def _append(self, key, value):
        self.gltf.setdefault(key, []).append(value)
        return len(self.gltf[key]) - 1

    def _shared(self, key, value):
        entries = self.gltf.get(key, [])
        return entries.index(value) if value in entries else self._append(key, dict(value))


def material_json(name, textures, used):
    entry = MATERIALS[name]
    pbr = {
        "baseColorFactor": [*entry["color"], 1.0],
        "metallicFactor": entry["metallic"],
        "roughnessFactor": entry["roughness"],
    }
    out = {"name": name, "doubleSided": True, "pbrMetallicRoughness": pbr}
    extensions = {}
    if "texture" in entry:
        pbr["baseColorTexture"] = {
            "index": textures.index(f"textures/{entry['texture']}.png", LINEAR_REPEAT)
        }
    if "normal" in entry:
        uri, scale = entry["normal"]
        out["normalTexture"] = {
            "index": textures.index(f"textures/{uri}.png", LINEAR_REPEAT),
            "scale": scale,
        }
    if "ior" in entry:
        extensions["KHR_materials_ior"] = {"ior": entry["ior"]}
    if "clearcoat" in entry:
        factor, roughness = entry["clearcoat"]
        extensions["KHR_materials_clearcoat"] = {
            "clearcoatFactor": factor,
            "clearcoatRoughnessFactor": roughness,
        }
    if "specular" in entry:
        extensions["KHR_materials_specular"] = {"specularFactor": entry["specular"]}
    if "sheen" in entry:
        color, roughness = entry["sheen"]
        extensions["KHR_materials_sheen"] = {
            "sheenColorFactor": list(color),
            "sheenRoughnessFactor": roughness,
        }
    if "conductor" in entry:
        extensions["PARHELION_spectrum"] = {"conductor": entry["conductor"]}
    if "brushed" in entry:
        strength, rotation = entry["brushed"]
        extensions["KHR_materials_anisotropy"] = {
            "anisotropyStrength": strength,
            "anisotropyRotation": rotation,
        }
    if "coating" in entry:
        extensions["PARHELION_coating"] = entry["coating"]
    if entry.get("glass"):
        extensions["KHR_materials_transmission"] = {"transmissionFactor": 1.0}
    if "glazing" in entry:
        extensions["PARHELION_glazing"] = entry["glazing"]
    if "emission" in entry:
        color, strength = entry["emission"]
        out["emissiveFactor"] = list(color)
        extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": strength}
    if "display" in entry:
        display_json(entry["display"], out, extensions, textures)
    if extensions:
        out["extensions"] = extensions
        used.update(extensions)
    return out


def display_json(display, out, extensions, textures):
    """What other viewers show beside the measured panel: its picture at a plausible white."""
    panel, content, white_cd_m2, *flags = display
    index = textures.index(f"../assets/content/{content}", NEAREST_CLAMP)
    out["doubleSided"] = False
    out["emissiveTexture"] = {"index": index}
    out["emissiveFactor"] = [1.0, 1.0, 1.0]
    extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": white_cd_m2}
    extensions["PARHELION_display"] = {
        "panel": f"../assets/panels/{panel}",
        "content": {"index": index, "texCoord": 0},
        "level": 1.0,
        **dict.fromkeys(flags, True),
    }


def patch(path, environment=None, used=()):
    """Replaces Blender's materials by the table's and adds what Blender does not know."""
    with open(path, encoding="utf-8") as file:
        gltf = json.load(file)
    used = set(used) | set(gltf.get("extensionsUsed", []))
    textures = Textures(gltf)
    if "materials" in gltf:
        gltf["materials"] = [
            material_json(m["name"], textures, used) for m in gltf["materials"]
        ]
    gltf["asset"]["generator"] = GENERATOR
    if environment:
        gltf["scenes"][0].setdefault("extensions", {})["PARHELION_environment"] = environment
        used.add("PARHELION_environment")
    if used:
        gltf["extensionsUsed"] = sorted(used)
    gltf.pop("extensionsRequired", None)
    round_numbers(gltf)
    add_tangents(gltf, path, {name for name, m in MATERIALS.items() if "brushed" in m})
    with open(path, "w", encoding="utf-8") as file:
        json.dump(gltf, file, indent=1, ensure_ascii=False)
        file.write("\n")


def round_numbers(value):
    """Node transforms to a micrometre: enough, and stable between exports."""
    for node in value.get("nodes", []):
        for key in ("translation", "rotation", "scale"):
            if key in node:
                node[key] = [round(v, 7) for v in node[key]]


def triangle_count(path):
    with open(path, encoding="utf-8") as file:
        gltf = json.load(file)
    uses = {}
    for node in gltf.get("nodes", []):
        if "mesh" in node:
            uses[node["mesh"]] = uses.get(node["mesh"], 0) + 1
    return sum(
        count
        * sum(
            gltf["accessors"][p["indices"]]["count"] // 3
            for p in gltf["meshes"][m]["primitives"]
        )
        for m, count in uses.items()
    )
