# SPDX-License-Identifier: Apache-2.0
"""The glareshield: coaming with its stitched edge, mode control panel, warning lights."""
import numpy as np

from deck_layout import FACE, FACE_FOOT, FACE_HALF, PANEL_TOP
from deck_panel import display_quad
from deck_shell import windscreen_foot
from kit import Kit, shifted
from shapes import box, frame_matrix, grid, spline, stitches, tube

COAMING_HALF = 0.820
# (y, z) from under the lip, over its roll, to the windscreen; y of the last is the glass.
LIP = [
    (0.652, 1.003),
    (0.622, 1.002),
    (0.604, 1.004),
    (0.595, 1.013),
    (0.601, 1.024),
    (0.624, 1.029),
    (0.680, 1.029),
]


def ends(x):
    """The coaming turns down and forward towards the side walls."""
    return max(abs(x) - 0.660, 0.0) / (COAMING_HALF - 0.660)


def section(x, count=22):
    e = ends(x)
    lip = spline(LIP, count)
    lip[:, 0] += 0.100 * e**2
    lip[:, 1] -= 0.028 * e**2
    foot = windscreen_foot(x)
    back = [
        (
            lip[-1, 0] + t * (foot[0] - lip[-1, 0]),
            lip[-1, 1] + t**1.4 * (foot[1] - lip[-1, 1]),
        )
        for t in np.linspace(0, 1, 9)[1:]
    ]
    curve = np.vstack([lip, back])
    return np.column_stack([np.full(len(curve), x), curve])


def coaming():
    xs = np.linspace(-COAMING_HALF, COAMING_HALF, 81)
    rows = np.array([section(x) for x in xs])
    grid("coaming", rows, "coaming", flip=True)
    for label, index in (("lip", 14), ("rear", 19)):
        path, normals = rows[:, index], np.tile((0.0, -0.35, 1.0), (len(xs), 1))
        dense, up = spline(path, 500), spline(normals, 500)
        stitches(
            f"coaming seam {label}",
            dense + 0.0004 * up,
            up,
            "coaming thread",
            0.0055,
            0.0082,
            0.0013,
        )
    fold = 0.5 * (rows[:, 16] + rows[:, 17])
    tube("coaming fold", fold + (0, 0, 0.0003), 0.0012, "gap", 6)


def underside(kit):
    """From the face's foot back to the panel, and the body behind the face."""
    depth = PANEL_TOP[0] + 0.02 - FACE_FOOT[0]
    middle = FACE_FOOT[0] + 0.5 * depth + 0.004
    at = frame_matrix((0, middle, 0.969), (1, 0, 0), (0, 1, 0))
    box("coaming body", (2 * FACE_HALF + 0.13, depth, 0.058), at, "armrest", 0.018, 4)
    for side in (-1, 1):
        flood = frame_matrix((side * 0.42, FACE_FOOT[0] + 0.060, 0.9385), (1, 0, 0), (0, -1, 0))
        kit.box((0.36, 0.016, 0.006), flood, "bezel", 0.002)


def window(name, at, size, uv, kit):
    """A small sunken window with digits."""
    w, h = size
    kit.ring(
        [(-w / 2, -h / 2), (w / 2, -h / 2), (w / 2, h / 2), (-w / 2, h / 2)],
        [(0.0, 0.0003), (0.0026, 0.0003), (0.0026, 0.0016), (0.0004, 0.0016)],
        at,
        "bezel",
    )
    display_quad(f"window {name}", size, shifted(at, z=0.0006), uv, "windows")


WINDOW_ROWS = ("spd", "hdg", "alt", "vs", "baro left", "baro right")


def picture_part(name):
    """Where a window's digits lie in windows.png: six parts, one above the other."""
    i = WINDOW_ROWS.index(name)
    return (0.0, i / 6, 1.0, (i + 1) / 6)


def selector(kit, face, x, name, label, size=(0.052, 0.0195)):
    at = shifted(face, x, 0.0165)
    window(name, at, size, picture_part(name), kit)
    kit.text(label, shifted(face, x, 0.0292), 0.0030)
    kit.knob(shifted(face, x, -0.0125), 0.0095, 0.020, pointer=name != "vs")
    for k in (-1, 1):
        kit.line([(k * 0.0135, -0.0125), (k * 0.0165, -0.0125)], shifted(face, x), 0.0008)


def lit_button(kit, face, x, y, label, lit=None, size=(0.0150, 0.0150)):
    at = shifted(face, x, y)
    kit.button(at, size, "key", 0.0048)
    top = shifted(at, z=0.0050)
    kit.text(label, shifted(top, 0, 0.0026), min(0.0036, 0.9 * size[0] / max(len(label), 1)))
    for k in range(3):
        y0 = -0.0022 - 0.0014 * k
        kit.line([(-0.0042, y0), (0.0042, y0)], top, 0.0008, lit or "legend dim")


