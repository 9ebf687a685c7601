# SPDX-License-Identifier: Apache-2.0
"""The main instrument panel: displays in their bezels, standby instrument, landing gear."""
import math

from mathutils import Matrix

from deck_layout import DISPLAYS, PANEL, PANEL_FOOT, PANEL_HALF, PANEL_HEIGHT
from kit import Kit, shifted
from shapes import frame_matrix, mesh, place, rounded_rectangle

BEZEL = 0.0145  # m, width of a display's frame
DEEP = 0.0035  # m, how far the glass lies behind the frame's face


def display_quad(name, size, matrix, uv=(0.0, 0.0, 1.0, 1.0), material=None):
    """An active area: u to the viewer's right, v (of glTF) down; uv: left, top, right, bottom
    of its picture."""
    w, h = 0.5 * size[0], 0.5 * size[1]
    corners = place([(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)], matrix)
    left, top, right, bottom = uv
    item = mesh(
        name,
        corners,
        [(0, 1, 2, 3)],
        material or name,
        [(left, 1 - bottom), (right, 1 - bottom), (right, 1 - top), (left, 1 - top)],
    )
    item["keep_uv"] = True
    return item


def bezel(kit, matrix, size, width=BEZEL, keys=0):
    """A moulded frame with a sloping inner edge; keys: line-select keys down both sides."""
    w, h = size
    face = 0.0085
    kit.ring(
        rounded_rectangle(w, h, 0.0045, 5),
        [
            (-0.0002, face - DEEP - 0.0006),
            (width, 0.0),
            (width, face - 0.0014),
            (width - 0.0014, face),
            (0.0030, face),
            (0.0014, face - 0.0008),
        ],
        matrix,
        "bezel",
    )
    for sx in (-1, 1):
        for sy in (-1, 1):
            kit.screw(
                shifted(
                    matrix,
                    sx * (0.5 * w + 0.55 * width),
                    sy * (0.5 * h + 0.55 * width),
                    face,
                ),
                0.0023,
            )
        for k in range(keys):
            y = (k - 0.5 * (keys - 1)) * (h * 0.84 / max(keys - 1, 1))
            kit.button(
                shifted(matrix, sx * (0.5 * w + 0.56 * width), y, face),
                (0.0085, 0.0055),
                "key",
                0.0022,
            )


def displays(kit):
    for name, (x, y, w, h) in DISPLAYS.items():
        at = shifted(PANEL, x, y, 0.002)
        small = name == "standby"
        bezel(kit, at, (w, h), 0.010 if small else BEZEL, 0)
        display_quad(name, (w, h), shifted(at, z=0.0085 - DEEP))
        if small:
            standby_keys(kit, at, h)


def standby_keys(kit, at, h):
    row = shifted(at, 0, -0.5 * h - 0.0255)
    kit.panel((0.098, 0.030), row, "bezel", 0.0085, 0.004)
    top = shifted(row, z=0.0085)
    for i, name in enumerate(("BUGS", "LS", "+", "-")):
        key = shifted(top, -0.034 + 0.0155 * i, 0.0)
        kit.button(key, (0.0115, 0.0095), "key", 0.0026)
        kit.text(name, shifted(key, z=0.0027), 0.0026)
    kit.knob(shifted(top, 0.034, 0.0), 0.0070, 0.012)
    kit.text("BARO", shifted(top, 0.034, 0.0125), 0.0026)


def panel_face(kit):
    """The plates that the displays sit on, with gaps between them."""
    spans = [(-PANEL_HALF, -0.165), (-0.1635, 0.1635), (0.165, PANEL_HALF)]
    for a, b in spans:
        at = shifted(PANEL, 0.5 * (a + b), 0, -0.010)
        kit.box((b - a, PANEL_HEIGHT, 0.024), at, "panel", 0.002)
        size = (b - a, PANEL_HEIGHT)
        kit.screws(shifted(at, z=0.012), size, 0.009, 0.0032)
    kit.box((2 * PANEL_HALF + 0.04, PANEL_HEIGHT + 0.01, 0.01), shifted(PANEL, z=-0.03), "gap")


