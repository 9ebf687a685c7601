# SPDX-License-Identifier: Apache-2.0
"""The dashboard: pad, trim, instrument cluster, centre display, vents, climate, glovebox."""
import math

import numpy as np
from mathutils import Matrix, Vector

from legends import printed
from shapes import (
    box,
    cut,
    frame_matrix,
    frame_ring,
    grid,
    joined,
    lathe,
    mesh,
    place,
    plate,
    round_section,
    rounded_rectangle,
    spline,
    stitches,
    tube,
)

HALF_WIDTH = 0.755  # m, where the dashboard meets the doors
DRIVER_X = -0.37  # m, the wheel, the cluster and the driver's eye
CENTRE_X = 0.0  # m, the middle of the centre display

# (y, z) sections at the car's centre line, from the windscreen to the knees.
PAD = [
    (1.36, 1.000),
    (1.20, 1.018),
    (1.02, 1.040),
    (0.88, 1.057),
    (0.800, 1.063),
    (0.758, 1.053),
    (0.740, 1.030),
    (0.739, 1.008),
    (0.748, 0.992),
]
BAND = [(0.752, 0.988), (0.746, 0.972), (0.744, 0.950), (0.747, 0.930), (0.752, 0.922)]
KNEES = [
    (0.756, 0.916),
    (0.734, 0.904),
    (0.724, 0.880),
    (0.728, 0.840),
    (0.752, 0.760),
    (0.800, 0.690),
    (0.880, 0.640),
]


def wrap(x):
    """How far the dashboard comes towards the people at x: it turns into the doors."""
    return -0.105 * (abs(x) / HALF_WIDTH) ** 3.2


def glass_foot(x):
    """y of the windscreen's lower edge at x; the pad ends there."""
    return 1.340 - 0.230 * (x / 0.735) ** 2


def cluster_recess(x):
    """The pad steps back (least y) to leave room for the cluster inside its binnacle."""
    edge = min(max((0.185 - abs(x - DRIVER_X)) / 0.035, 0.0), 1.0)
    return 0.600 + 0.180 * edge * edge * (3 - 2 * edge)


def section(profile, x, count, recess=False):
    curve = spline(profile, count)
    out = np.empty((count, 3))
    out[:, 0] = x
    out[:, 1] = np.minimum(curve[:, 0] + wrap(x), glass_foot(x) - 0.004)
    if recess:
        out[:, 1] = np.maximum(out[:, 1], cluster_recess(x))
    out[:, 2] = curve[:, 1]
    return out


def sweep(name, profile, x_range, material, count=24, step=0.025, recess=False):
    """A profile carried along x and around the wrap; fronts look up and to the people."""
    xs = np.linspace(*x_range, max(2, int(abs(x_range[1] - x_range[0]) / step) + 1))
    rows = [section(profile, x, count, recess) for x in xs]
    return grid(name, np.array(rows), material)


def along(profile_point, x_range, count, lift=0.0):
    """A line across the dashboard at one (y, z) of the section."""
    xs = np.linspace(*x_range, count)
    return np.column_stack(
        [
            xs,
            profile_point[0] + np.array([wrap(x) for x in xs]),
            np.full(count, profile_point[1] + lift),
        ]
    )


# The head-up display's opening: columns (x) and points of the profile (y) of the pad's mesh.
PAD_POINTS, PAD_STEP = 40, 0.02
WELL_COLUMNS, WELL_POINTS = (15, 25), (6, 9)
WELL_BOX = ((-0.480, -0.225), (0.860, 1.158), 0.870)  # x, y and floor of the dark box below