def control_unit(kit):
    """Speed, heading, altitude and vertical speed, with the autopilot's buttons between."""
    face = shifted(FACE, z=0.0062)
    kit.panel((0.452, 0.066), shifted(FACE, z=0.002), "panel", 0.0042, 0.004, 0.0008)
    kit.screws(face, (0.452, 0.066), 0.0065, 0.0026)
    selector(kit, face, -0.178, "spd", "SPD  MACH")
    selector(kit, face, -0.095, "hdg", "HDG  TRK")
    selector(kit, face, 0.088, "alt", "ALT", (0.056, 0.0195))
    selector(kit, face, 0.176, "vs", "V/S  FPA")
    for i, (label, lit) in enumerate((("AP1", "lit green"), ("AP2", None))):
        lit_button(kit, face, -0.0165 + 0.0205 * i, 0.013, label, lit)
    for i, (label, lit) in enumerate((("LOC", None), ("A/THR", "lit green"), ("APPR", None))):
        lit_button(kit, face, -0.0270 + 0.0205 * i, -0.013, label, lit)
    for x, label, lit in (
        (-0.1365, "SPD", None),
        (-0.0540, "LNAV", "lit green"),
        (0.1320, "VNAV", "lit green"),
    ):
        lit_button(kit, face, x, -0.013, label, lit, (0.0165, 0.0145))
    lit_button(kit, face, 0.0420, 0.010, "METRIC", None, (0.0165, 0.0135))


def efis_unit(kit, side):
    """Barometer setting and what the navigation display shows."""
    centre = side * 0.3325
    face = shifted(FACE, centre, 0, 0.0062)
    kit.panel((0.204, 0.066), shifted(FACE, centre, 0, 0.002), "panel", 0.0042, 0.004, 0.0008)
    kit.screws(face, (0.204, 0.066), 0.0065, 0.0026)
    outer = side
    x = 0.066 * outer
    name = "baro left" if side < 0 else "baro right"
    window(name, shifted(face, x, 0.0165), (0.046, 0.0190), picture_part(name), kit)
    kit.text("QNH", shifted(face, x, 0.0292), 0.0030)
    kit.concentric(shifted(face, x, -0.0120), 0.0105)
    kit.text("IN HG", shifted(face, x - 0.0185, -0.024), 0.0024)
    kit.text("HPA", shifted(face, x + 0.0185, -0.024), 0.0024)
    for i, label in enumerate(("CSTR", "WPT", "VOR", "NDB", "ARPT")):
        lit_button(
            kit,
            face,
            (0.028 - 0.0205 * i) * outer - 0.006 * outer,
            0.0185,
            label,
            "lit green" if i == 0 else None,
            (0.0155, 0.0115),
        )
    for i, (label, marks) in enumerate((("ROSE  ARC  PLAN", 5), ("10  40  160  320", 6))):
        at = shifted(face, (0.008 - 0.050 * i) * outer, -0.0120)
        kit.knob(shifted(at, turn_deg=35 - 60 * i), 0.0090, 0.017)
        kit.text(label, shifted(at, 0, 0.0150), 0.0024)
        for k in range(marks):
            angle = np.radians(150 - 120 * k / (marks - 1) * 1.0)
            a, b = 0.0118, 0.0138
            kit.line(
                [
                    (a * np.cos(angle), a * np.sin(angle)),
                    (b * np.cos(angle), b * np.sin(angle)),
                ],
                at,
                0.0008,
            )


def warning_unit(kit, side):
    """In front of each pilot: master warning and caution, and side stick priority."""
    centre = side * 0.5635
    face = shifted(FACE, centre, 0, 0.0062)
    kit.panel((0.250, 0.066), shifted(FACE, centre, 0, 0.002), "panel", 0.0042, 0.004, 0.0008)
    kit.screws(face, (0.250, 0.066), 0.0065, 0.0026)
    for x, word, color in ((0.030, "WARN", "guard red"), (-0.006, "CAUT", "lit amber")):
        at = shifted(face, -side * (x + 0.055), 0.002)
        kit.panel((0.0300, 0.0250), at, "gap", 0.0005, 0.002, 0.0002)
        kit.panel((0.0270, 0.0220), at, "window black", 0.0052, 0.0022)
        top = shifted(at, z=0.0054)
        dark = "legend dim"
        kit.text("MASTER", shifted(top, 0, 0.0040), 0.0036, dark)
        kit.text(word, shifted(top, 0, -0.0038), 0.0042, dark)
    for k, label in enumerate(("CHRONO", "AUTO LAND", "SIDE STICK")):
        at = shifted(face, side * (0.020 + 0.038 * k), 0.002)
        kit.button(at, (0.0200, 0.0180), "key", 0.0045)
        kit.text(label, shifted(at, 0, 0.0150), 0.0026)
        kit.text("ARM" if k else "RST", shifted(at, 0, 0, 0.0047), 0.0032, "legend dim")
    for x in (-0.105, -0.012):
        at = shifted(face, -side * x * 0.9, -0.021)
        kit.text("ATC MSG" if x < -0.05 else "PUSH", at, 0.0024, "legend dim")


def build_glareshield():
    kit = Kit("glareshield")
    underside(kit)
    kit.box(
        (2 * FACE_HALF + 0.012, 0.0665, 0.006), shifted(FACE, z=-0.001), "panel dark", 0.002
    )
    control_unit(kit)
    for side in (-1, 1):
        efis_unit(kit, side)
        warning_unit(kit, side)
    kit.build()
    coaming()
