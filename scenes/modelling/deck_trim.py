# SPDX-License-Identifier: Apache-2.0
"""What fills the walls beside the pilots: a tablet in its mount, boxes, placards, gap lines."""
import numpy as np
from mathutils import Matrix

from deck_layout import EYE
from deck_panel import display_quad
from deck_shell import SILL, TOP, TOP_Z
from kit import Kit, shifted
from shapes import frame_matrix, spline, tube


def tablet(kit, side):
    """An electronic flight bag on a ball mount at the side window's sill."""
    centre = np.array([side * 0.885, 0.455, 0.965])
    towards = np.array([side * -EYE[0], 0.0, 1.12]) - centre
    right = np.cross((0, 0, 1), towards)
    at = frame_matrix(centre, right, np.cross(towards, right))
    kit.panel((0.152, 0.206), shifted(at, z=-0.010), "bezel", 0.010, 0.010, 0.0018)
    kit.panel((0.138, 0.192), shifted(at, z=0.0), "window black", 0.0006, 0.004, 0.0002)
    display_quad(f"tablet {side}", (0.126, 0.168), shifted(at, z=0.0010), material="tablet")
    for k in (-1, 1):
        kit.box((0.030, 0.012, 0.018), shifted(at, k * 0.045, 0.104, -0.004), "knob", 0.003)
        kit.box((0.030, 0.012, 0.018), shifted(at, k * 0.045, -0.104, -0.004), "knob", 0.003)
    back = at @ Matrix.Translation((0, -0.03, -0.024))
    kit.lathe([(0.020, -0.012), (0.022, 0), (0.020, 0.012)], back, "knob", 24)
    path = spline(
        [back.translation, (side * 0.930, 0.515, 0.895), (side * 0.918, 0.525, 0.805)], 14
    )
    tube(f"tablet arm {side}", path, 0.011, "stick", 12)
    foot = frame_matrix((side * 0.918, 0.525, 0.790), (1, 0, 0), (0, 1, 0))
    kit.lathe([(0.032, -0.012), (0.032, 0.006), (0.026, 0.012)], foot, "knob", 28)


def sill_gaps(side):
    """The joint between the window frames and the side lining."""
    for i in (1, 2):
        a, b = np.array(SILL[i]), np.array(SILL[i + 1])
        inward = np.array([-0.004, -0.004, -0.004])
        path = [(a + (b - a) * t + inward) * (side, 1, 1) for t in np.linspace(0, 1, 12)]
        tube(f"sill joint {side} {i}", path, 0.0022, "gap", 6)
    crease = []
    for i in (0, 1, 2):
        a, b = np.array([*TOP[i], TOP_Z]), np.array([*TOP[i + 1], TOP_Z])
        crease += [(a + (b - a) * t) * (side, 1, 1) for t in np.linspace(0, 1, 10)]
    tube(f"brow joint {side}", np.array(crease) + (0, -0.004, -0.002), 0.0022, "gap", 6)


def console_boxes(kit, side):
    """Mask stowage and document pocket behind the stick, with placards."""
    mask = frame_matrix((side * 0.868, 0.110, 0.752), (1, 0, 0), (0, 1, 0.01))
    kit.panel((0.125, 0.215), mask, "panel", 0.010, 0.010, 0.002)
    top = shifted(mask, z=0.010)
    kit.screws(top, (0.125, 0.215), 0.010, 0.003)
    kit.line([(-0.056, 0.0), (0.056, 0.0)], top, 0.0014, "gap")
    kit.panel((0.050, 0.022), shifted(top, 0, 0.055), "guard red", 0.003, 0.003)
    kit.text("OXY MASK", shifted(top, 0, 0.055, 0.0033), 0.0055)
    kit.text("PRESS TO TEST", shifted(top, 0, 0.030), 0.0042)
    kit.lathe(
        [(0.010, 0), (0.010, 0.004), (0.008, 0.005)], shifted(top, 0.03, -0.04), "knob", 24
    )
    cup = frame_matrix((side * 0.870, -0.085, 0.742), (1, 0, 0), (0, 1, 0))
    kit.lathe(
        [(0.047, 0), (0.047, 0.006), (0.041, 0.008), (0.040, 0.004), (0.038, -0.045)],
        cup,
        "panel dark",
        36,
    )


def post_details(kit, side):
    """A placard and a vent on the posts between the windows."""
    a = np.array([side * SILL[1][0], SILL[1][1], SILL[1][2]])
    b = np.array([side * TOP[1][0], TOP[1][1], TOP_Z])
    spot = a + (b - a) * 0.24 + np.array([-side * 0.020, -0.024, 0.004])
    at = frame_matrix(spot, (0.72, -0.60 * side, 0) if side > 0 else (0.72, 0.60, 0), b - a)
    kit.lathe(
        [(0.023, -0.012), (0.023, 0.006), (0.019, 0.011), (0.013, 0.004)], at, "bezel", 28
    )
    kit.lathe([(0.0125, 0.002), (0.010, 0.008), (0.004, 0.010)], at, "knob", 20)


def clip_boards(kit):
    """Clip boards with a page of the flight plan on the sliding tables."""
    for side in (-1, 1):
        board = frame_matrix((side * 0.480, 0.590, 0.6440), (1, 0, 0), (0, 0.98, 0.18))
        kit.panel((0.160, 0.105), board, "panel dark", 0.004, 0.005)
        kit.panel(
            (0.140, 0.098), shifted(board, 0, -0.004, 0.004), "paper", 0.0006, 0.001, 0.0002
        )
        sheet = shifted(board, 0, -0.004, 0.0047)
        for k in range(9):
            wide = 0.050 - 0.012 * ((k * 7) % 4) / 3
            y = 0.036 - 0.0095 * k
            kit.line([(-0.058, y), (-0.058 + 2 * wide, y)], sheet, 0.0014, "ink")
        clip = shifted(board, 0, 0.048, 0.004)
        kit.box((0.070, 0.014, 0.006), clip, "steel", 0.002)


def build_trim():
    kit = Kit("trim")
    for side in (-1, 1):
        tablet(kit, side)
        sill_gaps(side)
        console_boxes(kit, side)
        post_details(kit, side)
    clip_boards(kit)
    kit.build()
