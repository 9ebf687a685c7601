# SPDX-License-Identifier: Apache-2.0
"""rooms.py -- small random cockpits: a room with one to three windows, open or of glass, one or
two displays, coated or not, walls and trim of any gloss, lamps, and an eye.

Metres; the first display lies in the plane z = 0 and faces the eye, +Z. Every fifth room has
nothing in it but its display: what that reflects of a uniform sky is a closed form.
"""
import os
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
from gltf import Scene, png, unit  # noqa: E402

SYMBOL_UV = [0.1, 0.1, 0.9, 0.9]
WIDTH, HEIGHT = 0.3, 0.15
PANELS = ["ips_cluster.panel", "oled_centre.panel"]
SINGLE_MGF2 = {"layers": [{"n": 1.38, "k": 0, "thickness_nm": 99.6}]}


def display(scene, draw, name, is_bare=False):
    """A material that shows bright bars on black."""
    bars = png(60, 30, [[255 if 20 <= x < 40 and 8 <= y < 22 else 0 for x in range(60)
                         for _ in range(3)] for y in range(30)])
    extensions = {"PARHELION_display": {
        "panel": draw.choice(PANELS), "content": {"index": scene.image("image/png", bars)}}}
    if not is_bare and draw.random() < 0.3:
        extensions["PARHELION_coating"] = SINGLE_MGF2
    return scene.material(name, extensions=extensions)


def surface(scene, draw):
    """Of a wall or a trim: cloth, plastic, lacquer, metal."""
    kind, tone = draw.random(), draw.uniform(0.02, 0.85)
    if kind < 0.4:
        return scene.lambert(tone)
    if kind < 0.7:
        return scene.material(pbrMetallicRoughness={
            "baseColorFactor": [tone, 0.8 * tone, 0.6 * tone, 1], "metallicFactor": 0,
            "roughnessFactor": draw.uniform(0.05, 0.9)})
    return scene.metal(draw.uniform(0.3, 0.95), draw.uniform(0.15, 0.7))


class Room:
    """The scene with what was drawn for it."""

    def __init__(self, draw, is_empty):
        self.scene, self.is_empty = Scene(), is_empty
        self.half, self.deep = draw.uniform(0.4, 0.9), draw.uniform(1.1, 1.8)
        self.low, self.high = draw.uniform(-0.6, -0.2), draw.uniform(0.35, 0.9)
        self.scene.quad(display(self.scene, draw, "screen", is_empty),
                        [-WIDTH / 2, -HEIGHT / 2, 0], [WIDTH, 0, 0], [0, HEIGHT, 0])
        self.eye = [draw.uniform(-0.3, 0.3), draw.uniform(-0.1, 0.3), draw.uniform(0.6, 0.9)]
        self.scene.view("eye", self.eye, unit([-x for x in self.eye]), 14)
        self.has_lamps = False
        if not is_empty:
            self.add_walls(draw)
            self.add_trim(draw)
            self.add_lamps(draw)

    def add_walls(self, draw):
        """Five walls, the front open about the display; windows are left out or glazed."""
        w, d, h = 2 * self.half, self.deep + 0.1, self.high - self.low
        walls = [([-self.half, self.low, self.deep], [w, 0, 0], [0, 0, -d]),
                 ([-self.half, self.high, -0.1], [w, 0, 0], [0, 0, d]),
                 ([-self.half, self.low, self.deep], [0, 0, -d], [0, h, 0]),
                 ([self.half, self.low, -0.1], [0, 0, d], [0, h, 0]),
                 ([self.half, self.low, self.deep], [-w, 0, 0], [0, h, 0])]
        windows = draw.sample(range(5), draw.randint(1, 3))
        for i, sides in enumerate(walls):
            if i not in windows:
                self.scene.quad(surface(self.scene, draw), *sides)
            elif draw.random() < 0.5:
                self.scene.quad(self.scene.window(1.52, [draw.uniform(0.6, 1)] * 3), *sides)

    def add_trim(self, draw):
        """A strip below the display, tilted towards it, that may glint; a second display to the
        side, or nothing."""
        if draw.random() < 0.6:
            self.scene.quad(surface(self.scene, draw), [-0.2, -0.13, 0.12], [0.4, 0, 0],
                            [0, draw.uniform(0.005, 0.04), -0.11])
        if draw.random() < 0.4:
            side = draw.choice([-1, 1])
            self.scene.facing_quad(display(self.scene, draw, "second"),
                                   [0.9 * side * self.half, 0.02, 0.45], [-side, 0, 0], WIDTH,
                                   HEIGHT)

    def add_lamps(self, draw):
        if draw.random() < 0.5:
            return
        self.has_lamps = True
        place = [draw.uniform(-0.3, 0.3), self.high - 0.06, draw.uniform(0.3, 1)]
        if draw.random() < 0.5:
            self.scene.light("point", draw.uniform(1, 30), place)
        else:
            self.scene.facing_quad(self.scene.emitter(draw.uniform(200, 5000)), place,
                                   [0, -1, 0], draw.uniform(0.02, 0.2))

    def panel(self):
        """The first display's."""
        of = self.scene.document["materials"][0]["extensions"]["PARHELION_display"]
        return of["panel"]
