# SPDX-License-Identifier: Apache-2.0
"""Textures of the car's materials, made from noise with numpy and written as PNG.

Every texture tiles. Colours are sRGB, normal maps linear with +Y up (glTF's convention).
"""
import os
import struct
import zlib

import numpy as np


def write_png(path, pixels):
    """8-bit PNG, pixels (h, w, 3) or (h, w) uint8, with the filter that suits each row."""
    p = np.ascontiguousarray(pixels)
    grey = p.ndim == 2
    height, width = p.shape[:2]
    flat = p.reshape(height, -1).astype(np.int16)
    step = 1 if grey else 3
    left = np.concatenate([np.zeros((height, step), np.int16), flat[:, :-step]], axis=1)
    above = np.concatenate([np.zeros((1, flat.shape[1]), np.int16), flat[:-1]])
    corner = np.concatenate([np.zeros((height, step), np.int16), above[:, :-step]], axis=1)
    choices = [
        flat,
        flat - left,
        flat - above,
        flat - (left + above) // 2,
        flat - paeth(left, above, corner),
    ]
    coded = np.stack([c.astype(np.uint8) for c in choices])
    cost = np.abs(coded.astype(np.int8).astype(np.int32)).sum(axis=2)
    best = cost.argmin(axis=0)
    rows = [bytes([best[y]]) + coded[best[y], y].tobytes() for y in range(height)]
    header = struct.pack(">IIBBBBB", width, height, 8, 0 if grey else 2, 0, 0, 0)
    with open(path, "wb") as file:
        file.write(b"\x89PNG\r\n\x1a\n")
        for kind, body in (
            (b"IHDR", header),
            (b"IDAT", zlib.compress(b"".join(rows), 9)),
            (b"IEND", b""),
        ):
            file.write(
                struct.pack(">I", len(body))
                + kind
                + body
                + struct.pack(">I", zlib.crc32(kind + body) & 0xFFFFFFFF)
            )


def paeth(left, above, corner):
    """PNG's predictor: whichever of the three neighbours is nearest left + above - corner."""
    guess = left + above - corner
    dl, da, dc = abs(guess - left), abs(guess - above), abs(guess - corner)
    return np.where((dl <= da) & (dl <= dc), left, np.where(da <= dc, above, corner))


def noise(shape, low, high, seed, stretch=1.0):
    """Tiling Gaussian noise of mean 0 and deviation 1 with `low` to `high` waves a tile;
    stretch > 1 makes it that much longer along x."""
    height, width = shape
    rng = np.random.default_rng(seed)
    fy = np.fft.fftfreq(height)[:, None] * height
    fx = np.fft.rfftfreq(width)[None, :] * width * stretch
    f = np.hypot(fy, fx)
    band = np.exp(
        -(
            (
                (np.log2(np.maximum(f, 0.5)) - 0.5 * (np.log2(low) + np.log2(high)))
                / (0.25 + 0.5 * (np.log2(high) - np.log2(low)))
            )
            ** 2
        )
    )
    band[f == 0] = 0
    field = np.fft.irfft2(np.fft.rfft2(rng.standard_normal(shape)) * band, s=shape)
    return field / field.std()


def cells(size, count, seed):
    """Tiling Worley noise: distances (pixels) to the nearest and second nearest of count^2
    jittered points, and the nearest one's number."""
    rng = np.random.default_rng(seed)
    pitch = size / count
    jitter = rng.uniform(0.08, 0.92, (count, count, 2))
    y, x = np.mgrid[0:size, 0:size].astype(np.float32)
    cy, cx = (y / pitch).astype(int), (x / pitch).astype(int)
    first = np.full((size, size), 1e9, np.float32)
    second, owner = first.copy(), np.zeros((size, size), int)
    for dy in (-2, -1, 0, 1, 2):
        for dx in (-2, -1, 0, 1, 2):
            iy, ix = cy + dy, cx + dx
            point = jitter[iy % count, ix % count]
            d = np.hypot(y - (iy + point[..., 0]) * pitch, x - (ix + point[..., 1]) * pitch)
            closer = d < first
            second = np.where(closer, first, np.minimum(second, d))
            owner = np.where(closer, (iy % count) * count + ix % count, owner)
            first = np.where(closer, d, first)
    return first, second, owner


