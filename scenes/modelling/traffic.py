# SPDX-License-Identifier: Apache-2.0
"""The other cars of the street: shells with wheel arches, glass between pillars, lamps, plates.

A car is modelled about its own origin on the road, driving towards +y, and placed as copies.
"""
import math

import bpy
import numpy as np
from mathutils import Matrix

from shapes import (
    box,
    frame_matrix,
    grid,
    joined,
    lathe,
    tube,
)

WHEEL_R, ARCH_R, TRACK = 0.325, 0.385, 0.775
AXLES = (-1.36, 1.34)
STRAIGHT = (-1.88, 1.86)  # where the sides end and the rounded ends begin

# Of each kind: the half width; (z, y) of the rear and of the front end; (y, z) of the belt; and
# of the cabin (t from belt to roof 0..1): the height of its foot and roof, (y rear, y front) at
# the foot and at the roof, the half widths there, and where side glass ends behind (0..1).
KINDS = {
    "saloon": dict(
        half=0.905,
        rear=((0.20, -2.08), (0.34, -2.20), (0.46, -2.235), (0.60, -2.235), (0.66, -2.195),
              (0.80, -2.195), (0.95, -2.175), (1.02, -2.10)),
        front=((0.20, 2.10), (0.34, 2.21), (0.50, 2.24), (0.62, 2.21), (0.74, 2.08),
               (0.90, 1.95)),
        belt=((-2.2, 0.965), (-1.6, 0.985), (-0.4, 0.945), (0.9, 0.925), (1.3, 0.90),
              (1.9, 0.80), (2.25, 0.70)),
        cabin=dict(foot=0.90, roof=1.395, ends=((-1.66, 1.16), (-0.98, 0.22)),
                   half=(0.775, 0.585), quarter=-0.70),
    ),
    "hatchback": dict(
        half=0.885,
        rear=((0.20, -1.98), (0.34, -2.06), (0.48, -2.09), (0.62, -2.085), (0.70, -2.045),
              (0.95, -2.02), (1.02, -1.98)),
        front=((0.20, 2.00), (0.34, 2.11), (0.50, 2.14), (0.64, 2.11), (0.76, 2.00),
               (0.92, 1.92)),
        belt=((-2.1, 0.985), (-1.2, 0.97), (0.9, 0.935), (1.3, 0.93), (1.9, 0.84),
              (2.15, 0.75)),
        cabin=dict(foot=0.90, roof=1.425, ends=((-2.00, 1.20), (-1.58, 0.30)),
                   half=(0.775, 0.60), quarter=-0.76),
    ),
    "estate": dict(
        half=0.915,
        rear=((0.20, -2.14), (0.36, -2.24), (0.50, -2.27), (0.64, -2.265), (0.72, -2.225),
              (0.95, -2.20), (1.02, -2.17)),
        front=((0.20, 2.10), (0.36, 2.20), (0.56, 2.24), (0.70, 2.21), (0.84, 2.10),
               (0.98, 1.98)),
        belt=((-2.2, 1.04), (-1.2, 1.02), (0.9, 0.985), (1.3, 0.97), (1.9, 0.89),
              (2.25, 0.80)),
        cabin=dict(foot=0.94, roof=1.545, ends=((-2.17, 1.12), (-1.80, 0.24)),
                   half=(0.80, 0.645), quarter=-0.80),
    ),
}


def ellipse(angle, sharp):
    """A superellipse's (cos, sin): boxier for larger `sharp`."""
    c, s = math.cos(angle), math.sin(angle)
    return (
        math.copysign(abs(c) ** (2 / sharp), c),
        math.copysign(abs(s) ** (2 / sharp), s),
    )


def curve(pairs, at):
    return float(np.interp(at, *zip(*pairs)))


def low_edge(y):
    """The sill, or the arch over a wheel."""
    z = 0.205
    for axle in AXLES:
        if abs(y - axle) < ARCH_R:
            z = max(z, WHEEL_R + math.sqrt(ARCH_R**2 - (y - axle) ** 2) - 0.02)
    return z


def half_width(kind, y, z):
    """Of the straight sides: fullest below the shoulder, drawn in at sill and belt."""
    t = curve(((0.2, 0.965), (0.36, 0.985), (0.58, 1.0), (0.80, 0.993), (1.0, 0.945)), z)
    return kind["half"] * t * (1 - 0.012 * (y / 1.9) ** 4)