def pad():
    span = (-HALF_WIDTH, HALF_WIDTH)
    item = sweep("dashboard pad", PAD, span, "leather black", PAD_POINTS, PAD_STEP, True)
    faces = [
        i * (PAD_POINTS - 1) + j for i in range(*WELL_COLUMNS) for j in range(*WELL_POINTS)
    ]
    cut(item, faces)
    well()
    curve = spline(PAD, 400)
    for label, target in (("rear", 0.776), ("front", 0.764)):
        k = np.argmin(abs(curve[:, 0] - target) + 10 * (curve[:, 1] < 1.04))
        tangent = curve[k + 1] - curve[k - 1]
        normal = np.array([0, tangent[1], -tangent[0]])
        normal = normal if normal[2] > 0 else -normal
        for span, part in (((-0.742, -0.60), "left"), ((-0.14, 0.742), "right")):
            path = along(curve[k], span, 160)
            stitches(
                f"dashboard seam {label} {part}", path, np.tile(normal, (160, 1)), "thread"
            )
    k = np.argmin(abs(curve[:, 0] - 0.770) + 10 * (curve[:, 1] < 1.04))
    tube("dashboard seam fold", along(curve[k], (-0.745, 0.745), 120, 0.0002), 0.0011, "gap", 6)
    airbag_seam()
    defroster()
    pad_speaker()


def well():
    """A dark box for the optics of model_hud.py, and a frame round its opening."""
    (x0, x1), (y0, y1), floor = WELL_BOX
    around = [(x0, y0), (x1, y0), (x1, y1), (x0, y1)]
    line = [
        (a[0] + (b[0] - a[0]) * t, a[1] + (b[1] - a[1]) * t)
        for a, b in zip(around, around[1:] + around[:1])
        for t in np.linspace(0, 1, 7)[:-1]
    ]
    top = [(x, y, pad_height(x, y) - 0.0015) for x, y in line]
    walls = grid("head-up well", [[(x, y, floor) for x, y in line], top], "gap", closed=True)
    bottom = mesh("floor", [(x, y, floor) for x, y in around], [(0, 1, 2, 3)], "gap")
    joined("head-up well", [walls, bottom])
    xs = np.linspace(-HALF_WIDTH, HALF_WIDTH, int(2 * HALF_WIDTH / PAD_STEP) + 1)
    xs = xs[WELL_COLUMNS[0] : WELL_COLUMNS[1] + 1]
    first, last = (
        np.array([section(PAD, x, PAD_POINTS)[k] for x in xs]) for k in WELL_POINTS
    )
    rows = slice(WELL_POINTS[0], WELL_POINTS[1] + 1)
    sides = [section(PAD, x, PAD_POINTS)[rows] for x in (xs[-1], xs[0])]
    path = np.concatenate([first, sides[0][1:-1], last[::-1], sides[1][::-1][1:-1]])
    tube("head-up frame", path, 0.0028, "plastic dark", 8, True)


def pad_height(x, y):
    """z of the pad's upper face at (x, y)."""
    curve = spline(PAD, 400)
    upper = curve[curve[:, 1] > curve[:, 1].max() - 0.09]
    upper = upper[: np.argmax(upper[:, 1]) + 1]
    return float(np.interp(-(y - wrap(x)), -upper[:, 0], upper[:, 1]))


def defroster():
    """The slots that blow onto the windscreen, along its foot."""
    for part, span in (("left", (-0.62, -0.06)), ("right", (0.06, 0.62))):
        xs = np.linspace(*span, 50)
        ys = np.array([glass_foot(x) - 0.105 for x in xs])
        path = np.column_stack([xs, ys, [pad_height(x, y) + 0.0004 for x, y in zip(xs, ys)]])
        tube(f"defroster {part}", path, 0.011, "plastic dark", 10, squash=0.22)
        tube(f"defroster slot {part}", path + (0, 0, 0.0018), 0.0062, "gap", 8, squash=0.22)


def pad_speaker():
    """A round grille in the middle of the pad."""
    y = 1.045
    slope = (pad_height(0, y + 0.02) - pad_height(0, y - 0.02)) / 0.04
    at = frame_matrix((0, y, pad_height(0, y) + 0.0005), (1, 0, 0), (0, 1, slope))
    ring = [
        (0.050, -0.003),
        (0.050, 0.003),
        (0.0485, 0.0048),
        (0.0465, 0.0040),
        (0.0460, 0.0020),
    ]
    lathe("pad speaker ring", ring, at, "plastic dark", 56)
    grille = [
        (0.0462, 0.0022),
        (0.040, 0.0034),
        (0.030, 0.0046),
        (0.015, 0.0054),
        (0.0005, 0.0056),
    ]
    lathe("pad speaker grille", grille, at, "speaker cloth", 48)