def normal_map(height, strength):
    """Unit normals of a tiling height field; height and strength in pixels."""
    dx = strength * 0.5 * (np.roll(height, -1, 1) - np.roll(height, 1, 1))
    dy = strength * 0.5 * (np.roll(height, -1, 0) - np.roll(height, 1, 0))
    n = np.stack([-dx, dy, np.ones_like(dx)], axis=2)
    n /= np.linalg.norm(n, axis=2, keepdims=True)
    return np.round((n * 0.5 + 0.5) * 127).astype(np.uint8) * 2


def srgb(linear):
    c = np.clip(linear, 0, 1)
    coded = np.where(c <= 0.0031308, 12.92 * c, 1.055 * c ** (1 / 2.4) - 0.055)
    return np.round(255 * coded).astype(np.uint8)


def tinted(color, field):
    """sRGB picture of a linear colour times a field around 1."""
    return srgb(np.asarray(color)[None, None, :] * field[..., None])


def leather_normal():
    """Embossed grain: rounded pebbles of about 1.6 mm between narrow valleys."""
    first, second, owner = cells(512, 66, 3)
    valley = np.clip((second - first) / 3.2, 0, 1)
    lift = np.random.default_rng(4).uniform(0.55, 1.0, 66 * 66)[owner]
    height = lift * (1 - (1 - valley) ** 2) + 0.05 * noise((512, 512), 60, 200, 5)
    return normal_map(height, 1.35)


def fabric_normal():
    """Plain weave: warp over weft, threads of 0.55 mm."""
    y, x = np.mgrid[0:256, 0:256] / 256 * 2 * np.pi * 24
    over = np.sign(np.sin(x / 2) * np.sin(y / 2))
    height = np.where(
        over > 0,
        abs(np.sin(x / 2)) * (0.6 + 0.4 * abs(np.cos(y / 2))),
        abs(np.sin(y / 2)) * (0.6 + 0.4 * abs(np.cos(x / 2))),
    )
    return normal_map(height + 0.08 * noise((256, 256), 20, 90, 8), 1.6)


def fabric_color():
    field = 1 + 0.10 * noise((256, 256), 30, 110, 9) + 0.05 * noise((256, 256), 2, 8, 10)
    return tinted((0.125, 0.127, 0.130), field)


def suede_color():
    """Alcantara: soft mottling of light grey."""
    field = 1 + 0.055 * noise((256, 256), 4, 24, 11) + 0.05 * noise((256, 256), 60, 120, 12)
    return tinted((0.47, 0.475, 0.48), field)


def wood_color():
    """Open-pore walnut: long bands along x, dark pores."""
    shape = (512, 512)
    bands = 0.6 * noise(shape, 3, 10, 21, 14) + 0.5 * noise(shape, 10, 40, 22, 22)
    warp = noise(shape, 1, 3, 23, 2)
    rows = np.arange(512)[:, None]
    ring = np.sin(2 * np.pi * (rows / 512 * 9 + 0.55 * warp))
    tone = 0.5 + 0.16 * bands + 0.14 * ring
    pores = np.clip(noise(shape, 90, 200, 24, 30) - 1.1, 0, 1)
    tone = np.clip(tone, 0, 1)[..., None]
    color = (1 - tone) * np.array([0.034, 0.016, 0.008]) + tone * np.array(
        [0.170, 0.082, 0.038]
    )
    return srgb(color * (1 - 0.75 * pores[..., None]))


def wood_normal():
    shape = (512, 512)
    pores = np.clip(noise(shape, 90, 200, 24, 30) - 0.9, 0, 1.2)
    return normal_map(-pores, 0.9)


