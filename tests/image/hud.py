# SPDX-License-Identifier: Apache-2.0
"""hud.py PARHELION -- the car's head-up display (scenes/car_hud.gltf) in its windscreen: where
its virtual image stands, seen from five places; its ghost and the wedge that takes it away;
which way round it is; how bright it is in polarised light and through sunglasses.
"""
import json
import math
import os
import shutil
import subprocess
import sys
import tempfile

from exr import Frame
from eye import luminances, mean
from gltf import png

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

EYE, DISTANCE, DOWN = (-0.37, 1.30, 0.0), 2.5, 5.5  # glTF's axes, m, degrees: hud_optics.py
GHOST = (-1.15, 5.41)  # minutes of arc to the right and up, of a pane without a wedge, and
LEFT = 0.73            # to the left, what a wedge leaves: model_hud.py's own trace of rays
PIXELS = (1080, 684)   # of the picture


def virtual_image():
    a = math.radians(DOWN)
    return (EYE[0], EYE[1] - DISTANCE * math.sin(a), EYE[2] - DISTANCE * math.cos(a))


def windscreen_alone(folder, wedge):
    """The shipped windscreen of the shipped car, and nothing else of it."""
    with open(os.path.join(ROOT, "scenes", "car_dashboard.gltf"), encoding="utf-8") as file:
        car = json.load(file)
    node = next(n for n in car["nodes"] if n["name"] == "windscreen")
    primitive = car["meshes"][node["mesh"]]["primitives"][0]
    material = car["materials"][primitive["material"]]
    layers = material["extensions"]["PARHELION_glazing"]["layers"]
    shipped = max(layer.get("wedge_rad", 0) for layer in layers)
    if not wedge:
        for layer in layers:
            layer.pop("wedge_rad", None)
            layer.pop("wedge_toward", None)
    data, views, accessors = b"", [], []
    with open(os.path.join(ROOT, "scenes", "car_dashboard.bin"), "rb") as file:
        binary = file.read()

    def packed(number):
        nonlocal data
        accessor = dict(car["accessors"][number])
        view = dict(car["bufferViews"][accessor["bufferView"]])
        at = view.get("byteOffset", 0)
        view["byteOffset"], accessor["bufferView"] = len(data), len(views)
        data += binary[at:at + view["byteLength"]]
        data += b"\0" * (-len(data) % 4)
        views.append(view)
        accessors.append(accessor)
        return len(accessors) - 1

    primitive = {"attributes": {k: packed(v) for k, v in primitive["attributes"].items()},
                 "indices": packed(primitive["indices"]), "material": 0}
    scene = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
             "extensionsUsed": sorted(material["extensions"]), "materials": [material],
             "nodes": [{"mesh": 0}], "meshes": [{"primitives": [primitive]}],
             "accessors": accessors, "bufferViews": views,
             "buffers": [{"uri": "pane.bin", "byteLength": len(data)}]}
    with open(os.path.join(folder, "pane.bin"), "wb") as file:
        file.write(data)
    with open(os.path.join(folder, "wedge.gltf" if wedge else "plain.gltf"), "w",
              encoding="utf-8") as file:
        json.dump(scene, file)
    return shipped