def airbag_seam():
    """The tear line of the passenger's airbag: a shallow groove in the pad."""
    profile = spline(PAD, 400)

    def on_pad(x, y):
        k = np.argmin(abs(profile[:, 0] - (y - wrap(x))) + 10 * (profile[:, 1] < 1.035))
        return (x, y, profile[k, 1] + 0.00015)

    outline = dense(rounded_rectangle(0.36, 0.15, 0.03) + np.array([0.42, 0.945]), 0.012)
    path = np.array([on_pad(*p) for p in np.vstack([outline, outline[:1]])])
    tube("airbag tear line", path, 0.0008, "gap", 6)
    x, y = 0.545, 0.832
    slope = (on_pad(x, y + 0.01)[2] - on_pad(x, y - 0.01)[2]) / 0.02
    word = frame_matrix(on_pad(x, y), (1, 0, 0), (0, 1, slope))
    printed("passenger airbag word", "AIRBAG", word, 0.0085, "thread dark", 0.12, 0.0003)
    sun_sensor()


def sun_sensor():
    """A small dome before the windscreen's foot, on the car's middle."""
    y = 1.215
    slope = (pad_height(0, y + 0.02) - pad_height(0, y - 0.02)) / 0.04
    at = frame_matrix((0, y, pad_height(0, y)), (1, 0, 0), (0, 1, slope))
    dome = [(0.0125, -0.001), (0.0125, 0.0012), (0.0105, 0.0020), (0.0095, 0.0045)]
    dome += [(0.0070, 0.0078), (0.0035, 0.0096), (0.0003, 0.0101)]
    lathe("sun sensor", dome, at, "plastic dark", 28)


def dense(outline, step):
    """A closed outline with a point each `step`, so that it can follow a curved surface."""
    o = np.vstack([outline, outline[:1]])
    arc = np.concatenate([[0], np.cumsum(np.linalg.norm(np.diff(o, axis=0), axis=1))])
    at = np.unique(np.concatenate([arc[:-1], np.arange(0, arc[-1] - 0.5 * step, step)]))
    return np.column_stack([np.interp(at, arc, o[:, k]) for k in range(2)])


def trim_band():
    """Wood between the vents, its grain along the dashboard."""
    for name, span in (("left", (-0.598, -0.12)), ("right", (-0.12, 0.592))):
        xs = np.linspace(*span, int((span[1] - span[0]) / 0.025) + 1)
        rows = np.array([section(BAND, x, 12) for x in xs])
        grid(f"trim band {name}", rows.transpose(1, 0, 2), "walnut open pore", flip=True)
    for name, point, radius in (
        ("upper", (0.7495, 0.9895), 0.0026),
        ("lower", (0.7490, 0.9195), 0.0042),
    ):
        tube(
            f"trim strip {name}",
            along(point, (-0.748, 0.748), 90),
            radius,
            "brushed aluminium",
            12,
        )
    tube(
        "ambient light guide",
        along((0.7545, 0.9145), (-0.74, 0.74), 60),
        0.0016,
        "symbol white",
        6,
    )


def knees():
    sweep("lower dashboard", KNEES, (-HALF_WIDTH, HALF_WIDTH), "leather cognac", 30)
    curve = spline(KNEES, 300)
    k = np.argmin(abs(curve[:, 1] - 0.893))
    for span, part in (((-0.745, -0.16), "left"), ((0.23, 0.745), "right")):
        path = along(curve[k], span, 120)
        stitches(f"lower seam {part}", path, np.tile((0, -0.94, 0.34), (120, 1)), "thread dark")
    glovebox(curve)


def glovebox(curve):
    """The lid's gap and its satin handle, on the passenger's side."""

    def on_knees(x, z):
        k = np.argmin(abs(curve[:, 1] - z))
        return (x, curve[k, 0] + wrap(x) - 0.0002, curve[k, 1])

    outline = dense(rounded_rectangle(0.42, 0.165, 0.02) + np.array([0.45, 0.782]), 0.012)
    path = np.array([on_knees(*p) for p in np.vstack([outline, outline[:1]])])
    tube("glovebox gap", path, 0.0014, "gap", 6)
    where = frame_matrix(
        Vector(on_knees(0.45, 0.845)) + Vector((0, -0.004, 0)), (1, 0, 0), (0, 0, 1)
    )
    plate(
        "glovebox handle",
        rounded_rectangle(0.085, 0.016, 0.006),
        0.006,
        where,
        "satin chrome",
        0.002,
    )


