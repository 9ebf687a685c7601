#!/usr/bin/python3
# SPDX-License-Identifier: Apache-2.0
"""Makes the noon scene: noon_sky.exr (512x256, equirectangular, cd/m2) and noon.gltf.

A clear sky (CIE standard general sky 12: gradation a = -1, b = -0.32, scattering c = 10,
d = -3, e = 0.45, ISO 15469) with a few cumulus clouds, scaled to a diffuse horizontal
illuminance. The sun's disc is not in the image: noon.gltf names it beside the sky.

    python3 scenes/modelling/sky.py
"""
import json
import os
import struct
import zlib

import numpy as np

HERE = os.path.dirname(os.path.abspath(__file__))
WIDTH, HEIGHT = 512, 256
SUN_AZIMUTH_DEG, SUN_ELEVATION_DEG = 238.0, 22.0
SUN_LX, DIFFUSE_LX = 68000.0, 18000.0
LUMINANCE = np.array([0.2126, 0.7152, 0.0722])


def directions():
    """Unit vectors of the pixels' centres; x east, y up, z south; the centre is +Z and +X is
    to its left, as OpenEXR's latlong has it."""
    v, u = np.mgrid[0:HEIGHT, 0:WIDTH]
    turn = (0.5 - (u + 0.5) / WIDTH) * 2 * np.pi
    up = (0.5 - (v + 0.5) / HEIGHT) * np.pi
    return np.stack([np.sin(turn) * np.cos(up), np.sin(up), np.cos(turn) * np.cos(up)], axis=2)


def sun_direction():
    """From north over east: north is -Z, east +X."""
    a, e = np.radians(SUN_AZIMUTH_DEG), np.radians(SUN_ELEVATION_DEG)
    return np.array([np.sin(a) * np.cos(e), np.sin(e), -np.cos(a) * np.cos(e)])


def clear_sky(d):
    """Relative luminance of CIE sky 12, and the angle to the sun."""
    up = np.maximum(d[..., 1], 0.012)
    angle = np.arccos(np.clip(d @ sun_direction(), -1, 1))
    gradation = 1 - 1.0 * np.exp(-0.32 / up)
    scatter = 1 + 10 * (np.exp(-3 * angle) - np.exp(-1.5 * np.pi)) + 0.45 * np.cos(angle) ** 2
    return gradation * scatter, angle


def fractal(x, y, seed, octaves=6):
    """Smooth value noise summed over octaves, about 0..1."""
    rng = np.random.default_rng(seed)
    total, weight = np.zeros_like(x), 0.0
    for k in range(octaves):
        lattice = rng.random((64, 64))
        fx, fy = x * 2**k, y * 2**k
        ix, iy = np.floor(fx).astype(int), np.floor(fy).astype(int)
        tx, ty = fx - ix, fy - iy
        tx, ty = tx * tx * (3 - 2 * tx), ty * ty * (3 - 2 * ty)
        corner = [lattice[(iy + b) % 64, (ix + a) % 64] for b in (0, 1) for a in (0, 1)]
        value = (corner[0] * (1 - tx) + corner[1] * tx) * (1 - ty) + (
            corner[2] * (1 - tx) + corner[3] * tx
        ) * ty
        total, weight = total + value * 0.55**k, weight + 0.55**k
    return total / weight


def clouds(d, angle):
    """Cover 0..1 and relative luminance of flat clouds seen in perspective."""
    up = np.maximum(d[..., 1], 0.02)
    x, y = d[..., 0] / (up + 0.12) * 1.6 + 20, d[..., 2] / (up + 0.12) * 1.6 + 20
    shape = fractal(x, y, 12)
    cover = np.clip((shape - 0.53) / 0.14, 0, 1) ** 1.3 * np.clip(
        (d[..., 1] - 0.03) / 0.10, 0, 1
    )
    thick = np.clip((shape - 0.58) / 0.22, 0, 1)
    bright = 1.9 + 1.5 * np.exp(-2.2 * angle) - 0.9 * thick
    return 0.85 * cover, bright


def colored(luminance, rgb):
    """Pixels of the given luminance and the given colour (any scale)."""
    return luminance[..., None] * rgb / (rgb @ LUMINANCE)[..., None]


