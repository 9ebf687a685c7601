# SPDX-License-Identifier: Apache-2.0
"""The flight deck's materials, beside the car's: painted metal panels, moulded plastics, an
anti-glare coaming, engraved legends that glow faintly, glass of the windscreens."""
from materials import (
    ALUMINIUM,
    GROOVES_ALONG_U,
    MATERIALS,
    TILE,
    grey,
    layer,
    surface,
)

TILE.update(
    {
        "coaming": 0.055,
        "sheepskin": 0.05,
        "armrest": 0.10,
        "deck seat": 0.05,
        "deck carpet": 0.10,
    }
)

# A heated windscreen, front outside: a glass ply, the film of indium tin oxide that warms it,
# urethane, and two glass plies with PVB that carry the pressure. 23 mm in all.
HEATED = dict(
    layers=[
        layer(3.0, 1.52, transmission=0.985),
        layer(0.0003, 1.9, transmission=0.90),
        layer(2.5, 1.49, transmission=0.99),
        layer(8.0, 1.52, transmission=0.965),
        layer(1.9, 1.485, transmission=0.99),
        layer(8.0, 1.52, transmission=0.965),
    ],
    haze=dict(share=0.003, width_deg=2.0),
)

DECK = {
    # soft
    "coaming": surface((0.034, 0.035, 0.038), 0.80, normal=("leather_normal", 0.45), ior=1.45),
    "coaming thread": surface((0.115, 0.118, 0.125), 0.85),
    "armrest": surface((0.050, 0.052, 0.056), 0.6, normal=("leather_normal", 0.7), ior=1.5),
    "deck seat": surface((0.100, 0.118, 0.150), 0.95, normal=("fabric_normal", 1.0)),
    "sheepskin": surface((0.33, 0.29, 0.23), 1.0, normal=("fabric_normal", 1.0)),
    "deck carpet": surface((0.040, 0.046, 0.058), 1.0, normal=("fabric_normal", 1.0)),
    "visor": surface((0.070, 0.085, 0.060), 0.35, ior=1.5),
    # painted and moulded
    "panel": surface((0.175, 0.182, 0.185), 0.52, ior=1.45),
    "panel dark": surface((0.066, 0.070, 0.073), 0.5, ior=1.45),
    "lining": surface((0.53, 0.52, 0.49), 0.72, ior=1.45),
    "lining grey": surface((0.285, 0.292, 0.296), 0.68, ior=1.45),
    "bezel": surface((0.042, 0.044, 0.047), 0.45, ior=1.5),
    "key": surface((0.060, 0.062, 0.066), 0.48, ior=1.5),
    "key light": surface((0.17, 0.18, 0.19), 0.5, ior=1.5),
    "knob": surface((0.046, 0.047, 0.050), 0.40, ior=1.5),
    "knob grey": surface((0.24, 0.25, 0.26), 0.42, ior=1.5),
    "handle": surface((0.46, 0.45, 0.43), 0.38, ior=1.5),
    "stick": surface((0.038, 0.039, 0.042), 0.46, ior=1.5),
    "window black": grey(0.014, 0.16, ior=1.5),
    "fastener": surface((0.30, 0.30, 0.305), 0.42, 0.8),
    "steel": surface((0.60, 0.60, 0.61), 0.30, 1.0),
    "lever": surface(
        (0.912, 0.914, 0.920), 0.28, 1.0, conductor=ALUMINIUM, brushed=GROOVES_ALONG_U
    ),
    "guard red": surface((0.42, 0.028, 0.022), 0.42, ior=1.5),
    "paper": grey(0.58, 0.85),
    "ink": grey(0.035, 0.8),
    "compass face": grey(0.020, 0.5),
    # what glows
    "legend": surface((0.62, 0.62, 0.60), 0.6, emission=((1.0, 0.86, 0.66), 1.2)),
    "legend dim": surface((0.40, 0.40, 0.39), 0.6, emission=((1.0, 0.86, 0.66), 0.35)),
    "lit green": surface((0.03, 0.10, 0.04), 0.5, emission=((0.16, 1.0, 0.30), 9.0)),
    "lit amber": surface((0.12, 0.07, 0.02), 0.5, emission=((1.0, 0.55, 0.06), 9.0)),
    "lit cyan": surface((0.03, 0.09, 0.11), 0.5, emission=((0.20, 0.85, 1.0), 7.0)),
    "lit white": surface((0.40, 0.40, 0.40), 0.5, emission=((1.0, 0.93, 0.82), 5.0)),
    # glass and skin
    "cockpit glass": surface(
        (0.79, 0.82, 0.80), 0.0, glass=True, ior=1.52, glazing=HEATED
    ),
    "compass glass": surface((0.93, 0.93, 0.93), 0.0, glass=True, ior=1.5),
    "seal": grey(0.020, 0.70),
    "skin": surface((0.075, 0.078, 0.080), 0.55, ior=1.45),
    "skin dark": grey(0.030, 0.62),
    # displays: (panel, picture, white other viewers show in cd/m2, flags); one picture fills
    # windows of three shapes
    "pfd": grey(0.0, 0.25, display=("ips_cluster.panel", "pfd.png", 450.0)),
    "nav": grey(0.0, 0.25, display=("ips_cluster.panel", "nav.png", 450.0)),
    "engine": grey(0.0, 0.25, display=("ips_cluster.panel", "engine.png", 450.0)),
    "standby": grey(0.0, 0.10, display=("oled_centre.panel", "standby.png", 450.0)),
    "pfd_right": grey(0.0, 0.25, display=("ips_cluster.panel", "pfd.png", 450.0)),
    "nav_right": grey(0.0, 0.25, display=("ips_cluster.panel", "nav.png", 450.0)),
    "cdu": grey(0.0, 0.25, display=("oled_centre.panel", "cdu.png", 300.0)),
    "tablet": grey(0.0, 0.10, display=("oled_centre.panel", "tablet.png", 300.0)),
    "windows": grey(0.0, 0.25, display=("oled_centre.panel", "windows.png", 300.0, "any_size")),
}


def use_deck_materials():
    MATERIALS.update(DECK)