# ---- instrument cluster ------------------------------------------------------------------

CLUSTER_SIZE = (0.292, 0.1095)  # m, active area
CLUSTER_FRAME = frame_matrix((DRIVER_X, 0.728, 1.034), (1, 0, 0), (0, 0.17, 1))


def hood_ring(y_top, y_bottom, half_width, z_top, z_bottom, count=48):
    """One outline of the binnacle, from the lower left over the top to the lower right."""
    angle = np.linspace(math.radians(207), math.radians(-27), count)
    c, s = np.cos(angle), np.sin(angle)
    x = DRIVER_X + half_width * np.sign(c) * abs(c) ** 0.62
    middle = z_bottom + 0.33 * (z_top - z_bottom)
    z = np.where(
        s > 0,
        middle + (z_top - middle) * abs(s) ** 0.72,
        middle - (middle - z_bottom) * 2.1 * abs(s),
    )
    share = np.clip((z - z_bottom) / (z_top - z_bottom), 0, 1)
    return np.column_stack([x, y_bottom + (y_top - y_bottom) * share, z])


def binnacle():
    outside = [
        hood_ring(1.10, 1.10, 0.235, 1.010, 0.90),
        hood_ring(1.00, 1.00, 0.226, 1.049, 0.92),
        hood_ring(0.92, 0.92, 0.215, 1.084, 0.935),
        hood_ring(0.84, 0.84, 0.203, 1.110, 0.945),
        hood_ring(0.76, 0.775, 0.193, 1.1235, 0.952),
        hood_ring(0.705, 0.735, 0.187, 1.1260, 0.956),
        hood_ring(0.672, 0.713, 0.184, 1.1250, 0.9585),
    ]
    lip = [
        hood_ring(0.663, 0.706, 0.1825, 1.1225, 0.9600),
        hood_ring(0.660, 0.704, 0.1800, 1.1190, 0.9615),
        hood_ring(0.6625, 0.706, 0.1775, 1.1160, 0.9630),
    ]
    inside = [
        hood_ring(0.680, 0.718, 0.1700, 1.1105, 0.9660),
        hood_ring(0.715, 0.728, 0.1620, 1.1010, 0.9690),
        hood_ring(0.745, 0.735, 0.1540, 1.0935, 0.9710),
    ]
    shell = np.array(outside + lip)
    smooth = np.stack([spline(shell[:, k], 40) for k in range(shell.shape[1])], axis=1)
    hood = grid("binnacle hood", smooth, "leather black", flip=True)
    hidden = np.argmax(smooth[:, :, 1].max(1) < 1.045)  # rings under the pad, in the well's way
    cut(hood, range(hidden * (smooth.shape[1] - 1)))
    grid("binnacle inside", np.array(lip[-1:] + inside), "plastic dark", flip=True)
    hood_seam(outside)
    ring = hood_ring(0.698, 0.728, 0.1862, 1.1262, 0.9566)
    return ring


def hood_seam(outside):
    """Two rows of stitches that follow the hood's edge."""
    centre = np.array([DRIVER_X, 0.72, 1.02])
    for label, share in (("a", 0.18), ("b", 0.42)):
        path = outside[5] * (1 - share) + outside[4] * share
        path = path[6:-6]
        normals = (path - centre) * np.array([1.0, 0.0, 1.6])
        dense = spline(path, 300)
        stitches(f"hood seam {label}", dense, spline(normals, 300), "thread")
    fold = outside[5] * 0.70 + outside[4] * 0.30
    tube("hood seam fold", spline(fold[4:-4], 90), 0.0011, "gap", 6)


