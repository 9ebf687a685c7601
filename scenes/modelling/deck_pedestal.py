# SPDX-License-Identifier: Apache-2.0
"""The centre pedestal: flight management keyboards, throttles, flap lever, trim, radios."""
import math

from mathutils import Matrix

from deck_layout import PEDESTAL, PEDESTAL_HALF, pedestal_length, pedestal_plane
from deck_panel import display_quad
from kit import Kit, shifted
from shapes import mesh


def body(kit):
    """The pedestal's sides and top plates."""
    top = [(y, z) for y, z in PEDESTAL]
    count = len(top)
    for side in (-1, 1):
        x = side * PEDESTAL_HALF
        points = [(x, y, z - 0.002) for y, z in top] + [
            (x, top[-1][0], 0.0),
            (x, top[0][0], 0.0),
        ]
        mesh(f"pedestal side {side}", points, [list(range(count + 2))], "panel dark")
    y, z = top[-1]
    h = PEDESTAL_HALF
    mesh(
        "pedestal rear",
        [(-h, y, 0), (h, y, 0), (h, y, z), (-h, y, z)],
        [(0, 1, 2, 3)],
        "panel dark",
    )
    for i in range(count - 1):
        at = pedestal_plane(i)
        kit.box(
            (2 * PEDESTAL_HALF, pedestal_length(i) + 0.002, 0.016),
            shifted(at, z=-0.008),
            "panel" if i != 1 else "panel dark",
            0.002,
        )


LETTERS = "ABCDEFGHIJKLMNOPQRSTUVWXYZ"