def outline():
    """(end, value) around the car, from behind on the right: 0: y of a side, right 0 or left
    2; 1 and 3: angle on the front's and the rear's round end."""
    ys = [STRAIGHT[0], STRAIGHT[1], -0.3, 0.3]
    for axle in AXLES:
        ys += list(axle + ARCH_R * np.sin(np.linspace(-1, 1, 15) * math.pi / 2))
        ys += [axle - ARCH_R - 0.006, axle + ARCH_R + 0.006]
    ys = sorted(set(ys))
    turn = np.linspace(0, math.pi, 25)[1:-1]
    return (
        [(0, y) for y in ys]
        + [(1, a) for a in turn]
        + [(2, y) for y in ys[::-1]]
        + [(3, a) for a in math.pi + turn]
    )


def shell_point(kind, place, z, out=0.0):
    """A point of the shell at a place of the outline; `out` metres outside of it."""
    end, value = place
    if end in (0, 2):
        side = 1 if end == 0 else -1
        return (side * (half_width(kind, value, z) + out), value, z)
    c, s = ellipse(value, 3.2)
    foot = STRAIGHT[1] if end == 1 else STRAIGHT[0]
    tip = curve(kind["front" if end == 1 else "rear"], z)
    return (
        c * (half_width(kind, foot, z) + out),
        foot + abs(s) * (tip - foot + math.copysign(out, tip)),
        z,
    )


def plan_y(kind, place, z):
    return shell_point(kind, place, z)[1]


def shell(name, kind, paint):
    """Skirt, sides and the shoulder's turn; then bonnet and boot between the shoulders."""
    places = outline()
    rows = []
    steps = (0.0, 0.14, 0.30, 0.45, 0.60, 0.75, 0.88, 1.0)
    for t in steps:
        row = []
        for place in places:
            near = plan_y(kind, place, 0.6)
            low = low_edge(near) if place[0] in (0, 2) else 0.215
            high = curve(kind["belt"], near)
            row.append(shell_point(kind, place, low + t * (high - low)))
        rows.append(row)
    top = np.array(rows[-1])
    for inset, lift in ((0.965, 0.016), (0.90, 0.024)):
        rows.append(top * (inset, 1 - 0.25 * (1 - inset), 1) + (0, 0, lift))
    rows = np.array(rows)
    grid(f"{name} skirt", rows[:2], "plastic dark", closed=True)
    grid(f"{name} body", rows[1:], paint, closed=True)
    tips = [plan_y(kind, (end, math.pi * (end - 0.5)), curve(kind["belt"], 2.2 * (2 - end)))
            for end in (3, 1)]
    deck = []
    for y in np.linspace(0.975 * tips[0], 0.975 * tips[1], 26):
        foot, tip = (STRAIGHT[0], tips[0]) if y < 0 else (STRAIGHT[1], tips[1])
        beyond = min(max((y - foot) / (tip - foot), 0.0), 1.0)
        wide = 0.905 * kind["half"] * (1 - beyond**3.2) ** (1 / 3.2)
        z = curve(kind["belt"], y) + 0.022
        deck.append(
            [(wide * u, y, z + 0.035 * (1 - u * u) - 0.002) for u in np.linspace(-1, 1, 9)]
        )
    for end, at in ((3, 0), (1, len(deck))):  # rounded lips down onto the ends
        y = plan_y(kind, (end, math.pi * (end - 0.5)), 0.6)
        z, edge = curve(kind["belt"], y) - 0.012, np.array(deck[0 if end == 3 else -1])
        lip = edge * (1.22, 1, 0) + (0, 0.985 * tips[0 if end == 3 else 1] - edge[0][1], z)
        half_way = 0.5 * (lip + edge) + (0, 0.35 * (lip - edge)[0][1], 0.02)
        rows_of_lip = [lip, half_way] if end == 3 else [half_way, lip]
        deck[at:at] = rows_of_lip if end == 3 else []
        deck += [] if end == 3 else rows_of_lip
    grid(f"{name} deck", np.array(deck), paint)