def asphalt_color():
    shape = (320, 320)
    field = 1 + 0.22 * noise(shape, 40, 140, 31) + 0.05 * noise(shape, 2, 10, 32)
    stones = np.clip(noise(shape, 60, 140, 33) - 1.4, 0, 1)
    return tinted((0.088, 0.089, 0.092), np.clip(field + 0.9 * stones, 0.35, 3))


def asphalt_normal():
    return normal_map(noise((256, 256), 45, 120, 34), 0.22)


def grass_color():
    field = np.clip(
        1 + 0.22 * noise((256, 256), 3, 60, 41) + 0.18 * noise((256, 256), 60, 120, 42), 0.3, 2
    )
    return tinted((0.062, 0.105, 0.034), field)


def leaf_color():
    field = np.clip(1 + 0.55 * noise((256, 256), 10, 100, 51), 0.12, 2.6)
    return tinted((0.050, 0.098, 0.026), field)


def facade(wall, seed, glazing=(0.52, 0.60)):
    """Four by four windows with sills and frames; a tile is 12 m wide and high."""
    size, bay = 512, 128
    field = (
        1
        + 0.05 * noise((size, size), 2, 12, seed)
        + 0.03 * noise((size, size), 60, 200, seed + 1)
    )
    color = np.asarray(wall)[None, None, :] * field[..., None]
    y, x = np.mgrid[0:size, 0:size] % bay / bay - 0.5
    y = y - 0.02
    inside = (abs(x) < glazing[0] / 2) & (abs(y) < glazing[1] / 2)
    frame = (abs(x) < glazing[0] / 2 + 0.03) & (abs(y) < glazing[1] / 2 + 0.03)
    sill = (abs(x) < glazing[0] / 2 + 0.06) & (abs(y - glazing[1] / 2 - 0.045) < 0.022)
    color[frame] = (0.42, 0.42, 0.41)
    color[sill] = (0.30, 0.29, 0.28)
    rng = np.random.default_rng(seed + 2)
    curtains = rng.uniform(0.4, 1.8, (4, 4)).repeat(bay, 0).repeat(bay, 1)
    pane = (
        np.array([0.035, 0.045, 0.055])[None, None, :]
        * curtains[..., None]
        * (1.3 - 0.8 * y[..., None])
    )
    pane[abs(x) < 0.012] = (0.40, 0.40, 0.39)
    color[inside] = pane[inside]
    return srgb(color)


def wall_plaster():
    """Render: faint clouds, streaks that rain leaves, a fine grain; a tile is 4 m."""
    shape = (256, 256)
    streaks = noise(shape[::-1], 10, 50, 91, 14).T
    field = 1 + 0.045 * noise(shape, 1, 6, 92) + 0.035 * streaks
    field = 0.90 * field + 0.03 * noise(shape, 40, 120, 93)
    return tinted((1.0, 1.0, 1.0), np.clip(field, 0, 1))


def wall_brick():
    """Stretcher bond: bricks of 250 x 77 mm with mortar; a tile is 2 m."""
    size, courses, across = 384, 26, 8
    y, x = np.mgrid[0:size, 0:size] / size
    course = np.floor(y * courses).astype(int)
    along = (x * across + 0.5 * (course % 2)) % across
    brick = np.floor(along).astype(int)
    tone = np.random.default_rng(95).normal(0, 1, (courses, across, 2))[course, brick]
    color = np.array([0.270, 0.098, 0.062]) * (1 + 0.13 * tone[..., :1])
    color = color * (1 + np.array([0.0, 0.06, 0.10]) * tone[..., 1:])
    v, u = (y * courses) % 1, along % 1
    mortar = (np.minimum(v, 1 - v) < 0.075) | (np.minimum(u, 1 - u) < 0.024)
    color[mortar] = (0.24, 0.20, 0.17)
    return srgb(color * (1 + 0.05 * noise((size, size), 20, 160, 96)[..., None]))