def build(top):
    """Copies of what the display needs, in folders as they ship."""
    for name in ("scenes", "assets/panels", "assets/spectra", "assets/content"):
        os.makedirs(os.path.join(top, name))
    for name in ("scenes/car_hud.gltf", "scenes/car_hud.bin", "assets/content/hud.png",
                 "assets/panels/hud_pgu.panel", "assets/panels/hud_pgu_p.panel",
                 "assets/spectra/glass_green.csv"):
        shutil.copy(os.path.join(ROOT, name), os.path.join(top, name))
    folder = os.path.join(top, "scenes")
    shipped = [windscreen_alone(folder, wedge) for wedge in (True, False)][0]
    (columns, rows), black = PIXELS, [0] * 3 * PIXELS[0]
    line = black[:3 * (columns // 2 - 3)] + [255] * 18 + black[:3 * (columns // 2 - 3)]
    spot = [line if abs(y + 0.5 - rows / 2) < 2 else black for y in range(rows)]
    with open(os.path.join(folder, "spot.png"), "wb") as file:
        file.write(png(*PIXELS, spot))
    with open(os.path.join(folder, "white.png"), "wb") as file:
        file.write(png(2, 2, [[255] * 6] * 2))
    return folder, shipped


class Eye:
    def __init__(self, program, folder):
        self.program, self.folder = program, folder

    def frame(self, pane, *options, at=(0, 0, 0), to=(0, 0)):
        """Seen from `at` beside the middle of the eye box; to: minutes of arc off the image."""
        eye, image = [a + b for a, b in zip(EYE, at)], list(virtual_image())
        turn = DISTANCE * math.radians(1 / 60)
        image[0] += turn * to[0]
        image[1] += turn * to[1] * math.cos(math.radians(DOWN))
        image[2] -= turn * to[1] * math.sin(math.radians(DOWN))
        done = subprocess.run(
            [self.program, "render", pane, "car_hud.gltf", "-o", "frame.exr", "--eye",
             ",".join(f"{x:.6f}" for x in eye), "--look-at",
             ",".join(f"{x:.6f}" for x in image), *options, "--quiet"],
            cwd=self.folder, capture_output=True, text=True, check=False)
        assert done.returncode == 0, done.stderr
        return Frame(os.path.join(self.folder, "frame.exr"))


# ---- where it stands -----------------------------------------------------------------------

SIDE, FIELD = 96, 24  # pixels and minutes of arc of a close look
CLOSE = ("--content", "hud=spot.png", "--size", f"{SIDE}x{SIDE}", "--fov", str(FIELD / 60),
         "--spp", "64")


def centre(values, rows=(0, SIDE)):
    """(right, up) in minutes of arc of the light in some rows, and how much it is; what is
    fainter than a tenth of the brightest is the picture's black."""
    sums, least = [0.0, 0.0, 0.0], 0.1 * max(values[rows[0] * SIDE:rows[1] * SIDE])
    for y in range(*rows):
        for x in range(SIDE):
            light = values[y * SIDE + x]
            if light < least:
                continue
            sums[0] += light * ((x + 0.5) / SIDE - 0.5) * FIELD
            sums[1] += light * (0.5 - (y + 0.5) / SIDE) * FIELD
            sums[2] += light
    return sums[0] / sums[2], sums[1] / sums[2], sums[2]


def check_distance(report, eye):
    """An image in another distance moves against the point where it should be. The rows about
    the middle hold the image, the ghost above it is left out."""
    rows = (SIDE // 2 - SIDE * 3 // FIELD, SIDE // 2 + SIDE * 3 // FIELD)
    found = {}
    for at in ((0, 0, 0), (-0.0325, 0, 0), (0.0325, 0, 0), (0, 0.015, 0), (0, -0.015, 0)):
        right, up, _ = centre(luminances(eye.frame("plain.gltf", *CLOSE, at=at)), rows)
        found[at] = right
        report.claim(math.hypot(right, up) < 1,
                     f"from {at} the image stands {right:.2f}, {up:.2f} minutes beside its "
                     f"place")
    apart = math.degrees(0.065 / DISTANCE) * 60
    seen = apart - (found[(0.0325, 0, 0)] - found[(-0.0325, 0, 0)])
    distance = DISTANCE * apart / seen
    print(f"virtual image at {distance:.4f} m")
    report.claim(abs(distance / DISTANCE - 1) < 0.02,
                 f"two eyes see the image at {distance:.3f} m, required: {DISTANCE}")


# ---- the ghost -----------------------------------------------------------------------------

def check_ghost(report, eye, shipped):
    report.claim(shipped > 0, f"the shipped windscreen has a wedge of {shipped} rad")
    half = SIDE // 2
    beyond = half - SIDE * 3 // FIELD  # rows further up than 3 minutes
    second = half - SIDE * 8 // FIELD  # a ghost of the second order stands above 8
    plain = luminances(eye.frame("plain.gltf", *CLOSE))
    right, up, ghost = centre(plain, (second, beyond))
    x, y, image = centre(plain, (beyond, SIDE))
    off = math.hypot(right - x - GHOST[0], up - y - GHOST[1])
    print(f"ghost {right - x:.2f}, {up - y:.2f} minutes beside the image")
    report.claim(off < 0.03 * math.hypot(*GHOST),
                 f"without a wedge the ghost stands {right - x:.2f}, {up - y:.2f} minutes "
                 f"beside the image, required: {GHOST}")
    report.claim(0.2 < ghost / image < 0.9, f"the ghost has {ghost / image:.3f} of its light")
    cured = luminances(eye.frame("wedge.gltf", *CLOSE))
    bright = max(max(cured[y * SIDE:(y + 1) * SIDE]) for y in range(beyond, SIDE))
    stray = max(max(cured[y * SIDE:(y + 1) * SIDE]) for y in range(beyond))
    report.claim(stray < 0.05 * bright,
                 f"with the wedge {stray / bright:.3f} of the image is left above it")
    side, height, _ = centre(cured)
    moved = LEFT * ghost / (image + ghost)
    print(f"with the wedge their centre stands {side - x:.2f}, {height - y:.2f} minutes off")
    report.claim(math.hypot(side - x + moved, height - y) < 0.1,
                 f"with it their centre stands {side - x:.2f}, {height - y:.2f} minutes off "
                 f"the image alone, required: {-moved:.2f}, 0")


# ---- what it shows -------------------------------------------------------------------------

def check_reading(report, eye):
    """The red ring is on the left, the arrow on the right, what is below the speed is below."""
    frame = eye.frame("wedge.gltf", "--size", "160x64", "--fov", "1.6", "--spp", "16")
    places = {"red": [], "cyan": [], "white": []}
    peak = max(luminances(frame))
    for i, (r, g, b) in enumerate(zip(*(frame.channels[c] for c in "RGB"))):
        if max(r, g, b) < 0.1 * peak:
            continue
        colour = "red" if r > 3 * g else "cyan" if g > 1.25 * r else "white"
        places[colour].append((i % 160 - 80, 32 - i // 160))
    middle = {name: [mean(axis) for axis in zip(*at)] for name, at in places.items() if at}
    report.claim(len(middle) == 3 and middle["red"][0] < -40 and middle["cyan"][0] > 5,
                 f"left and right: {middle}")
    arrow = [at for at in places["cyan"] if at[0] > 25 and at[1] > -12]
    head = mean([y for x, y in arrow if x > 53])
    foot = mean([y for x, y in arrow if x < 42])
    report.claim(head > foot + 5, f"the arrow's head is at {head:.1f}, its foot at {foot:.1f}")


# ---- its light -----------------------------------------------------------------------------

def check_light(report, eye):
    """s beside p at 68.4 degrees, which a slab mirrors so; glasses with an upright axis take
    what is s. The picture's white fills the frame."""
    options = ("--content", "hud=white.png", "--size", "16x8", "--fov", "0.3", "--spp", "64")
    s = eye.frame("wedge.gltf", *options, "--polarised")
    p = eye.frame("wedge.gltf", *options, "--polarised", "--panel",
                  "hud=../assets/panels/hud_pgu_p.panel")
    plain, dark, clear = (
        mean(luminances(eye.frame("wedge.gltf", *options, *more))) for more in (
            (), ("--sunglasses", "0"),
            ("--sunglasses", "0", "--panel", "hud=../assets/panels/hud_pgu_p.panel")))
    s, p = mean(luminances(s)), mean(luminances(p))
    print(f"white: s {s:.0f}, p {p:.0f}, unpolarised {plain:.0f}, through sunglasses "
          f"{dark:.0f} and {clear:.0f} cd/m2")
    through = 0.775  # once through the glass and back, of 0.91 a sheet: no law, a plausible one
    cosine = math.cos(math.radians(68.39))
    inside = math.sqrt(1 - (1 - cosine ** 2) / 1.52 ** 2)
    faces = [((cosine - 1.52 * inside) / (cosine + 1.52 * inside)) ** 2,
             ((1.52 * cosine - inside) / (1.52 * cosine + inside)) ** 2]
    slab = [r + (1 - r) ** 2 * r * through ** 2 / (1 - (r * through) ** 2) for r in faces]
    white = 80000 * 0.92
    wanted = [white * (0.99 * slab[k] + 0.01 * slab[1 - k]) for k in (0, 1)]
    report.claim(abs(s / wanted[0] - 1) < 0.06, f"s: {s:.0f} cd/m2, required: {wanted[0]:.0f}")
    report.claim(abs(p / wanted[1] - 1) < 0.2, f"p: {p:.0f} cd/m2, required: {wanted[1]:.0f}")
    report.claim(abs((s + p) / 2 / plain - 1) < 0.02, f"s {s:.0f} and p {p:.0f} are on average "
                                                      f"the unpolarised {plain:.0f}")
    report.claim(dark < 0.08 * s and clear > 0.7 * p,
                 f"through sunglasses: s {dark:.0f} of {s:.0f}, p {clear:.0f} of {p:.0f}")


def main():
    program, report = os.path.abspath(sys.argv[-1]), Report()
    with tempfile.TemporaryDirectory() as top:
        folder, shipped = build(top)
        eye = Eye(program, folder)
        check_distance(report, eye)
        check_ghost(report, eye, shipped)
        check_reading(report, eye)
        check_light(report, eye)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