def outboard(kit, side):
    """Beside each pilot's displays: switches for source and brightness."""
    at = shifted(PANEL, side * 0.7440, 0, 0.002)
    kit.panel((0.036, 0.205), shifted(at, 0, 0.008), "panel dark", 0.003, 0.003)
    face = shifted(at, 0, 0.008, 0.003)
    kit.screws(face, (0.036, 0.205), 0.0050, 0.0020)
    for i, name in enumerate(("PFD", "ND", "SPKR")):
        y = 0.074 - 0.048 * i
        kit.knob(shifted(face, 0, y, 0, 25 - 40 * i), 0.0082, 0.013)
        kit.text(name, shifted(face, 0, y + 0.0165), 0.0036)
        kit.text("OFF", shifted(face, -0.0115, y - 0.0115), 0.0022)
        kit.text("BRT", shifted(face, 0.0115, y - 0.0115), 0.0022)
    for i, name in enumerate(("XFR", "TERR")):
        y = -0.062 - 0.026 * i
        kit.button(shifted(face, 0, y), (0.0150, 0.0130), "key", 0.004)
        if i:
            kit.text("ON", shifted(face, 0, y - 0.002, 0.0042), 0.0036, "lit green")
        kit.text(name, shifted(face, 0, y + 0.0105), 0.0028)


def gear_and_brakes(kit):
    """The landing gear's lever and lights, below the standby instrument."""
    at = shifted(PANEL, -0.098, -0.074, 0.002)
    kit.panel((0.098, 0.092), at, "panel dark", 0.003, 0.003)
    face = shifted(at, z=0.003)
    kit.screws(face, (0.098, 0.092), 0.0055, 0.0022)
    lights = shifted(face, -0.022, 0.020)
    kit.panel((0.044, 0.030), lights, "window black", 0.003, 0.002)
    for i in range(3):
        lamp = shifted(lights, -0.0145 + 0.0145 * i, 0.004, 0.0032)
        kit.line([(-0.005, 0.003), (0.005, 0.003)], lamp, 0.0011, "legend dim")
        kit.text("UNLK", shifted(lamp, 0, -0.003), 0.0024, "legend dim")
    kit.text("LDG GEAR", shifted(face, -0.022, 0.0395), 0.0036)
    for i, name in enumerate(("LO", "MED", "MAX")):
        key = shifted(face, -0.0365 + 0.0145 * i, -0.016)
        kit.button(key, (0.0112, 0.0112), "key", 0.0036)
        kit.text(name, shifted(key, 0, 0.0102), 0.0025)
    kit.text("AUTO BRK", shifted(face, -0.022, -0.0275), 0.0030)
    gear_lever(kit, shifted(face, 0.026, 0.004))


def gear_lever(kit, slot):
    kit.panel((0.016, 0.066), slot, "gap", 0.0008, 0.007)
    kit.text("UP", shifted(slot, 0.0155, 0.030), 0.0036)
    kit.text("DOWN", shifted(slot, 0.0155, -0.032), 0.0030)
    stem = shifted(slot, 0, 0.022)
    kit.lathe([(0.0032, 0), (0.0032, 0.030)], stem, "lever", 12)
    wheel = stem @ Matrix.Translation((0, 0, 0.036)) @ Matrix.Rotation(math.pi / 2, 4, "Y")
    wheel = wheel @ Matrix.Translation((0, 0, -0.0065))
    profile = [
        (0.0085, 0),
        (0.0115, 0.0015),
        (0.0128, 0.0040),
        (0.0128, 0.0090),
        (0.0115, 0.0115),
        (0.0085, 0.0130),
        (0.0050, 0.0118),
    ]
    kit.lathe(profile, wheel, "handle", 24)


def knee_shelf(kit):
    """Below the panel: sliding tables' edges, and the dark space over the pedals."""
    y, z = PANEL_FOOT
    for side in (-1, 1):
        middle = side * (PANEL_HALF + 0.20) / 2
        wide = PANEL_HALF - 0.20
        shelf = frame_matrix((middle, y - 0.018, z - 0.014), (1, 0, 0), (0, 1, 0))
        kit.box((wide, 0.060, 0.024), shelf, "panel", 0.004)
        table = frame_matrix((middle, y - 0.050, z - 0.017), (1, 0, 0), (0, 1, 0))
        kit.box((wide * 0.72, 0.014, 0.013), table, "panel dark", 0.003)
        grip = frame_matrix((middle, y - 0.060, z - 0.017), (1, 0, 0), (0, 1, 0))
        kit.box((0.085, 0.010, 0.007), grip, "gap", 0.002)
        below = frame_matrix((middle, y + 0.02, z - 0.10), (1, 0, 0), (0, 0, 1))
        kit.box((wide + 0.03, 0.15, 0.012), below, "panel dark", 0.003)
        for k in (-1, 1):
            vent = shifted(below, k * 0.13, 0, 0.006)
            kit.lathe(
                [(0.034, 0), (0.034, 0.006), (0.029, 0.008), (0.024, 0.002)], vent, "bezel", 28
            )


def build_panel():
    kit = Kit("main panel")
    panel_face(kit)
    displays(kit)
    for side in (-1, 1):
        outboard(kit, side)
    gear_and_brakes(kit)
    knee_shelf(kit)
    kit.build()
