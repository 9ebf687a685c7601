# SPDX-License-Identifier: Apache-2.0
"""cases.py -- small scenes whose luminance is known in closed form.

Each function gives a Case: a scene, and for cameras in it the luminance in cd/m2 that the frame
must show. A Lambertian surface of reflectance RHO under E lux shows RHO E / pi.
"""
import math
from dataclasses import dataclass, field

import layers
from gltf import Scene, png, radiance_picture

RHO = 0.5
FACING_DOWN = (0, -1, 0)


@dataclass
class Claim:
    camera: str
    luminance: float      # cd/m2
    region: tuple = None  # x0, y0, x1, y1, pixels; the whole frame without


@dataclass
class Case:
    name: str
    scene: Scene
    claims: list
    options: list = field(default_factory=list)
    size: tuple = (16, 16)
    samples: int = 64   # to begin with; more follow until the frame's own error is small
    is_quick: bool = True


def shown(illuminance, reflectance=RHO):
    return reflectance * illuminance / math.pi


# ---- geometry ------------------------------------------------------------------------------

def parallel_corner(a, b, c):
    """Configuration factor from a point to a rectangle a x b that lies parallel at distance c,
    one corner above the point (catalogue of Howell, B-3)."""
    a, b = a / c, b / c
    ra, rb = math.hypot(1, a), math.hypot(1, b)
    return (a / ra * math.atan(b / ra) + b / rb * math.atan(a / rb)) / (2 * math.pi)


def perpendicular_corner(depth, width, c):
    """The same to a rectangle at right angles: `depth` away from the point's plane, `width`
    along it, c its distance from the point (Howell, B-4)."""
    x, y = depth / width, c / width
    r = math.hypot(x, y)
    return (math.atan(1 / y) - y / r * math.atan(1 / r)) / (2 * math.pi)


def fresnel(cos_i, ior):
    """Reflectances of one face, s and p."""
    cos_t = math.sqrt(1 - (1 - cos_i * cos_i) / (ior * ior))
    s = (cos_i - ior * cos_t) / (cos_i + ior * cos_t)
    p = (ior * cos_i - cos_t) / (ior * cos_i + cos_t)
    return s * s, p * p


def pane_transmittance(cos_i, ior):
    """A pane without absorption, all inner reflections, mean of both polarisations."""
    return sum((1 - r) / (1 + r) for r in fresnel(cos_i, ior)) / 2


def tinted_pane(cos_i, ior, tint):
    """R and T of two faces and one body that lets `tint` through along the normal, mean of both
    polarisations."""
    t = tint ** (1 / math.sqrt(1 - (1 - cos_i * cos_i) / (ior * ior)))
    r_t = [(r + (1 - r) ** 2 * t * t * r / (1 - r * r * t * t),
            (1 - r) ** 2 * t / (1 - r * r * t * t)) for r in fresnel(cos_i, ior)]
    return sum(r for r, _ in r_t) / 2, sum(t for _, t in r_t) / 2


def tilted(degrees):
    """Unit vector in the x-y plane, so many degrees from +Y towards +X."""
    angle = math.radians(degrees)
    return [math.sin(angle), math.cos(angle), 0]


def look_from(scene, name, target, direction, distance=0.05, half=0.002):
    """A parallel camera that sees a spot of 4 mm about `target` from `direction`."""
    position = [t + distance * d for t, d in zip(target, direction)]
    scene.probe(name, position, [-d for d in direction], half)


def floor_scene(reflectance=RHO, half=50):
    scene = Scene()
    white = scene.lambert(reflectance)
    scene.quad(white, [-half, 0, half], [2 * half, 0, 0], [0, 0, -2 * half])
    return scene


# ---- energy --------------------------------------------------------------------------------

def furnace_sphere():
    scene = Scene()
    scene.sphere(scene.lambert(0.5, 0.5), [0, 0, 0], 1, inside=True)
    scene.view("inside", [0.2, 0.1, -0.3], [1, 0.3, 0.2], 90)
    return Case("furnace: albedo 1/2 and emission 1/2 show 1", scene, [Claim("inside", 1)])


