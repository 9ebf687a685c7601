# SPDX-License-Identifier: Apache-2.0
"""The car's materials as glTF metallic-roughness, with physically plausible values.

Colours are linear Rec.709 reflectances. TILE says how many metres one tile of a material's
textures covers.
"""
import math

TILE = {
    "leather black": 0.10,
    "leather cognac": 0.10,
    "leather wheel": 0.08,
    "seat leather": 0.10,
    "plastic grained": 0.10,
    "pillar fabric": 0.05,
    "alcantara grey": 0.20,
    "walnut open pore": 0.26,
    "carpet": 0.10,
    "speaker cloth": 0.018,
    "asphalt": 1.4,
    "asphalt patch": 1.4,
    "asphalt worn": 1.4,
    "gutter": 2.0,
    "grass": 3.0,
    "facade plaster": 12.0,
    "facade brick": 12.0,
    "facade office": 14.0,
    "wall cream": 4.0,
    "wall grey": 4.0,
    "wall ochre": 4.0,
    "wall green": 4.0,
    "wall white": 4.0,
    "wall brick": 2.0,
    "wall brick dark": 2.0,
    "roof tile": 2.4,
    "facade plaster ochre": 12.0,
    "facade plaster grey": 12.0,
    "hills": 160.0,
    "paving": 2.0,
}


def surface(color, roughness, metallic=0.0, **extra):
    """One entry: base colour, roughness, metallic; extra keys are told apart in finish.py."""
    return dict(color=tuple(color), roughness=roughness, metallic=metallic, **extra)


def grey(value, roughness, metallic=0.0, **extra):
    return surface((value, value, value), roughness, metallic, **extra)


def layer(millimetres, ior, **more):
    """One layer of a laminated pane."""
    return dict(thickness_m=round(millimetres * 1e-3, 10), ior=ior, **more)


WEDGE = 0.00041  # rad; hud_optics.py asks for it
# Two sheets of light green glass and PVB, growing thicker towards the roof (glTF's -v) for the
# head-up display of model_hud.py: its figure. Front outside.
GREEN = "../assets/spectra/glass_green.csv"
WINDSCREEN = dict(
    layers=[
        layer(2.1, 1.52, transmission=GREEN),
        layer(0.76, 1.485, wedge_rad=WEDGE, wedge_toward="-v"),
        layer(2.1, 1.52, transmission=GREEN),
    ],
    haze=dict(share=0.004, width_deg=2.5),
)


# A sol of silica: one quarter wave of n 1.44 at 550 nm.
SILICA = dict(layers=[dict(n=1.44, thickness_nm=95.5)])
ALUMINIUM = "../assets/coatings/aluminium.csv"
CHROMIUM = "../assets/coatings/chromium.csv"
# KHR_materials_anisotropy of belt-brushed metal: strength, and the turn from u of the direction
# in which highlights grow, which is across the grooves. Tubes have v along them, turned parts u
# around them, flat ones u to the right.
GROOVES_ALONG_V, GROOVES_ALONG_U = (0.65, 0.0), (0.65, round(math.pi / 2, 7))