def sky_pixels():
    d = directions()
    relative, angle = clear_sky(d)
    up = np.clip(d[..., 1:2], 0, 1)
    blue = np.array([0.26, 0.49, 1.0]) * (up**0.45) + np.array([0.78, 0.93, 1.12]) * (
        1 - up**0.45
    )
    near = np.exp(-((angle / 0.30) ** 1.2))[..., None]
    pixels = colored(relative, blue * (1 - near) + np.array([1.0, 0.96, 0.88]) * near)
    cover, bright = clouds(d, angle)
    white = np.broadcast_to(np.array([1.0, 0.99, 0.97]), pixels.shape)
    pixels = pixels * (1 - cover[..., None]) + cover[..., None] * colored(bright, white)
    area = (
        np.cos((0.5 - (np.arange(HEIGHT) + 0.5) / HEIGHT) * np.pi)[:, None]
        * np.pi
        / HEIGHT
        * 2
        * np.pi
        / WIDTH
    )
    above = d[..., 1] > 0
    flux = ((pixels @ LUMINANCE) * np.maximum(d[..., 1], 0) * area)[above].sum()
    pixels *= DIFFUSE_LX / flux
    ground = 0.17 * (DIFFUSE_LX + SUN_LX * np.sin(np.radians(SUN_ELEVATION_DEG))) / np.pi
    below = np.broadcast_to(np.array([0.93, 1.0, 0.94]), pixels.shape)
    return np.where(above[..., None], pixels, colored(np.full(above.shape, ground), below))


def exr_attribute(name, kind, data):
    return name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(data)) + data


def zip_block(rows):
    """OpenEXR's ZIP: bytes split into halves, differences, deflate."""
    raw = np.frombuffer(rows, np.uint8)
    split = np.concatenate([raw[0::2], raw[1::2]]).astype(np.int16)
    coded = split.copy()
    coded[1:] = split[1:] - split[:-1] + 128
    packed = zlib.compress(coded.astype(np.uint8).tobytes(), 9)
    return packed if len(packed) < len(rows) else rows


def write_exr(path, pixels):
    """Half-float RGB, ZIP blocks of 16 lines, linear Rec.709."""
    channels = (
        b"".join(c + b"\0" + struct.pack("<iiii", 1, 0, 1, 1) for c in (b"B", b"G", b"R"))
        + b"\0"
    )
    window = struct.pack("<iiii", 0, 0, WIDTH - 1, HEIGHT - 1)
    header = struct.pack("<ii", 20000630, 2)
    header += exr_attribute("channels", "chlist", channels)
    header += exr_attribute(
        "chromaticities",
        "chromaticities",
        struct.pack("<8f", 0.64, 0.33, 0.30, 0.60, 0.15, 0.06, 0.3127, 0.3290),
    )
    header += exr_attribute("compression", "compression", b"\x03")
    header += exr_attribute("dataWindow", "box2i", window) + exr_attribute(
        "displayWindow", "box2i", window
    )
    header += exr_attribute("lineOrder", "lineOrder", b"\0")
    header += exr_attribute("pixelAspectRatio", "float", struct.pack("<f", 1))
    header += exr_attribute("screenWindowCenter", "v2f", struct.pack("<ff", 0, 0))
    header += exr_attribute("screenWindowWidth", "float", struct.pack("<f", 1)) + b"\0"
    half = pixels.astype("<f2")
    blocks = []
    for y in range(0, HEIGHT, 16):
        rows = b"".join(
            half[line, :, c].tobytes()
            for line in range(y, min(y + 16, HEIGHT))
            for c in (2, 1, 0)
        )
        body = zip_block(rows)
        blocks.append(struct.pack("<ii", y, len(body)) + body)
    offset, table = len(header) + 8 * len(blocks), b""
    for block in blocks:
        table += struct.pack("<Q", offset)
        offset += len(block)
    with open(path, "wb") as file:
        file.write(header + table + b"".join(blocks))


def noon_gltf():
    environment = {
        "type": "hdri",
        "uri": "noon_sky.exr",
        "rotation_deg": 0,
        "scale": 1.0,
        "sun": {
            "azimuth_deg": SUN_AZIMUTH_DEG,
            "elevation_deg": SUN_ELEVATION_DEG,
            "illuminance_lx": SUN_LX,
        },
    }
    return {
        "asset": {"version": "2.0", "generator": "sky.py of Parhelion"},
        "extensionsUsed": ["PARHELION_environment"],
        "scene": 0,
        "scenes": [{"name": "noon", "extensions": {"PARHELION_environment": environment}}],
    }


if __name__ == "__main__":
    folder = os.path.join(HERE, "..")
    picture = sky_pixels()
    write_exr(os.path.join(folder, "noon_sky.exr"), picture)
    with open(os.path.join(folder, "noon.gltf"), "w", encoding="utf-8") as out:
        json.dump(noon_gltf(), out, indent=1)
        out.write("\n")
    y = picture @ LUMINANCE
    print(
        f"zenith {y[2].mean():.0f} cd/m2, horizon {y[HEIGHT // 2 - 3].mean():.0f}, "
        f"brightest {y.max():.0f}"
    )