def display_quad(name, size, matrix):
    """A display's active area: u to the viewer's right, v (of glTF) down."""
    w, h = size[0] / 2, size[1] / 2
    corners = place([(-w, -h, 0), (w, -h, 0), (w, h, 0), (-w, h, 0)], matrix)
    item = mesh(name, corners, [(0, 1, 2, 3)], name, [(0, 0), (1, 0), (1, 1), (0, 1)])
    item["keep_uv"] = True
    return item


def cluster():
    binnacle()
    front = CLUSTER_FRAME @ Matrix.Translation((0, 0, -0.0006))
    plate(
        "cluster cover lens",
        rounded_rectangle(0.322, 0.142, 0.022),
        0.012,
        front,
        "cover glass etched",
        0.001,
    )
    display_quad("cluster", CLUSTER_SIZE, CLUSTER_FRAME)
    lower = CLUSTER_FRAME @ Matrix.Translation((0, -0.066, -0.004))
    box("cluster base", (0.33, 0.03, 0.05), lower, "plastic dark", 0.006)
    for k, y in (("upper", 0.0035), ("lower", -0.0035)):
        ends = np.linspace(-0.156, 0.156, 3)
        line = place([(x, y, 0.0250) for x in ends], lower)
        tube(f"cluster base groove {k}", line, 0.0005, "gap", 6)


# ---- centre display ----------------------------------------------------------------------

CENTRE_SIZE = (0.320, 0.180)  # m, active area, as its panel says
CENTRE_FRAME = frame_matrix(
    (CENTRE_X + 0.034, 0.668, 1.034),
    (math.cos(math.radians(7)), -math.sin(math.radians(7)), 0),
    (0, 0.13, 1),
)


def centre_display():
    glass = CENTRE_FRAME @ Matrix.Translation((0, 0, -0.0005))
    outline = rounded_rectangle(0.3400, 0.2020, 0.011, 8)
    plate("centre display glass", outline, 0.0035, glass, "cover glass", 0.0011, 3)
    rim = CENTRE_FRAME @ Matrix.Translation((0, 0, -0.0055))
    frame_ring(
        "centre display rim",
        outline,
        round_section(0.0030, 0.0080, 12),
        rim,
        "brushed aluminium",
    )
    back = CENTRE_FRAME @ Matrix.Translation((0, 0, -0.0035))
    plate(
        "centre display back",
        rounded_rectangle(0.3390, 0.2010, 0.0105, 8),
        0.013,
        back,
        "plastic dark",
        0.005,
        3,
    )
    display_quad("centre", CENTRE_SIZE, CENTRE_FRAME)
    foot = CENTRE_FRAME @ Matrix.Translation((0, -0.035, -0.045))
    box("centre display foot", (0.16, 0.10, 0.07), foot, "plastic dark", 0.012, 3)


# ---- air vents ---------------------------------------------------------------------------


def vent(name, origin, right, up, width, height, slats=4, vanes=5):
    """Slats with a satin edge in front of upright vanes, in a dark duct with a surround."""
    at = frame_matrix(origin, right, up)
    outline = rounded_rectangle(width, height, min(0.014, 0.42 * height), 6)
    frame_ring(
        f"{name} surround", outline, round_section(0.0052, 0.0090, 12), at, "satin chrome"
    )
    deep = at @ Matrix.Translation((0, 0, -0.030))
    rings = np.array(
        [np.column_stack([outline, np.full(len(outline), d)]) for d in (0.0, -0.022, -0.046)]
    )
    grid(f"{name} duct", place(rings, at), "plastic dark", closed=True)
    plate(f"{name} duct end", outline, 0.001, at @ Matrix.Translation((0, 0, -0.045)), "gap", 0)
    blades, edges = [], []
    pitch = height / (slats + 0.35)
    for i in range(slats):
        y = (i - (slats - 1) / 2) * pitch
        tilt = Matrix.Translation((0, y, -0.013)) @ Matrix.Rotation(math.radians(14), 4, "X")
        half = abs(y) / height
        blade_width = width - 0.004 - (0.012 if half > 0.38 else 0)
        blades.append(
            box("blade", (blade_width, 0.0026, 0.021), at @ tilt, "plastic dark", 0.001)
        )
        edge = tilt @ Matrix.Translation((0, 0, 0.0106))
        edges.append(
            box(
                "edge", (blade_width - 0.002, 0.0017, 0.0018), at @ edge, "satin chrome", 0.0006
            )
        )
    joined(f"{name} slats", blades)
    joined(f"{name} slat edges", edges)
    uprights = [
        box(
            "vane",
            (0.0022, height - 0.004, 0.014),
            deep @ Matrix.Translation(((i - (vanes - 1) / 2) * width / (vanes + 0.5), 0, 0)),
            "plastic dark",
            0.0008,
        )
        for i in range(vanes)
    ]
    joined(f"{name} vanes", uprights)
    tab = at @ Matrix.Translation((0, 0, -0.002))
    box(f"{name} tab", (0.013, 0.0070, 0.010), tab, "satin chrome", 0.0022, 3)


