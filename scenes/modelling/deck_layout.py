# SPDX-License-Identifier: Apache-2.0
"""Where things are on the flight deck: shared planes and sizes.

x to the right, y forward, z up, metres; z = 0 the floor, y = 0 the pilots' eyes.
"""
import numpy as np

from shapes import frame_matrix

EYE = (-0.53, 0.0, 1.17)  # the captain's

# The main instrument panel: a plane that leans away at the top.
PANEL_TOP, PANEL_FOOT = (0.740, 0.914), (0.662, 0.650)  # (y, z)
PANEL_HALF = 0.766
PANEL_UP = (0.0, PANEL_TOP[0] - PANEL_FOOT[0], PANEL_TOP[1] - PANEL_FOOT[1])
PANEL = frame_matrix(
    (0, 0.5 * (PANEL_TOP[0] + PANEL_FOOT[0]), 0.5 * (PANEL_TOP[1] + PANEL_FOOT[1])),
    (1, 0, 0),
    PANEL_UP,
)
PANEL_HEIGHT = float(np.hypot(PANEL_UP[1], PANEL_UP[2]))

# Displays on it: name -> (x, y in the plane, width, height of the active area)
DISPLAYS = {
    "pfd": (-0.585, 0.002, 0.250, 0.200),
    "nav": (-0.304, 0.002, 0.250, 0.200),
    "engine": (0.056, 0.000, 0.172, 0.215),
    "standby": (-0.098, 0.060, 0.078, 0.078),
    "nav_right": (0.304, 0.002, 0.250, 0.200),
    "pfd_right": (0.585, 0.002, 0.250, 0.200),
}

# The glareshield's control panel and the coaming above it.
FACE_FOOT, FACE_TOP = (0.618, 0.942), (0.628, 1.004)  # (y, z)
FACE_HALF = 0.690
FACE = frame_matrix(
    (0, 0.5 * (FACE_FOOT[0] + FACE_TOP[0]), 0.5 * (FACE_FOOT[1] + FACE_TOP[1])),
    (1, 0, 0),
    (0, FACE_TOP[0] - FACE_FOOT[0], FACE_TOP[1] - FACE_FOOT[1]),
)

# The pedestal: (y, z) of its ridge, from the main panel to the rear.
PEDESTAL_HALF = 0.190
PEDESTAL = [(0.662, 0.650), (0.470, 0.584), (0.120, 0.562), (-0.330, 0.545)]


def pedestal_plane(i, share=0.5):
    """The plane of the pedestal's i-th stretch, its origin at `share` from the front."""
    (y0, z0), (y1, z1) = PEDESTAL[i], PEDESTAL[i + 1]
    origin = (0, y0 + share * (y1 - y0), z0 + share * (z1 - z0))
    return frame_matrix(origin, (1, 0, 0), (0, y0 - y1, z0 - z1))


def pedestal_length(i):
    (y0, z0), (y1, z1) = PEDESTAL[i], PEDESTAL[i + 1]
    return float(np.hypot(y0 - y1, z0 - z1))