def furnace_bright(*options):
    scene = Scene()
    scene.box_inside(scene.lambert(0.9, 1), [-1, -1, -1], [1, 2, 1])
    scene.view("inside", [0.2, 0.1, -0.3], [1, 0.3, 0.2], 90)
    return Case("furnace: albedo 0.9 and emission 1 show 10", scene, [Claim("inside", 10)],
                ["--max-bounces", "1000", *options], size=(32, 32),
                samples=110 if options else 180)


def furnace_outside():
    scene = Scene()
    scene.sphere(scene.lambert(1), [0, 0, 0], 1)
    scene.environment(type="constant", luminance=100)
    scene.view("outside", [0, 0, 3], [0, 0, -1], 60)
    return Case("a white sphere vanishes in a uniform environment", scene,
                [Claim("outside", 100)])


def cube(reflectance, is_quick=True, samples=128, options=()):
    """CIE 171 5.8: 10000 lm in the middle of a 4 m cube, mean illuminance of a wall."""
    scene = Scene()
    scene.box_inside(scene.lambert(reflectance), [-2, -2, -2], [2, 2, 2])
    scene.light("point", 10000 / (4 * math.pi))
    scene.probe("wall", [0, 0, 1.9], [0, 0, -1], 2)
    total = 10000 / 96 / (1 - reflectance)
    return Case(f"inter-reflection in a cube of reflectance {reflectance}", scene,
                [Claim("wall", shown(total, reflectance))], ["--max-bounces", "2000", *options],
                size=(32, 32), samples=samples, is_quick=is_quick)


def flux():
    """CIE 171 5.4: what a lamp sends out arrives on the walls, 10000 lm on 80 m2."""
    scene = Scene()
    scene.box_inside(scene.lambert(RHO), [-2, 0, -2], [2, 3, 2])
    scene.light("point", 10000 / (4 * math.pi), [0.7, 1.9, -0.4])
    scene.environment(type="constant", luminance=0)
    views = [([0, 2.9, 0], [0, -1, 0], 2), ([0, 0.1, 0], [0, 1, 0], 2),
             ([0, 1.5, 1.9], [0, 0, -1], 1.5), ([0, 1.5, -1.9], [0, 0, 1], 1.5),
             ([1.9, 1.5, 0], [-1, 0, 0], 1.5), ([-1.9, 1.5, 0], [1, 0, 0], 1.5)]
    parts = []
    for i, (position, direction, half_height) in enumerate(views):
        scene.probe(f"wall{i}", position, direction, half_height, 2)
        size = (32, round(16 * half_height))
        parts.append((f"wall{i}", size, 4 * 2 * half_height))
    case = Case("flux: 10000 lm arrive on 80 m2 of walls", scene, [], ["--max-bounces", "1"])
    case.weighted = (parts, RHO * 10000 / math.pi)
    return case


# ---- lights --------------------------------------------------------------------------------

POINTS = [(0, 0), (0.5, 0), (1, 0), (1.5, 0), (0.5, 0.5), (1, 0.5), (1.5, 0.5), (1, 1),
          (1.5, 1), (1.5, 1.5)]


def point_light():
    scene, claims = floor_scene(), []
    scene.light("point", 1000, [0, 3, 0])
    for x, y in POINTS:
        look_from(scene, f"{x},{y}", [x, 0, y], [0, 1, 0])
        claims.append(Claim(f"{x},{y}", shown(3000 / (9 + x * x + y * y) ** 1.5)))
    return Case("point light of 1000 cd at 3 m", scene, claims)


def small_lambertian_source():
    """CIE 171 5.2: E = 1000 9 / (9 + r^2)^2 lx, the source a square of 1 cm."""
    scene, claims = floor_scene(), []
    scene.facing_quad(scene.emitter(1e7), [0, 3, 0], FACING_DOWN, 0.01)
    for x, y in POINTS:
        look_from(scene, f"{x},{y}", [x, 0, y], [0, 1, 0])
        claims.append(Claim(f"{x},{y}", shown(9000 / (9 + x * x + y * y) ** 2)))
    return Case("CIE 171 5.2, Lambertian point source", scene, claims, ["--max-bounces", "1"])