def side_direction(x):
    """The dashboard's tangent at x, to the right."""
    d = (wrap(x + 0.01) - wrap(x - 0.01)) / 0.02
    return (1.0, d, 0.0)


def vents():
    for name, x in (("air vent left", -0.668), ("air vent right", 0.668)):
        y = 0.738 + wrap(x)
        vent(name, (x, y, 0.955), side_direction(x), (0, 0.05, 1), 0.128, 0.056)
        back = frame_matrix((x, y + 0.0075, 0.955), side_direction(x), (0, 0, 1))
        surround = rounded_rectangle(0.146, 0.068, 0.012, 6)
        inner = rounded_rectangle(0.128, 0.056, 0.013, 6)
        rings = np.array(
            [
                np.column_stack([surround, np.full(len(surround), -0.004)]),
                np.column_stack([surround * 0.985, np.full(len(surround), 0.001)]),
                np.column_stack([inner, np.full(len(inner), 0.004)]),
            ]
        )
        grid(f"{name} bezel", place(rings, back), "piano black", closed=True, flip=False)
    for name, x in (
        ("air vent centre left", CENTRE_X - 0.083),
        ("air vent centre right", CENTRE_X + 0.083),
    ):
        vent(name, (x, 0.6995, 0.8945), (1, 0, 0), (0, 0.20, 1), 0.150, 0.040, 3, 6)


# ---- centre stack ------------------------------------------------------------------------


def stack_face(offset):
    return frame_matrix((CENTRE_X, 0.712, 0.862), (1, 0, 0), (0, 0.20, 1)) @ Matrix.Translation(
        offset
    )


def centre_stack():
    outline = rounded_rectangle(0.352, 0.128, 0.012, 6)
    inner = [
        rounded_rectangle(0.150, 0.040, 0.0139, 6) + np.array([dx, 0.0338])
        for dx in (-0.083, 0.083)
    ]
    holed_plate("centre stack fascia", outline, inner, stack_face((0, 0, 0.0035)))
    edge = stack_face((0, 0, -0.004))
    frame_ring(
        "centre stack trim",
        outline,
        round_section(0.0045, 0.012, 12),
        edge,
        "brushed aluminium",
    )
    block = frame_matrix((CENTRE_X, 0.79, 0.85), (1, 0, 0), (0, 0.2, 1))
    box("centre stack body", (0.35, 0.125, 0.10), block, "plastic dark", 0.006)


def holed_plate(name, outline, holes, matrix):
    """The fascia around the vents: bars between the outline and the holes."""
    bars = []
    left, right = outline[:, 0].min(), outline[:, 0].max()
    bottom, top = outline[:, 1].min(), outline[:, 1].max()
    edges = sorted(
        [left, right] + [h[:, 0].min() for h in holes] + [h[:, 0].max() for h in holes]
    )
    low, high = holes[0][:, 1].min(), holes[0][:, 1].max()
    for x0, x1, y0, y1 in [(left, right, bottom, low), (left, right, high, top)] + [
        (edges[i], edges[i + 1], low, high) for i in (0, 2, 4)
    ]:
        at = matrix @ Matrix.Translation(((x0 + x1) / 2, (y0 + y1) / 2, -0.004))
        bars.append(box("bar", (x1 - x0, y1 - y0, 0.008), at, "piano black", 0))
    return joined(name, bars)


def build_dashboard():
    pad()
    trim_band()
    knees()
    cluster()
    centre_display()
    vents()
    centre_stack()
