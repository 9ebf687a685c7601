# SPDX-License-Identifier: Apache-2.0
"""Models the car interior and writes car_dashboard.gltf (.bin, textures/) beside itself.

    blender -b --python scenes/model_car.py
    blender -b --python scenes/model_car.py -- night      (night.gltf and its .bin)

Only modelling needs Blender (3.4, from Debian); the committed glTF does not. Blender's x is
the car's right, y forward and z up, in metres, with the road at z = 0 and the driver's eye at
y = 0.
"""
import math
import os
import sys

import bpy
from mathutils import Vector

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path.insert(0, os.path.join(HERE, "modelling"))

import body  # noqa: E402
import cabin  # noqa: E402
import climate  # noqa: E402
import dashboard  # noqa: E402
import finish  # noqa: E402
import greenhouse  # noqa: E402
import night  # noqa: E402
import outside  # noqa: E402
import textures  # noqa: E402
import wheel  # noqa: E402

EYE = (-0.37, 0.0, 1.300)  # the driver's eye, m
ASPECT = 16 / 9


def add_camera(name, position, target, yfov_deg):
    """A perspective camera at `position` that looks at `target`."""
    data = bpy.data.cameras.new(name)
    data.sensor_fit = "HORIZONTAL"
    data.angle_x = 2 * math.atan(math.tan(math.radians(yfov_deg) / 2) * ASPECT)
    data.clip_start, data.clip_end = 0.01, 5000.0
    item = bpy.data.objects.new(name, data)
    item.location = position
    item.rotation_euler = (
        (Vector(target) - Vector(position)).to_track_quat("-Z", "Y").to_euler()
    )
    bpy.context.scene.collection.objects.link(item)


def add_cameras():
    add_camera("driver-eye", EYE, (-0.245, 1.0, 1.075), 50.0)
    add_camera("passenger-eye", (0.37, 0.0, 1.290), (0.12, 1.0, 1.020), 50.0)
    add_camera("outside", (0.62, 2.35, 1.62), (-0.12, 0.70, 1.05), 40.0)


def empty_scene():
    bpy.ops.wm.read_factory_settings(use_empty=True)
    bpy.context.scene.render.resolution_x, bpy.context.scene.render.resolution_y = 1600, 900


def build_car(path):
    textures.write_textures(os.path.join(HERE, "textures"))
    dashboard.build_dashboard()
    climate.build_climate()
    wheel.build_wheel()
    greenhouse.build_greenhouse()
    cabin.build_cabin()
    body.build_body()
    outside.build_outside()
    add_cameras()
    finish.finish_meshes()
    finish.export(path)
    finish.patch(path)


def main():
    what = (
        sys.argv[sys.argv.index("--") + 1 :] if "--" in sys.argv else ["car_dashboard", "night"]
    )
    for name in what:
        empty_scene()
        path = os.path.join(HERE, name + ".gltf")
        build_car(path) if name == "car_dashboard" else night.build_night(path)
        print(f"{path}: {finish.triangle_count(path)} triangles")


main()