def lacquered_lamp(coat, degrees):
    """A lamp under a clear coat: emission times 1 - coat times Fresnel's reflectance (1.5), to
    the eye itself, and to a floor that light samples light."""
    scene = floor_scene()
    lamp = scene.material(
        pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
        emissiveFactor=[1, 1, 1], extensions={
            "KHR_materials_specular": {"specularFactor": 0},
            "KHR_materials_clearcoat": {"clearcoatFactor": coat},
            "KHR_materials_emissive_strength": {"emissiveStrength": 1e6}})
    direction = tilted(degrees)
    scene.facing_quad(lamp, [2 * direction[0], 2 * direction[1], 0], FACING_DOWN, 0.02)
    look_from(scene, "lamp", [2 * direction[0], 2 * direction[1], 0],
              [-x for x in direction], distance=1)
    look_from(scene, "floor", [0, 0, 0], [0, 1, 0])
    cos_i = math.cos(math.radians(degrees))
    sent = 1e6 * (1 - coat * sum(fresnel(cos_i, 1.5)) / 2)
    return Case(f"a lamp under a coat of {coat} at {degrees} degrees", scene,
                [Claim("lamp", sent), Claim("floor", shown(sent * cos_i ** 2 * 1e-4))],
                ["--max-bounces", "1"])


def tilted_coat():
    """A coat whose normal map leans by 45 degrees to +x, seen at 10 degrees from there."""
    scene = Scene()
    lean = scene.image("image/png", png(1, 1, [[218, 128, 218]]))
    lamp = scene.material(
        pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
        emissiveFactor=[1, 1, 1], extensions={
            "KHR_materials_specular": {"specularFactor": 0},
            "KHR_materials_clearcoat": {"clearcoatFactor": 0.8, "clearcoatNormalTexture": {
                "index": lean}},
            "KHR_materials_emissive_strength": {"emissiveStrength": 100}})
    scene.quad(lamp, [-1, 0, 1], [2, 0, 0], [0, 0, -2])
    normal = [2 * c / 255 - 1 for c in (218, 218, 128)]  # its y is world's -z
    size = math.sqrt(sum(x * x for x in normal))
    claims = []
    for degrees in (-20, 10, 55):
        direction = tilted(degrees)
        cos_i = abs(normal[0] * direction[0] + normal[1] * direction[1]) / size
        look_from(scene, str(degrees), [0.3, 0, 0.1], direction)
        claims.append(Claim(str(degrees), 100 * (1 - 0.8 * sum(fresnel(cos_i, 1.5)) / 2)))
    return Case("a lamp under a leaning coat", scene, claims, ["--max-bounces", "0"])


def spot_light():
    scene = floor_scene()
    scene.light("spot", 1000, [0, 3, 0], FACING_DOWN,
                spot={"innerConeAngle": math.radians(20), "outerConeAngle": math.radians(30)})
    claims = []
    for name, x in (("axis", 0), ("inner", 0.9), ("outside", 1.8)):
        look_from(scene, name, [x, 0, 0], [0, 1, 0])
        claims.append(Claim(name, 0 if name == "outside"
                            else shown(3000 / (9 + x * x) ** 1.5)))
    return Case("spot light of 1000 cd at 3 m", scene, claims)


def directional_light(degrees):
    scene = floor_scene()
    scene.light("directional", 1000, direction=[-x for x in tilted(degrees)])
    look_from(scene, "floor", [0, 0, 0], [0, 1, 0])
    return Case(f"directional light of 1000 lx at {degrees} degrees", scene,
                [Claim("floor", shown(1000 * math.cos(math.radians(degrees))))])


def one_sided():
    """Without doubleSided a back is seen and reflects as the front does; it emits nothing."""
    scene = Scene()
    sheet = scene.lambert(RHO, 7, double_sided=False)
    scene.quad(sheet, [-50, 0, 50], [100, 0, 0], [0, 0, -100])
    scene.light("directional", 1000, direction=[0, 1, 0])
    look_from(scene, "front", [0, 0, 0], [0, 1, 0])
    look_from(scene, "back", [0, 0, 0], [0, -1, 0])
    return Case("a one-sided sheet, lit from behind", scene,
                [Claim("front", 7), Claim("back", shown(1000))])