def roof_tiles():
    """Courses of clay tiles that lap, in bond; the courses run along x; a tile is 2.4 m."""
    size, courses, across = 256, 8, 12
    y, x = np.mgrid[0:size, 0:size] / size
    course = np.floor(y * courses).astype(int)
    along = (x * across + 0.5 * (course % 2)) % across
    tone = np.random.default_rng(97).normal(0, 1, (courses, across))
    tone = tone[course, np.floor(along).astype(int)]
    v, u = (y * courses) % 1, along % 1
    shade = (0.55 + 0.45 * np.clip((1 - v) / 0.16, 0, 1)) * (0.75 + 0.25 * np.sin(np.pi * u))
    field = shade * (1 + 0.16 * tone) * (1 + 0.06 * noise((size, size), 2, 40, 98))
    return tinted((0.185, 0.068, 0.044), field)


def paving_color():
    """Concrete slabs of 400 mm with joints, each of its own tone; a tile is 2 m."""
    size, across = 320, 5
    y, x = np.mgrid[0:size, 0:size] / size * across
    tone = np.random.default_rng(101).normal(0, 1, (across, across))
    v, u = y % 1, x % 1
    edge = np.minimum(np.minimum(u, 1 - u), np.minimum(v, 1 - v))
    field = (1 + 0.06 * tone[y.astype(int), x.astype(int)]) * np.where(edge < 0.016, 0.45, 1)
    shape = (size, size)
    field = field * (1 + 0.05 * noise(shape, 60, 150, 102) + 0.06 * noise(shape, 1, 8, 103))
    return tinted((0.265, 0.258, 0.242), np.clip(field, 0.2, 2))


def hills_color():
    """Woods and meadows in the haze of half a kilometre; a tile is 160 m."""
    shape = (256, 256)
    wood = np.clip(2.2 * noise(shape, 1, 5, 105) + 0.9, 0, 1)[..., None]
    trees = np.clip(1 + 0.30 * noise(shape, 18, 60, 106), 0.3, 2)[..., None]
    meadow = np.clip(1 + 0.06 * noise(shape, 4, 40, 107), 0, 2)[..., None]
    color = wood * np.array([0.062, 0.094, 0.070]) * trees
    return srgb(color + (1 - wood) * np.array([0.135, 0.180, 0.100]) * meadow)


def perforated_normal():
    """Perforated leather of seats: round holes 4 mm apart over a fine grain."""
    y, x = np.mgrid[0:256, 0:256]
    pitch = 32
    odd = (y // pitch) % 2
    dx = (x + odd * pitch / 2) % pitch - pitch / 2
    dy = y % pitch - pitch / 2
    hole = np.clip((np.hypot(dx, dy) - 3.5) / 3.0, 0, 1)
    return normal_map(2.0 * hole + 0.16 * noise((256, 256), 40, 120, 61), 0.8)


TEXTURES = {
    "leather_normal": leather_normal,
    "fabric_normal": fabric_normal,
    "fabric_color": fabric_color,
    "suede_color": suede_color,
    "wood_color": wood_color,
    "wood_normal": wood_normal,
    "asphalt_color": asphalt_color,
    "asphalt_normal": asphalt_normal,
    "grass_color": grass_color,
    "leaf_color": leaf_color,
    "perforated_normal": perforated_normal,
    "paving_color": paving_color,
    "hills_color": hills_color,
    "wall_plaster": wall_plaster,
    "wall_brick": wall_brick,
    "roof_tiles": roof_tiles,
    "facade_plaster": lambda: facade((0.55, 0.50, 0.42), 71),
    "facade_brick": lambda: facade((0.26, 0.115, 0.075), 75, (0.46, 0.62)),
    "facade_office": lambda: facade((0.36, 0.37, 0.38), 79, (0.86, 0.58)),
}


def write_textures(folder, names=None):
    os.makedirs(folder, exist_ok=True)
    for name in names or TEXTURES:
        write_png(os.path.join(folder, name + ".png"), TEXTURES[name]())


if __name__ == "__main__":
    import sys

    write_textures(sys.argv[1], sys.argv[2:])