MATERIALS = {
    # cabin, soft
    "leather black": surface(
        (0.040, 0.040, 0.042), 0.55, normal=("leather_normal", 0.8), ior=1.5
    ),
    "leather cognac": surface(
        (0.230, 0.095, 0.038), 0.52, normal=("leather_normal", 0.8), ior=1.5
    ),
    "leather wheel": surface(
        (0.036, 0.036, 0.038), 0.50, normal=("leather_normal", 0.45), ior=1.5
    ),
    "seat leather": surface(
        (0.215, 0.090, 0.037), 0.55, normal=("perforated_normal", 0.8), ior=1.5
    ),
    "thread": surface((0.48, 0.36, 0.25), 0.75),
    "thread dark": surface((0.16, 0.15, 0.145), 0.75),
    "pillar fabric": surface(
        (1, 1, 1), 0.95, texture="fabric_color", normal=("fabric_normal", 0.7)
    ),
    "alcantara grey": surface(
        (1, 1, 1), 1.0, texture="suede_color", sheen=((0.12, 0.12, 0.12), 0.4)
    ),
    "speaker cloth": surface((0.024, 0.024, 0.025), 0.7, normal=("perforated_normal", 1.0)),
    "carpet": surface((0.030, 0.030, 0.032), 1.0, normal=("fabric_normal", 1.0)),
    # cabin, hard
    "plastic grained": surface(
        (0.045, 0.045, 0.047), 0.58, normal=("leather_normal", 0.5), ior=1.5
    ),
    "plastic dark": surface((0.028, 0.028, 0.030), 0.42, ior=1.5),
    "gap": grey(0.010, 0.9),
    # a black pigment in the lacquer: between the two nothing reflects
    "piano black": grey(0.003, 0.9, specular=0.0, clearcoat=(1.0, 0.03)),
    # the panes around the displays' pictures, black behind, coated as the panels were measured:
    # 1.5 % of a mirror at the normal, and 2.4 %, etched
    "cover glass": grey(0.004, 0.03, ior=1.52, coating=dict(stack="mgf2")),
    "cover glass etched": grey(0.004, 0.235, ior=1.52, coating=SILICA),
    "walnut open pore": surface(
        (1, 1, 1), 0.42, texture="wood_color", normal=("wood_normal", 0.6)
    ),
    "satin chrome": surface((0.56, 0.555, 0.555), 0.30, 1.0, conductor=CHROMIUM),
    "bright chrome": surface((0.56, 0.555, 0.555), 0.20, 1.0, conductor=CHROMIUM),
    "brushed aluminium": surface(
        (0.912, 0.914, 0.920), 0.26, 1.0, conductor=ALUMINIUM, brushed=GROOVES_ALONG_V
    ),
    "cross-brushed aluminium": surface(
        (0.912, 0.914, 0.920), 0.26, 1.0, conductor=ALUMINIUM, brushed=GROOVES_ALONG_U
    ),
    "button": surface((0.034, 0.034, 0.036), 0.45),
    "symbol white": grey(0.72, 0.6),
    "symbol red": surface((0.55, 0.03, 0.02), 0.5),
    "mirror silver": grey(0.90, 0.02, 1.0),
    # glass and body
    "windscreen glass": surface(
        (0.82, 0.86, 0.84), 0.0, glass=True, ior=1.52, glazing=WINDSCREEN
    ),
    "roof glass": surface((0.30, 0.32, 0.31), 0.0, glass=True, ior=1.52),
    "side glass": surface((0.82, 0.85, 0.84), 0.0, glass=True, ior=1.52),
    "frit": grey(0.012, 0.6),
    "rubber": grey(0.022, 0.75),
    "car paint": surface((0.030, 0.075, 0.180), 0.35, 0.55, clearcoat=(1.0, 0.02)),
    "tail lamp": surface((0.30, 0.012, 0.010), 0.12, clearcoat=(1.0, 0.03)),
    "paint other": surface((0.42, 0.43, 0.44), 0.35, 0.4, clearcoat=(1.0, 0.03)),
    "paint red": surface((0.24, 0.022, 0.018), 0.4, 0.0, clearcoat=(1.0, 0.03)),
    "paint dark": surface((0.012, 0.016, 0.022), 0.35, 0.3, clearcoat=(1.0, 0.03)),
    "paint white": surface((0.66, 0.66, 0.64), 0.4, 0.0, clearcoat=(1.0, 0.03)),
    "dark glass": grey(0.010, 0.03, ior=1.52),
    # outside
    "asphalt": surface(
        (1, 1, 1), 0.88, texture="asphalt_color", normal=("asphalt_normal", 1.0)
    ),
    "asphalt patch": surface((0.76, 0.76, 0.77), 0.85, texture="asphalt_color"),
    "asphalt worn": surface((0.92, 0.92, 0.92), 0.8, texture="asphalt_color"),
    "tar": grey(0.012, 0.45),
    "gutter": surface((0.80, 0.79, 0.76), 0.9, texture="paving_color"),
    "paving": surface((1, 1, 1), 0.9, texture="paving_color"),
    "grass blade": surface((0.085, 0.140, 0.036), 0.7),
    "grass blade dry": surface((0.190, 0.180, 0.070), 0.8),
    "hedge core": surface((0.030, 0.050, 0.016), 0.9),
    "bench wood": surface((0.150, 0.075, 0.036), 0.6),
    "sign yellow": surface((0.60, 0.42, 0.02), 0.5),
    "kerb": grey(0.30, 0.85),
    "road marking": grey(0.62, 0.7),
    "grass": surface((1, 1, 1), 1.0, texture="grass_color"),
    "leaf": surface((0.070, 0.125, 0.030), 0.6),
    "leaf light": surface((0.110, 0.160, 0.034), 0.6),
    "leaf dark": surface((0.040, 0.082, 0.024), 0.5),
    "bark": surface((0.075, 0.056, 0.040), 0.95),
    "facade plaster": surface((1, 1, 1), 0.85, texture="facade_plaster"),
    "facade brick": surface((1, 1, 1), 0.85, texture="facade_brick"),
    "facade office": surface((1, 1, 1), 0.6, texture="facade_office"),
    "facade plaster ochre": surface((1.0, 0.80, 0.52), 0.85, texture="facade_plaster"),
    "facade plaster grey": surface((0.72, 0.80, 0.88), 0.85, texture="facade_plaster"),
    "wall cream": surface((0.56, 0.50, 0.40), 0.9, texture="wall_plaster"),
    "wall grey": surface((0.38, 0.39, 0.40), 0.9, texture="wall_plaster"),
    "wall ochre": surface((0.50, 0.35, 0.17), 0.9, texture="wall_plaster"),
    "wall green": surface((0.34, 0.40, 0.33), 0.9, texture="wall_plaster"),
    "wall white": surface((0.62, 0.61, 0.59), 0.9, texture="wall_plaster"),
    "wall brick": surface((1, 1, 1), 0.9, texture="wall_brick"),
    "wall brick dark": surface((0.66, 0.62, 0.64), 0.9, texture="wall_brick"),
    "wall trim": surface((0.56, 0.55, 0.52), 0.85),
    "stone": surface((0.27, 0.26, 0.24), 0.85),
    "window frame": surface((0.60, 0.60, 0.58), 0.5),
    "curtain": surface((0.42, 0.40, 0.36), 0.9),
    "door paint": surface((0.022, 0.055, 0.045), 0.4),
    "shop frame": surface((0.030, 0.032, 0.036), 0.4),
    "fascia 0": surface((0.020, 0.070, 0.120), 0.5),
    "fascia 1": surface((0.180, 0.020, 0.024), 0.5),
    "iron": grey(0.025, 0.5),
    "roof tile": surface((1, 1, 1), 0.85, texture="roof_tiles"),
    "roof tile far": surface((0.155, 0.060, 0.040), 0.85),
    "roof grey": surface((0.16, 0.16, 0.17), 0.85),
    "galvanised steel": surface((0.50, 0.51, 0.52), 0.45, 1.0),
    "pole": grey(0.20, 0.5),
    "hills": surface((1, 1, 1), 1.0, texture="hills_color"),
    "hills far": surface((0.190, 0.235, 0.270), 1.0),
    "sign blue": surface((0.010, 0.060, 0.300), 0.5),
    # what the displays show: finish.py adds PARHELION_display
    "cluster": grey(0.0, 0.25, display=("ips_cluster.panel", "cluster.png", 450.0)),
    "centre": grey(0.0, 0.10, display=("oled_centre.panel", "centre.png", 600.0)),
    # lights of the night scene: (linear colour, strength in cd/m2)
    "lamp head": grey(0.1, 0.5, emission=((1.0, 0.86, 0.66), 9000.0)),
    "lit window": grey(0.1, 0.5, emission=((1.0, 0.74, 0.42), 45.0)),
    "lit window cool": grey(0.1, 0.5, emission=((0.85, 0.93, 1.0), 30.0)),
    "tail lamp lit": grey(0.1, 0.5, emission=((1.0, 0.02, 0.01), 150.0)),
    "ambient line": grey(0.1, 0.5, emission=((0.25, 0.62, 1.0), 14.0)),
    "traffic green": grey(0.1, 0.5, emission=((0.05, 1.0, 0.45), 2500.0)),
    # controls: anodised paddles and rings, wipers, tell-tale lines, legends lit at night
    "satin dark": surface((0.055, 0.055, 0.058), 0.38, 1.0),
    "wiper black": grey(0.012, 0.9, specular=0.4),
    "lamp off": surface((0.22, 0.15, 0.06), 0.5),
    "legend lit": grey(0.1, 0.5, emission=((1.0, 0.95, 0.88), 2.0)),
    "legend amber": grey(0.1, 0.5, emission=((1.0, 0.58, 0.12), 4.0)),
}