def coloured_light():
    scene = floor_scene()
    scene.light("point", 1000, [0, 3, 0], color=[1, 0.5, 0.25])
    look_from(scene, "floor", [0, 0, 0], [0, 1, 0])
    luminance = 0.2126 + 0.5 * 0.7152 + 0.25 * 0.0722
    return Case("a light's colour multiplies its intensity", scene,
                [Claim("floor", shown(luminance * 1000 / 9))])


def sun(elevation):
    scene = floor_scene()
    scene.environment(type="constant", luminance=0, sun={
        "azimuth_deg": 130, "elevation_deg": elevation, "illuminance_lx": 90000})
    look_from(scene, "floor", [0, 0, 0], [0, 1, 0])
    return Case(f"a plane under the sun at {elevation} degrees", scene,
                [Claim("floor", shown(90000 * math.sin(math.radians(elevation))))])


def sun_direction():
    """Azimuth runs from north (-Z) over east (+X)."""
    scene = Scene()
    white = scene.lambert(RHO)
    walls = (("east", [1, 0, 0], [5, 0, 0]), ("north", [0, 0, -1], [0, 0, 5]),
             ("west", [-1, 0, 0], [-5, 0, 0]))
    for name, normal, centre in walls:
        scene.facing_quad(white, centre, normal, 1)
        look_from(scene, name, centre, normal)
    scene.environment(type="constant", luminance=0, sun={
        "azimuth_deg": 60, "elevation_deg": 0, "illuminance_lx": 90000})
    return Case("the sun stands where its azimuth says", scene, [
        Claim("east", shown(90000 * math.cos(math.radians(30)))),
        Claim("north", shown(90000 * math.cos(math.radians(60)))), Claim("west", 0)],
        ["--max-bounces", "1"])


def half_sun():
    """An edge through the sun's centre takes half of it."""
    scene = floor_scene()
    scene.environment(type="constant", luminance=0, sun={
        "azimuth_deg": 0, "elevation_deg": 40, "illuminance_lx": 90000})
    scene.quad(scene.lambert(0), [0, 0.5, -10], [0, 20, 0], [20, 0, 0])
    scene.probe("floor", [0, 0.05, 0], [0, -1, 0], 0.0005)
    return Case("half the sun behind an edge", scene, [
        Claim("floor", shown(90000 * math.sin(math.radians(40)) / 2))],
        ["--max-bounces", "1"], size=(32, 32), samples=1200)


def area_light_above():
    """Configuration factors of CIE 171 5.6: a 4 x 4 m floor of 1000 cd/m2."""
    scene, claims = Scene(), []
    scene.quad(scene.emitter(1000), [-2, 0, 2], [4, 0, 0], [0, 0, -4])
    white = scene.lambert(RHO)
    for y in (0.25, 0.75, 1.25, 1.75):
        scene.facing_quad(white, [0, 3, y - 2], FACING_DOWN, 0.02)
        look_from(scene, f"ceiling {y}", [0, 3, y - 2], [0, -1, 0])
        factor = 2 * (parallel_corner(2, y, 3) + parallel_corner(2, 4 - y, 3))
        claims.append(Claim(f"ceiling {y}", RHO * 1000 * factor))
    for z in (0.75, 1.25, 1.75, 2.25, 2.75):
        scene.facing_quad(white, [0, z, -2], [0, 0, 1], 0.02)
        look_from(scene, f"wall {z}", [0, z, -2], [0, 0, 1])
        claims.append(Claim(f"wall {z}", RHO * 1000 * 2 * perpendicular_corner(4, 2, z)))
    return Case("CIE 171 5.6, a floor that shines", scene, claims, ["--max-bounces", "1"],
                samples=256)