def on_shell(name, kind, places, heights, lift, material):
    """A part that lies on the shell: its rim touches it, its middle stands `lift` proud."""
    rows = []
    for i, z in enumerate(heights):
        row = []
        for j, place in enumerate(places):
            rim = i in (0, len(heights) - 1) or j in (0, len(places) - 1)
            row.append(shell_point(kind, place, z, -0.004 if rim else lift))
        rows.append(row)
    return grid(name, np.array(rows), material)


def cabin_point(kind, angle, t, out=0.0):
    """Of the cabin above the belt; angle 90 degrees looks ahead."""
    cabin = kind["cabin"]
    bow = t + 0.16 * t * (1 - t)  # sides and pillars bulge
    rear, front = (
        (1 - bow) * a + bow * b for a, b in zip(*cabin["ends"])
    )
    wide = (1 - bow) * cabin["half"][0] + bow * cabin["half"][1]
    c, s = ellipse(angle, 4.6)
    y = 0.5 * (front + rear) + s * (0.5 * (front - rear) + out)
    return (c * (wide + out), y, cabin["foot"] + t * (cabin["roof"] - cabin["foot"]))


def cabin_shell(name, kind, paint):
    angles = np.linspace(0, 2 * math.pi, 64, endpoint=False)
    rings = [[cabin_point(kind, a, t) for a in angles] for t in np.linspace(0, 1, 7)]
    top = np.array(rings[-1])
    middle = top.mean(0)
    for k, lift in ((0.95, 0.022), (0.84, 0.040), (0.5, 0.056), (0.02, 0.062)):
        rings.append(middle + (top - middle) * (k, k, 1) + (0, 0, lift))
    grid(f"{name} cabin", np.array(rings), paint, closed=True)


def angle_of(share, axis):
    """The angle at which a cabin's y (axis 1) or x (axis 0) is that share of its half."""
    wanted = math.copysign(abs(share) ** (4.6 / 2), share)
    return math.asin(wanted) if axis else math.acos(wanted)


def pane(name, kind, angles, ts, material="dark glass", out=0.006):
    rows = [[cabin_point(kind, a, t, out) for a in angles] for t in ts]
    return grid(name, np.array(rows), material)


def glass(name, kind):
    """Windscreen, rear screen and side windows, each in a black seal; pillars stay between."""
    quarter = kind["cabin"]["quarter"]
    left, right = angle_of(-0.83, 0), angle_of(0.83, 0)
    ends = np.linspace(right, left, 13)
    ts = np.linspace(0.16, 0.93, 6)
    seals, panes = [], []
    wide = np.linspace(right - 0.05, left + 0.05, 13)
    for turn in (0, math.pi):
        seals.append(pane("seal", kind, wide + turn, np.linspace(0.12, 0.96, 6), "frit", 0.003))
        panes.append(pane("pane", kind, ends + turn, ts))
    behind, ahead = angle_of(quarter, 1), angle_of(0.80, 1)
    for mirrored in (False, True):
        whole = np.linspace(behind, ahead, 17)
        if mirrored:
            whole = math.pi - whole
        seals.append(pane("seal", kind, whole, np.linspace(0.13, 0.93, 6), "frit", 0.003))
        for a, b in ((quarter + 0.03, -0.34), (-0.30, 0.10), (0.16, 0.77)):
            some = np.linspace(angle_of(a, 1), angle_of(b, 1), 6)
            some = math.pi - some if mirrored else some
            panes.append(pane("pane", kind, some, np.linspace(0.17, 0.89, 6)))
    joined(f"{name} seals", seals)
    joined(f"{name} windows", panes)


def arc(first, last, count, end):
    """Places on a round end between two angles in degrees; 0 is the car's right."""
    return [(end, math.radians(a)) for a in np.linspace(first, last, count)]