def cdu(kit, x, name):
    """A control display unit: screen, line keys, function and letter keys."""
    at = shifted(pedestal_plane(0), x, 0.002)
    w, h = 0.164, 0.192
    kit.panel((w, h), at, "bezel", 0.010, 0.005, 0.001)
    face = shifted(at, z=0.010)
    kit.screws(face, (w, h), 0.0055, 0.0024)
    screen = shifted(face, 0, 0.048)
    display_quad(f"{name} screen", (0.098, 0.074), shifted(screen, z=0.0012), material="cdu")
    kit.ring(
        [(-0.049, -0.037), (0.049, -0.037), (0.049, 0.037), (-0.049, 0.037)],
        [(0, 0.0004), (0.006, 0), (0.006, 0.0024), (0.002, 0.0024)],
        screen,
        "stick",
    )
    for k in range(6):
        for sx in (-1, 1):
            key = shifted(face, sx * 0.066, 0.074 - 0.0104 * k)
            kit.button(key, (0.0125, 0.0062), "key", 0.0026)
            kit.line([(-0.003, 0), (0.003, 0)], shifted(key, z=0.0028), 0.0008)
    functions = ("DIR", "PROG", "PERF", "INIT", "DATA", "F-PLN", "RAD", "FUEL", "SEC", "ATC")
    for k, label in enumerate(functions):
        key = shifted(face, -0.058 + 0.0290 * (k % 5), -0.0055 - 0.0115 * (k // 5))
        kit.button(key, (0.0250, 0.0092), "key", 0.0026)
        kit.text(label, shifted(key, z=0.0028), 0.0034)
    keyboard(kit, shifted(face, 0, -0.055))


def keyboard(kit, at):
    for k, letter in enumerate(LETTERS + "/ "):
        key = shifted(at, 0.0015 + 0.0124 * (k % 6), 0.0275 - 0.0124 * (k // 6))
        kit.button(key, (0.0096, 0.0096), "key light" if letter in "/ " else "key", 0.003)
        kit.text(letter if letter != " " else "SP", shifted(key, z=0.0032), 0.0046)
    for k, digit in enumerate("123456789.0-"):
        key = shifted(at, -0.0560 + 0.0155 * (k % 3), 0.0275 - 0.0155 * (k // 3))
        kit.lathe([(0.0058, 0), (0.0058, 0.0026), (0.0050, 0.0032)], key, "key", 18)
        kit.text(digit, shifted(key, z=0.0034), 0.0052)


def slot(kit, at, length, marks):
    kit.panel((0.009, length), at, "gap", 0.0008, 0.004, 0.0002)
    for share, label in marks:
        spot = shifted(at, 0.0125, (0.5 - share) * length)
        kit.line([(-0.0055, 0), (-0.001, 0)], spot, 0.0010)
        kit.text(label, shifted(spot, 0.0015, 0), 0.0040, align=0.0)


def lever_frame(plane, x, share, lean_deg, length):
    """Origin at the lever's hinge in its slot, z along the lever."""
    base = shifted(plane, x, (0.5 - share) * length)
    return base @ Matrix.Rotation(math.radians(lean_deg), 4, "X")


def throttle(kit, plane, x, side):
    """A tall blade with a cranked grip and the take-off switch at its side."""
    at = lever_frame(plane, x, 0.42, -14.0, 0.20)
    kit.box((0.010, 0.020, 0.090), shifted(at, z=0.045), "lever", 0.003)
    grip = shifted(at, side * 0.004, -0.004, 0.098)
    kit.box((0.040, 0.034, 0.036), grip, "stick", 0.009)
    kit.box((0.034, 0.040, 0.012), shifted(grip, 0, 0.002, 0.020), "stick", 0.0055)
    lever_button = grip @ Matrix.Translation((-side * 0.020, -0.004, 0.004))
    lever_button = lever_button @ Matrix.Rotation(-side * math.pi / 2, 4, "Y")
    kit.lathe([(0.0055, 0), (0.0055, 0.003), (0.004, 0.004)], lever_button, "guard red", 16)
    kit.line([(-0.012, -0.0174), (0.012, -0.0174)], shifted(grip, z=0.0266), 0.0014)
    kit.text("1" if side < 0 else "2", shifted(grip, 0, -0.004, 0.0264), 0.0085)


def quadrant(kit):
    plane = pedestal_plane(1, 0.30)
    kit.panel((0.150, 0.235), plane, "panel", 0.003, 0.006)
    face = shifted(plane, z=0.003)
    kit.screws(face, (0.150, 0.235), 0.0075, 0.003)
    marks = ((0.12, "TO GA"), (0.30, "FLX MCT"), (0.45, "CL"), (0.92, "0"))
    for side in (-1, 1):
        slot(kit, shifted(face, side * 0.026), 0.20, marks if side > 0 else ())
        throttle(kit, face, side * 0.026, side)
    for k in range(12):
        y = 0.09 - 0.015 * k
        kit.line([(-0.008, y), (0.008, y)], face, 0.0009 if k % 3 else 0.0014, "legend dim")


def trim_wheel(kit, x):
    plane = pedestal_plane(1, 0.34)
    at = shifted(plane, x, 0, -0.040) @ Matrix.Rotation(math.pi / 2, 4, "Y")
    at = at @ Matrix.Translation((0, 0, -0.007))
    kit.lathe(
        [
            (0.070, 0),
            (0.0905, 0.0005),
            (0.094, 0.003),
            (0.094, 0.011),
            (0.0905, 0.0135),
            (0.070, 0.014),
        ],
        at,
        "stick",
        72,
        0.018,
    )
    rim = at @ Matrix.Translation((0, 0, 0.0142))
    for k in range(24):
        a = 2 * math.pi * k / 24
        c, s = math.cos(a), math.sin(a)
        for z in (0.0, -0.0147):
            kit.line(
                [(0.078 * c, 0.078 * s), (0.090 * c, 0.090 * s)],
                rim @ Matrix.Translation((0, 0, z)),
                0.0022,
            )


def side_levers(kit):
    """Speed brake on the left, flaps on the right, each in its gate."""
    for side, title, names, share in (
        (-1, "SPEED BRAKE", ("RET", "1/2", "FULL"), 0.12),
        (1, "FLAPS", ("0", "1", "2", "3", "FULL"), 0.10),
    ):
        plane = pedestal_plane(1, 0.34)
        at = shifted(plane, side * 0.146, 0, 0)
        kit.panel((0.066, 0.215), at, "panel", 0.003, 0.005)
        face = shifted(at, z=0.003)
        kit.screws(face, (0.066, 0.215), 0.0065, 0.0026)
        marks = [(0.06 + 0.88 * k / (len(names) - 1), n) for k, n in enumerate(names)]
        gate = shifted(face, -0.006, -0.006)
        slot(kit, gate, 0.165, marks)
        kit.text(title, shifted(face, 0, 0.094), 0.0044)
        stem = lever_frame(gate, 0, share, -6.0, 0.165)
        kit.box((0.0045, 0.014, 0.060), shifted(stem, z=0.03), "lever", 0.0015)
        head = shifted(stem, 0, 0, 0.066)
        if side > 0:
            kit.box((0.044, 0.012, 0.022), head, "handle", 0.005)
        else:
            kit.lathe(
                [(0.006, -0.008), (0.011, -0.004), (0.012, 0.006), (0.009, 0.012)],
                head,
                "handle",
                20,
            )


def engine_masters(kit):
    plane = pedestal_plane(1, 0.80)
    kit.panel((0.350, 0.078), plane, "panel", 0.003, 0.005)
    face = shifted(plane, z=0.003)
    kit.screws(face, (0.350, 0.078), 0.0065, 0.0026)
    for x, label in ((-0.035, "ENG 1"), (0.035, "ENG 2")):
        at = shifted(face, x, -0.006)
        kit.panel((0.024, 0.036), at, "panel dark", 0.002, 0.003)
        kit.toggle(shifted(at, 0, 0.004, 0.002), -20)
        kit.text(label, shifted(face, x, 0.022), 0.0044)
        kit.text("ON", shifted(face, x + 0.0175, 0.006), 0.0034)
        kit.text("OFF", shifted(face, x + 0.0180, -0.016), 0.0034)
    kit.knob(shifted(face, 0, -0.026), 0.0088, 0.014)
    for side, title in ((-1, "RUD TRIM"), (1, "PARK BRK")):
        at = shifted(face, side * 0.115, -0.006)
        kit.knob(at, 0.0155, 0.022, "knob" if side < 0 else "knob grey")
        kit.text(title, shifted(at, 0, 0.030), 0.0042)


def radio(kit, plane, x, y, title, frequencies):
    at = shifted(plane, x, y)
    w, h = 0.168, 0.076
    kit.panel((w, h), at, "panel", 0.004, 0.004)
    face = shifted(at, z=0.004)
    kit.screws(face, (w, h), 0.006, 0.0026)
    kit.text(title, shifted(face, 0, 0.031), 0.0040)
    for side, text in zip((-1, 1), frequencies):
        window = shifted(face, side * 0.047, 0.017)
        kit.panel((0.052, 0.018), window, "window black", 0.0012, 0.002, 0.0004)
        kit.text(text, shifted(window, z=0.0014), 0.0085, "lit amber")
    for k in range(5):
        key = shifted(face, -0.060 + 0.0215 * k, -0.010)
        kit.button(key, (0.0165, 0.0095), "key", 0.003)
        kit.text(("VHF1", "VHF2", "VHF3", "HF", "AM")[k], shifted(key, z=0.0032), 0.0030)
        kit.line(
            [(-0.004, 0), (0.004, 0)],
            shifted(face, -0.060 + 0.0215 * k, -0.0185),
            0.001,
            "lit green" if k == 0 else "legend dim",
        )
    kit.concentric(shifted(face, 0.058, -0.012), 0.013)


def radios(kit):
    plane = pedestal_plane(2)
    pages = (("118.700", "121.500"), ("127.350", "135.125"), ("113.10", "110.30"))
    for row in range(5):
        for side in (-1, 1):
            radio(
                kit,
                plane,
                side * 0.090,
                0.176 - 0.084 * row,
                ("VHF / HF", "AUDIO", "NAV", "ATC / TCAS", "WX RADAR")[row],
                pages[(row + (side > 0)) % 3],
            )


def build_pedestal():
    kit = Kit("pedestal")
    body(kit)
    cdu(kit, -0.0905, "cdu left")
    cdu(kit, 0.0905, "cdu right")
    quadrant(kit)
    for side in (-1, 1):
        trim_wheel(kit, side * 0.0905)
    side_levers(kit)
    engine_masters(kit)
    radios(kit)
    kit.build()