def lit_floor():
    """CIE 171 5.6 itself: the floor reflects 0.3 of 1000 lx that fall on it."""
    scene, claims = Scene(), []
    scene.quad(scene.lambert(0.3), [-2, 0, 2], [4, 0, 0], [0, 0, -4])
    scene.light("directional", 1000)
    white = scene.lambert(RHO)
    for y in (0.25, 1.25):
        scene.facing_quad(white, [0, 3, y - 2], FACING_DOWN, 0.02)
        look_from(scene, f"ceiling {y}", [0, 3, y - 2], [0, -1, 0])
        factor = 2 * (parallel_corner(2, y, 3) + parallel_corner(2, 4 - y, 3))
        claims.append(Claim(f"ceiling {y}", shown(0.3 * 1000 * factor)))
    return Case("CIE 171 5.6, a floor that reflects", scene, claims, ["--max-bounces", "2"],
                samples=4800)


def environment():
    scene = floor_scene()
    scene.environment(type="constant", luminance=1000, color=[1, 0.5, 0.25])
    look_from(scene, "floor", [0, 0, 0], [0, 1, 0])
    scene.probe("sky", [0, 5, 0], [0, 1, 0], 0.1)
    return Case("a constant environment of 1000 cd/m2", scene,
                [Claim("floor", RHO * 1000), Claim("sky", 1000)])


def heading():
    """A vehicle that heads east has the east before it: at -Z, its forward direction."""
    scene = Scene()
    white = scene.lambert(RHO)
    walls = (("ahead", [0, 0, -1], [0, 0, 5]), ("left", [-1, 0, 0], [5, 0, 0]))
    for name, normal, centre in walls:
        scene.facing_quad(white, centre, normal, 1)
        look_from(scene, name, centre, normal)
    scene.environment(type="constant", luminance=0, heading_deg=90, sun={
        "azimuth_deg": 60, "elevation_deg": 0, "illuminance_lx": 90000})
    return Case("the heading turns the sky, not the scene", scene, [
        Claim("ahead", shown(90000 * math.cos(math.radians(30)))),
        Claim("left", shown(90000 * math.cos(math.radians(60))))], ["--max-bounces", "1"])


def six_sides(u, v):
    """Another power of two in each direction of the axes, code 128 with another exponent; the
    centre of the picture is +Z, +X is on its left."""
    if v < 0.25 or v > 0.75:
        return 64 if v < 0.25 else 2
    return (8, 16, 32, 4)[int(4 * u + 0.5) % 4]


def hdri_sides():
    scene = Scene()
    scene.files["sides.hdr"] = radiance_picture(64, 32, six_sides)
    scene.environment(type="hdri", uri="sides.hdr", scale=10)
    sides = {"up": ([0, 1, 0], 64), "down": ([0, -1, 0], 2), "+x": ([1, 0, 0], 16),
             "+z": ([0, 0, 1], 32), "-x": ([-1, 0, 0], 4), "-z": ([0, 0, -1], 8)}
    for name, (direction, _) in sides.items():
        scene.view(name, [0, 0, 0], direction, 10)
    return Case("a picture of the surroundings lies the right way round", scene,
                [Claim(name, 1790 * value * 128.5 / 128) for name, (_, value) in sides.items()])


def hdri_illuminance():
    scene = floor_scene()
    scene.files["grey.hdr"] = radiance_picture(32, 16, lambda u, v: 0.5)
    scene.environment(type="hdri", uri="grey.hdr", horizontal_illuminance_lx=15000)
    look_from(scene, "floor", [0, 0, 0], [0, 1, 0])
    scene.probe("sky", [0, 5, 0], [0.3, 1, 0], 0.1)
    return Case("a picture scaled to 15000 lx gives them", scene,
                [Claim("floor", shown(15000)), Claim("sky", 15000 / math.pi)])


# ---- surfaces ------------------------------------------------------------------------------