def rear_details(name, kind, paint):
    """Tail lamps that wrap around the corners, plate, reflectors, seams, exhausts."""
    tip = curve(kind["rear"], 0.80)
    lamps = [
        on_shell("lamp", kind, arc(a, b, 8, 3), np.linspace(0.715, 0.885, 5), 0.035,
                 "tail lamp")
        for a, b in ((186, 238), (302, 354))
    ]
    top = [cabin_point(kind, a, 0.965, 0.012) for a in np.linspace(4.60, 4.82, 5)]
    lamps.append(tube("lamp", top, 0.012, "tail lamp", 6))
    reflector = np.linspace(0.385, 0.42, 3)
    lamps += [
        on_shell("lamp", kind, arc(a, b, 4, 3), reflector, 0.006, "tail lamp")
        for a, b in ((222, 238), (302, 318))
    ]
    joined(f"{name} tail lamps", lamps)
    back = frame_matrix((0, curve(kind["rear"], 0.54) - 0.006, 0.535), (1, 0, 0), (0, 0, 1))
    box(f"{name} number plate", (0.52, 0.115, 0.012), back, "road marking", 0.002)
    letters = [
        box("letter", (0.034 if k != 2 else 0.012, 0.066, 0.004),
            back @ Matrix.Translation((-0.20 + 0.064 * k, 0, 0.007)), "gap", 0)
        for k in range(7)
    ]
    letters += [
        on_shell("seam", kind, arc(224, 316, 9, 3), (0.668, 0.674, 0.680), 0.001, "gap"),
        box("slot", (0.60, 0.16, 0.01),
            frame_matrix((0, curve(kind["rear"], 0.54) - 0.002, 0.545), (1, 0, 0), (0, 0, 1)),
            "gap", 0),
    ]
    joined(f"{name} seams", letters)
    badge = frame_matrix((0, tip - 0.004, 0.90), (1, 0, 0), (0, 0, 1))
    bright = [lathe("badge", [(0.038, -0.004), (0.036, 0.006), (0.002, 0.010)], badge,
                    "bright chrome", 16)]
    for side in (-1, 1):
        pipe = frame_matrix((0.50 * side, curve(kind["rear"], 0.28) - 0.004, 0.275), (1, 0, 0),
                            (0, 0, 1))
        bright.append(box("pipe", (0.17, 0.05, 0.03), pipe, "bright chrome", 0.012))
    joined(f"{name} bright parts", bright)
    apron = arc(212, 328, 13, 3)
    on_shell(f"{name} apron", kind, apron, np.linspace(0.212, 0.345, 4), 0.008, "plastic dark")


def front_details(name, kind):
    """Head lamps, grille, air intake, plate."""
    lamps = [
        on_shell("lamp", kind, arc(a, b, 7, 1), np.linspace(0.60, 0.715, 4), 0.010,
                 "bright chrome")
        for a, b in ((10, 48), (132, 170))
    ]
    joined(f"{name} head lamps", lamps)
    dark = [
        on_shell("grille", kind, arc(54, 126, 9, 1), np.linspace(0.50, 0.66, 3), 0.004, "gap"),
        on_shell("intake", kind, arc(38, 142, 9, 1), np.linspace(0.25, 0.37, 3), 0.004, "gap"),
    ]
    joined(f"{name} grilles", dark)
    at = frame_matrix((0, curve(kind["front"], 0.44) + 0.012, 0.435), (-1, 0, 0), (0, 0, 1))
    box(f"{name} front plate", (0.52, 0.115, 0.012), at, "road marking", 0.002)


def side_details(name, kind, paint):
    """Mirrors on their feet, door seams and handles, liners behind the wheels."""
    seams, mirrors, dark = [], [], []
    for side, end in ((1, 0), (-1, 2)):
        for y in (-0.98, -0.10, 0.98):
            strip = [(end, y - 0.004), (end, y), (end, y + 0.004)][::side]
            seams.append(
                on_shell("seam", kind, strip, np.linspace(0.30, curve(kind["belt"], y), 6),
                         0.0015, "gap")
            )
        for y in (-0.80, 0.08):
            handle = [(end, y + d) for d in np.linspace(0, 0.19, 4)][::side]
            mirrors.append(on_shell("handle", kind, handle, (0.80, 0.81, 0.825, 0.835), 0.022,
                                    paint))
        belt = curve(kind["belt"], 0.80)
        at = frame_matrix((side * (kind["half"] + 0.07), 0.80, belt + 0.085), (1, 0, 0),
                          (0, 1, 0))
        mirrors.append(box("mirror", (0.20, 0.12, 0.13), at, paint, 0.035, 3))
        foot = frame_matrix((side * (kind["half"] - 0.06), 0.82, belt + 0.03), (1, 0, 0),
                            (0, 1, 0))
        dark.append(box("foot", (0.16, 0.07, 0.05), foot, "plastic dark", 0.01))
        for axle in AXLES:
            turn = np.linspace(-0.35, math.pi + 0.35, 13)
            liner = [
                [(side * x, axle + ARCH_R * math.cos(a),
                  WHEEL_R - 0.02 + ARCH_R * math.sin(a)) for a in turn]
                for x in (kind["half"] * 0.965, 0.52)
            ]
            dark.append(grid("liner", np.array(liner), "gap"))
    for y0, y1 in ((-2.0, -1.75), (-0.97, 0.95), (1.73, 2.0)):
        under = frame_matrix((0, 0.5 * (y0 + y1), 0.30), (1, 0, 0), (0, 1, 0))
        dark.append(box("floor", (1.60, y1 - y0, 0.17), under, "gap", 0))
    middle = frame_matrix((0, 0, 0.34), (1, 0, 0), (0, 1, 0))
    dark.append(box("floor", (1.04, 3.9, 0.20), middle, "gap", 0))
    joined(f"{name} seams of doors", seams)
    joined(f"{name} mirrors", mirrors)
    joined(f"{name} underside", dark)


