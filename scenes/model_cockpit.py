# SPDX-License-Identifier: Apache-2.0
"""Models the flight deck and writes cockpit.gltf (.bin) and its four light scenes.

    blender -b --python scenes/model_cockpit.py

Only modelling needs Blender (3.4, from Debian); the committed glTF does not. Blender's x is
the aircraft's right, y forward and z up, in metres, with the floor at z = 0 and the pilots'
eyes at y = 0.
"""
import math
import os
import sys

import bpy
from mathutils import Vector

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "modelling"))

import deck_cabin  # noqa: E402
import deck_glareshield  # noqa: E402
import deck_lights  # noqa: E402
import deck_panel  # noqa: E402
import deck_pedestal  # noqa: E402
import deck_shell  # noqa: E402
import deck_trim  # noqa: E402
import finish  # noqa: E402
from deck_layout import EYE  # noqa: E402
from deck_materials import use_deck_materials  # noqa: E402

ASPECT = 16 / 9


def add_camera(name, position, yaw_deg, pitch_deg, yfov_deg):
    """A camera that looks `yaw_deg` to the right of straight ahead, `pitch_deg` up."""
    data = bpy.data.cameras.new(name)
    data.sensor_fit = "HORIZONTAL"
    data.angle_x = 2 * math.atan(math.tan(math.radians(yfov_deg) / 2) * ASPECT)
    data.clip_start, data.clip_end = 0.01, 5000.0
    item = bpy.data.objects.new(name, data)
    item.location = position
    yaw, pitch = math.radians(yaw_deg), math.radians(pitch_deg)
    ahead = (
        math.sin(yaw) * math.cos(pitch),
        math.cos(yaw) * math.cos(pitch),
        math.sin(pitch),
    )
    item.rotation_euler = Vector(ahead).to_track_quat("-Z", "Y").to_euler()
    bpy.context.scene.collection.objects.link(item)


def add_cameras():
    x, y, z = EYE
    add_camera("captain", EYE, 13.0, -17.0, 62.0)
    add_camera("first_officer", (-x, y, z), -13.0, -17.0, 62.0)
    add_camera("pfd", (-0.545, 0.270, 0.985), -4.0, -24.0, 36.0)
    add_camera("wide", (0.0, -0.46, 1.270), 0.0, -12.0, 72.0)


def main():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 1600, 900
    path = os.path.join(HERE, "cockpit.gltf")
    finish.GENERATOR = "model_cockpit.py of Parhelion, with Blender's glTF exporter"
    use_deck_materials()
    add_cameras()
    deck_shell.build_shell()
    deck_panel.build_panel()
    deck_glareshield.build_glareshield()
    deck_pedestal.build_pedestal()
    deck_cabin.build_cabin()
    deck_trim.build_trim()
    finish.finish_meshes()
    finish.export(path)
    finish.patch(path)
    deck_lights.write_lights(HERE)
    print(f"{path}: {finish.triangle_count(path)} triangles")


main()