def units():
    """What glTF gives in cd/m2 is seen as that."""
    scene = Scene()
    unlit = scene.material(extensions={"KHR_materials_unlit": {}},
                           pbrMetallicRoughness={"baseColorFactor": [0.25, 0.25, 0.25, 1]})
    makers = [("emissive 250 cd/m2", scene.emitter(250), 250),
              ("red", scene.emitter(100, (1, 0, 0)), 21.26),
              ("green", scene.emitter(100, (0, 1, 0)), 71.52),
              ("blue", scene.emitter(100, (0, 0, 1)), 7.22), ("unlit", unlit, 0.25)]
    claims = []
    for i, (name, material, luminance) in enumerate(makers):
        scene.facing_quad(material, [3 * i, 0, 0], [0, 0, 1], 1)
        look_from(scene, name, [3 * i, 0, 0], [0, 0, 1])
        claims.append(Claim(name, luminance))
    look_from(scene, "back", [0, 0, 0], [0, 0, -1])
    return Case("emission is seen in cd/m2, from the front only", scene,
                claims + [Claim("back", 0)])


def texture():
    """Base colour is sRGB-coded: 188 is a reflectance of 0.5029."""
    scene = Scene()
    picture = scene.image("image/png", png(1, 1, [[188, 188, 188]]))
    material = scene.material(
        pbrMetallicRoughness={"baseColorTexture": {"index": picture}, "metallicFactor": 0},
        extensions={"KHR_materials_specular": {"specularFactor": 0}})
    scene.quad(material, [-50, 0, 50], [100, 0, 0], [0, 0, -100])
    scene.light("directional", 1000)
    look_from(scene, "floor", [0, 0, 0], [0, 1, 0])
    reflectance = ((188 / 255 + 0.055) / 1.055) ** 2.4
    return Case("a texture's code becomes a reflectance", scene,
                [Claim("floor", shown(1000, reflectance))])


def mirror(degrees, roughness=0):
    """A metal's Schlick reflectance in a uniform environment."""
    scene = Scene()
    scene.quad(scene.metal(0.5, roughness), [-50, 0, 50], [100, 0, 0], [0, 0, -100])
    scene.environment(type="constant", luminance=100)
    look_from(scene, "mirror", [0, 0, 0], tilted(degrees), distance=1)
    reflectance = 0.5 + 0.5 * (1 - math.cos(math.radians(degrees))) ** 5
    return Case(f"mirror at {degrees} degrees", scene, [Claim("mirror", 100 * reflectance)])


def mirror_direction(degrees):
    """A lamp of 1.1 degrees is seen in the mirror exactly where it should be, turned off the
    plane of the axes so that no sign can hide."""
    scene = Scene()
    scene.quad(scene.metal(1), [-50, 0, 50], [100, 0, 0], [0, 0, -100])
    s, c = math.sin(math.radians(degrees)), math.cos(math.radians(degrees))
    away = [s * 0.8, c, s * 0.6]
    scene.facing_quad(scene.emitter(100), [5 * x for x in away], [-x for x in away], 0.1)
    look_from(scene, "mirror", [0, 0, 0], [-away[0], away[1], -away[2]], distance=1)
    return Case(f"a lamp in the mirror at {degrees} degrees", scene, [Claim("mirror", 100)])


def window(degrees, is_mirrored):
    """A thin pane before a lamp, or the lamp's mirror image in it."""
    scene = Scene()
    scene.quad(scene.window(1.52), [-50, 0, 50], [100, 0, 0], [0, 0, -100])
    direction = tilted(degrees)
    scene.facing_quad(scene.emitter(100), [-5 * x for x in direction], direction, 0.5)
    transmittance = pane_transmittance(math.cos(math.radians(degrees)), 1.52)
    if is_mirrored:
        look_from(scene, "mirrored", [0, 0, 0], [direction[0], -direction[1], 0], distance=1)
        return Case(f"a lamp in a pane of glass at {degrees} degrees", scene,
                    [Claim("mirrored", 100 * (1 - transmittance))], samples=4096,
                    is_quick=degrees > 65)
    look_from(scene, "through", [0, 0, 0], direction, distance=1)
    return Case(f"a lamp behind a pane of glass at {degrees} degrees", scene,
                [Claim("through", 100 * transmittance)], samples=1024)