def wheel(name):
    """A tyre and a rim of five double spokes, facing +x of its own frame."""
    at = frame_matrix((0, 0, 0), (0, 1, 0), (0, 0, 1))
    r = WHEEL_R
    profile = [(0.215, -0.10), (0.29, -0.105), (r - 0.004, -0.085), (r, -0.06), (r, 0.06),
               (r - 0.004, 0.085), (0.29, 0.105), (0.222, 0.10), (0.215, 0.085)]
    lathe(f"{name} tyre", profile, at, "rubber", 30)
    rim = [lathe("rim", [(0.218, 0.0), (0.218, 0.098), (0.205, 0.09), (0.198, 0.03)], at,
                 "galvanised steel", 30)]
    for k in range(5):
        for d in (-0.16, 0.16):
            a = 2 * math.pi * k / 5 + d
            spoke = at @ Matrix.Rotation(a, 4, "Z") @ Matrix.Translation((0.12, 0, 0.066))
            rim.append(box("spoke", (0.17, 0.028, 0.03), spoke, "galvanised steel", 0))
    rim.append(lathe("hub", [(0.062, 0.04), (0.058, 0.088), (0.002, 0.09)], at,
                     "galvanised steel", 14))
    joined(f"{name} rim", rim)
    lathe(f"{name} well", [(0.21, 0.028), (0.002, 0.03)], at, "gap", 20)


def model(label, kind_name, paint):
    """Everything of one car about the origin; the new objects."""
    before = set(bpy.context.scene.objects)
    kind = KINDS[kind_name]
    shell(label, kind, paint)
    cabin_shell(label, kind, paint)
    glass(label, kind)
    rear_details(label, kind, paint)
    front_details(label, kind)
    side_details(label, kind, paint)
    return [o for o in bpy.context.scene.objects if o not in before]


def copies(parts, name, drop, at):
    """Copies of parts at a place; `drop` leads the parts' names and is replaced by `name`."""
    for part in parts:
        copy = bpy.data.objects.new(part.name.replace(drop, name, 1), part.data)
        copy.matrix_world = at @ part.matrix_world
        bpy.context.scene.collection.objects.link(copy)


def traffic(cars):
    """cars: (name, kind, paint, x, y, heading in degrees, 0 drives away from us)."""
    before = set(bpy.context.scene.objects)
    wheel("wheel")
    wheels = [o for o in bpy.context.scene.objects if o not in before]
    originals = {}
    for name, kind, paint, x, y, heading in cars:
        key = f"{kind} {paint}"
        if key not in originals:
            originals[key] = model(key, kind, paint)
        at = Matrix.Translation((x, y, 0)) @ Matrix.Rotation(math.radians(heading), 4, "Z")
        copies(originals[key], name, key, at)
        for i, (side, axle) in enumerate((s, a) for s in (-1, 1) for a in AXLES):
            turn = Matrix.Rotation(0.0 if side > 0 else math.pi, 4, "Z")
            hub = at @ Matrix.Translation((side * TRACK, axle, WHEEL_R)) @ turn
            copies(wheels, f"{name} {i}", "wheel", hub)
    for part in wheels + [o for parts in originals.values() for o in parts]:
        bpy.data.objects.remove(part)
