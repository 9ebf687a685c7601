# SPDX-License-Identifier: Apache-2.0
"""cycles_scene.py -- inside Blender: a scene of ours as its Cycles renders it, for cycles.py.

    blender -b --python cycles_scene.py -- build JOB.json
    blender -b SCENE.blend --python cycles_scene.py -- render SPP SEED FRAME.exr

build imports JOB's glTF as Blender's own importer reads it, with the sky's picture around, the
sun as a lamp of its illuminance, and the camera; 1 is 1 cd/m2. Sheets of glass become a mixture
of a transparent and a glossy surface, which lets Cycles' shadow rays pass as ours do.
"""
import json
import math
import sys

import bpy
import numpy
from mathutils import Vector

numpy.bool = bool  # Debian 12's glTF importer asks for it by the name that its numpy dropped

SUN_DIAMETER_DEG = 0.533


def glass_sheet(material, ior):
    """Both faces of a sheet mirror by Fresnel's law, F each: 2 F / (1 + F); what is left goes
    straight through. From behind, Cycles' Fresnel node takes the index's inverse."""
    tree = material.node_tree
    old = next(n for n in tree.nodes if n.type == "BSDF_PRINCIPLED")
    tint = tuple(old.inputs["Base Color"].default_value)
    tree.nodes.clear()

    def node(kind, *inputs, **settings):
        made = tree.nodes.new("ShaderNode" + kind)
        for name, value in settings.items():
            setattr(made, name, value)
        for place, value in inputs:
            if hasattr(value, "node"):
                tree.links.new(value, made.inputs[place])
            else:
                made.inputs[place].default_value = value
        return made.outputs

    behind = node("NewGeometry")["Backfacing"]
    sign = node("Math", (0, behind), (1, -2), (2, 1), operation="MULTIPLY_ADD")[0]
    index = node("Math", (0, ior), (1, sign), operation="POWER")[0]
    face = node("Fresnel", ("IOR", index))[0]
    twice = node("Math", (0, face), (1, 2), operation="MULTIPLY")[0]
    above = node("Math", (0, face), (1, 1), operation="ADD")[0]
    both = node("Math", (0, twice), (1, above), operation="DIVIDE")[0]
    through = node("BsdfTransparent", ("Color", tint))[0]
    mirrored = node("BsdfGlossy", ("Roughness", 0))[0]
    mix = node("MixShader", (0, both), (1, through), (2, mirrored))[0]
    node("OutputMaterial", ("Surface", mix))


def set_glass():
    for material in bpy.data.materials:
        if not material.node_tree:
            continue
        for node in material.node_tree.nodes:
            if node.type == "BSDF_PRINCIPLED" and node.inputs["Transmission"].default_value > 0:
                glass_sheet(material, node.inputs["IOR"].default_value)
                break


def set_world(picture, heading_deg):
    """The picture's left edge is north, its azimuth grows to the right; +Y is ahead."""
    world = bpy.data.worlds.new("sky")
    bpy.context.scene.world = world
    world.use_nodes = True
    nodes, links = world.node_tree.nodes, world.node_tree.links
    sky, mapping = nodes.new("ShaderNodeTexEnvironment"), nodes.new("ShaderNodeMapping")
    where = nodes.new("ShaderNodeTexCoord")
    sky.image = bpy.data.images.load(picture)
    sky.image.colorspace_settings.name = "Linear"
    mapping.inputs["Rotation"].default_value[2] = math.pi / 2 - math.radians(heading_deg)
    links.new(where.outputs["Generated"], mapping.inputs["Vector"])
    links.new(mapping.outputs["Vector"], sky.inputs["Vector"])
    links.new(sky.outputs["Color"], nodes["Background"].inputs["Color"])


def set_sun(sun, heading_deg):
    if not sun:
        return
    turn = math.radians(sun["azimuth_deg"] - heading_deg)
    up = math.radians(sun["elevation_deg"])
    towards = Vector((math.cos(up) * math.sin(turn), math.cos(up) * math.cos(turn),
                      math.sin(up)))
    lamp = bpy.data.lights.new("sun", "SUN")
    lamp.energy, lamp.angle = sun["lx"], math.radians(SUN_DIAMETER_DEG)
    node = bpy.data.objects.new("sun", lamp)
    node.rotation_euler = towards.to_track_quat("Z", "Y").to_euler()
    bpy.context.collection.objects.link(node)


def set_camera(name):
    cameras = [o for o in bpy.data.objects if o.type == "CAMERA"]
    scene = bpy.context.scene
    scene.camera = next((o for o in cameras if o.name == name), cameras[0])
    data, height = scene.camera.data, scene.camera.data.angle_y
    data.sensor_fit = "VERTICAL"
    data.angle = height


def set_render(size, bounces):
    """No filter but the pixel, nothing clamped, denoised or adapted: what ours does."""
    scene, cycles = bpy.context.scene, bpy.context.scene.cycles
    scene.render.engine = "CYCLES"
    cycles.device = "CPU"
    cycles.use_adaptive_sampling = cycles.use_denoising = False
    cycles.pixel_filter_type = "BOX"
    cycles.filter_width = 1
    cycles.sample_clamp_direct = cycles.sample_clamp_indirect = cycles.blur_glossy = 0
    cycles.max_bounces = cycles.diffuse_bounces = cycles.glossy_bounces = bounces
    cycles.transmission_bounces = cycles.transparent_max_bounces = bounces
    cycles.caustics_reflective = cycles.caustics_refractive = True
    scene.render.resolution_x, scene.render.resolution_y = size
    scene.render.resolution_percentage = 100
    settings = scene.render.image_settings
    settings.file_format, settings.color_mode = "OPEN_EXR", "RGB"
    settings.color_depth, settings.exr_codec = "32", "ZIP"


def build(job):
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.ops.preferences.addon_enable(module="io_scene_gltf2")
    for path in job["models"]:
        bpy.ops.import_scene.gltf(filepath=path)
    set_glass()
    set_world(job["sky"], job["heading_deg"])
    set_sun(job["sun"], job["heading_deg"])
    set_camera(job["camera"])
    set_render(job["size"], job["bounces"])
    bpy.ops.wm.save_as_mainfile(filepath=job["blend"])


def render(spp, seed, out):
    scene = bpy.context.scene
    scene.cycles.samples, scene.cycles.seed = int(spp), int(seed)
    scene.render.filepath = out
    bpy.ops.render.render(write_still=True)


def main():
    words = sys.argv[sys.argv.index("--") + 1:]
    if words[0] == "render":
        render(*words[1:])
        return
    with open(words[1], encoding="utf-8") as file:
        build(json.load(file))


main()