def solid_slab(degrees):
    """Plane-parallel glass of 10 cm that takes half the light a 20 cm: either polarisation by
    itself, all inner reflections, geometric series."""
    scene = Scene()
    scene.box_outside(scene.glass(1.52, ([0.5, 0.5, 0.5], 0.2)), [-50, -0.1, -50], [50, 0, 50])
    direction = tilted(degrees)
    scene.facing_quad(scene.emitter(100), [-5 * x for x in direction], direction, 4)
    look_from(scene, "through", [0.1, 0, 0.3], direction, distance=1)
    cos_i = math.cos(math.radians(degrees))
    length = 0.1 / math.sqrt(1 - (1 - cos_i * cos_i) / 1.52 ** 2)
    inside = 0.5 ** (length / 0.2)
    shown_through = 100 * sum((1 - r) ** 2 * inside / (1 - (r * inside) ** 2)
                              for r in fresnel(cos_i, 1.52)) / 2
    return Case(f"solid glass at {degrees} degrees", scene, [Claim("through", shown_through)],
                samples=1024)


def light_through_window(degrees):
    scene = floor_scene()
    scene.quad(scene.window(1.52, (0.8, 0.8, 0.8)), [-50, 1, 50], [100, 0, 0], [0, 0, -100])
    scene.light("directional", 1000, direction=[-x for x in tilted(degrees)])
    look_from(scene, "floor", [0.1, 0, 0.3], [0, 1, 0])  # beside the diagonal of the pane
    cos_i = math.cos(math.radians(degrees))
    lux = 1000 * cos_i * tinted_pane(cos_i, 1.52, 0.8)[1]
    return Case(f"light through tinted glass at {degrees} degrees", scene,
                [Claim("floor", shown(lux))], ["--max-bounces", "1"])


def alpha():
    scene = Scene()
    scene.quad(scene.emitter(100), [-5, -5, 0], [10, 0, 0], [0, 10, 0])
    black = {"baseColorFactor": [0, 0, 0, 0.3], "metallicFactor": 0}
    matte = {"KHR_materials_specular": {"specularFactor": 0}}
    kinds = [("blend", 70, {"alphaMode": "BLEND"}),
             ("cut away", 100, {"alphaMode": "MASK", "alphaCutoff": 0.31}),
             ("kept", 0, {"alphaMode": "MASK", "alphaCutoff": 0.29})]
    claims = []
    for i, (name, luminance, members) in enumerate(kinds):
        pane = scene.material(pbrMetallicRoughness=black, extensions=matte, **members)
        scene.facing_quad(pane, [2 * i - 2, 0, 1], [0, 0, 1], 1)
        look_from(scene, name, [2 * i - 2, 0, 1], [0, 0, 1])
        claims.append(Claim(name, luminance))
    return Case("alpha covers, or cuts", scene, claims, samples=1024)


# ---- camera --------------------------------------------------------------------------------

def picture():
    """Four lamps, one a quarter of the view: nothing is mirrored, and yfov is the height."""
    scene = Scene()
    for luminance, x, y in ((10, -1, 1), (20, 1, 1), (30, -1, -1), (40, 1, -1)):
        scene.facing_quad(scene.emitter(luminance), [x, y, -2], [0, 0, 1], 2)
    scene.view("view", [0, 0, 0], [0, 0, -1], 90)
    scene.probe("parallel", [0, 0, 0], [0, 0, -1], 4)
    quarters = [Claim("view", luminance, region) for luminance, region in (
        (10, (0, 0, 8, 8)), (20, (8, 0, 16, 8)), (30, (0, 8, 8, 16)), (40, (8, 8, 16, 16)))]
    parallel = [Claim("parallel", 0, (0, 0, 16, 4)), Claim("parallel", 20, (8, 4, 12, 8)),
                Claim("parallel", 30, (4, 8, 8, 12)), Claim("parallel", 0, (12, 0, 16, 16))]
    return Case("the picture is upright and as wide as yfov says", scene, quarters + parallel)


ANGLES = (0, 15, 30, 45, 60, 70, 75, 80, 85)


def quarter_wave(scene, transmission, colour):
    """Glass with a quarter wave of n 1.38 (layers.py)."""
    return scene.material(
        pbrMetallicRoughness={"baseColorFactor": [colour] * 3 + [1], "metallicFactor": 0,
                              "roughnessFactor": 0}, doubleSided=True,
        extensions={"KHR_materials_transmission": {"transmissionFactor": transmission},
                    "KHR_materials_ior": {"ior": layers.GLASS},
                    "PARHELION_coating": {"layers": [{"n": layers.FILM, "k": 0,
                                                      "thickness_nm": layers.FILM_NM}]}})


def coated_glass(degrees):
    """Black glass with a quarter wave on it, in a uniform environment."""
    scene = Scene()
    scene.quad(quarter_wave(scene, 0, 0), [-50, 0, 50], [100, 0, 0], [0, 0, -100])
    scene.environment(type="constant", luminance=100)
    look_from(scene, "face", [0, 0, 0], tilted(degrees), distance=1)
    reflectance = layers.coated_face(math.cos(math.radians(degrees)))
    return Case(f"coated black glass at {degrees} degrees", scene,
                [Claim("face", 100 * reflectance)])


def coated_window(degrees):
    """A lamp behind a pane with a quarter wave on both faces."""
    scene = Scene()
    scene.quad(quarter_wave(scene, 1, 1), [-50, 0, 50], [100, 0, 0], [0, 0, -100])
    direction = tilted(degrees)
    scene.facing_quad(scene.emitter(100), [-5 * x for x in direction], direction, 0.5)
    look_from(scene, "through", [0, 0, 0], direction, distance=1)
    transmittance = layers.coated_pane(math.cos(math.radians(degrees)))
    return Case(f"a lamp behind a coated pane at {degrees} degrees", scene,
                [Claim("through", 100 * transmittance)], samples=1024)


def measured_metal(degrees):
    """A metal of n + ik = 1.0 + 6.7i, about aluminium's at 555 nm, in a uniform environment."""
    scene = Scene()
    scene.files["metal.csv"] = b"nm,n,k\n360,1.0,6.7\n830,1.0,6.7\n"
    bright = scene.material(pbrMetallicRoughness={"metallicFactor": 1, "roughnessFactor": 0},
                            extensions={"PARHELION_spectrum": {"conductor": "metal.csv"}})
    scene.quad(bright, [-50, 0, 50], [100, 0, 0], [0, 0, -100])
    scene.environment(type="constant", luminance=100)
    look_from(scene, "metal", [0, 0, 0], tilted(degrees), distance=1)
    reflectance = layers.metal(math.cos(math.radians(degrees)), 1.0 + 6.7j)
    return Case(f"a measured metal at {degrees} degrees", scene,
                [Claim("metal", 100 * reflectance)])


def all_cases(whole):
    """whole: learning where light comes from, which makes an even wall noisier,
    in the brightest cube and furnace too."""
    unguided = [] if whole else ["--no-guiding"]
    bright = (256 if whole else 200, unguided)
    cases = [furnace_sphere(), furnace_bright(*unguided), furnace_outside(), cube(0.5),
             cube(0.9, True, *bright), cube(0.05, False), cube(0.95, False), flux(),
             point_light(), small_lambertian_source(), spot_light(), coloured_light(),
             one_sided(), sun(10), sun(35), sun(90), sun_direction(), half_sun(),
             area_light_above(), lit_floor(), environment(), heading(), hdri_sides(),
             hdri_illuminance(), units(), texture(), alpha(), picture()]
    cases += [directional_light(angle) for angle in (0, 30, 60, 85)]
    cases += [mirror(angle) for angle in ANGLES]
    cases += [mirror_direction(angle) for angle in ANGLES[1:]]
    cases += [window(angle, False) for angle in ANGLES[:-1]]
    cases += [window(angle, True) for angle in ANGLES[:-1]]
    cases += [coated_glass(angle) for angle in (0, 45, 70)]
    cases += [coated_window(angle) for angle in (0, 60)]
    cases += [measured_metal(angle) for angle in (0, 60, 80)]
    cases += [solid_slab(angle) for angle in (0, 45, 70)]
    cases += [light_through_window(angle) for angle in ANGLES[:-1]]
    cases += [lacquered_lamp(coat, angle)
              for coat, angle in ((1, 0), (1, 60), (0.5, 75), (1, 75))]
    cases.append(tilted_coat())
    return cases
