"""lamps.py PARHELION -- luminaire files as lamps of a scene (--light): illuminances in closed
form, flux, nodes that are turned, scaled and mirrored, and what is refused.
"""
import json
import math
import os
import subprocess
import sys
import tempfile

from gltf import Scene

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
SHARED = os.path.join(ROOT, "..", "shared", "data", "photometry")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

GAMMAS = (0, 30, 60, 90, 120, 150, 180)
PLANES = (0, 90, 180, 270, 360)
# candela, another one in each direction; what meets at a pole is one value
TABLE = [[400, 300 + 10 * c, 200 - 30 * c, 150 + 5 * c, 90 - 7 * c, 40 + 3 * c, 25]
         for c in (0, 1, 2, 3, 0)]
NODES = {
    "plain": {"translation": [0, 0, 0]},
    "moved": {"translation": [1, -2, 0.5]},
    "down": {"rotation": [-math.sqrt(0.5), 0, 0, math.sqrt(0.5)]},
    "turned": {"translation": [0, 1, 0], "rotation": [0.5, 0.5, -0.5, 0.5]},
    "scaled": {"translation": [0, 1, 0], "scale": [2, 5, 0.25]},
    "mirrored": {"scale": [-1, 1, 1]},
    "both": {"translation": [0.3, 0, 0], "rotation": [0.5, -0.5, 0.5, 0.5],
             "scale": [3, -2, 1]},
}
# the flux that the files state, lm
SHARED_FLUX = {"Indoor_60W_5300lm.ies": 5300, "MAXWELL_measured_IESNA.ies": 1000,
               "FL_MAX_900W_SYM60.ldt": 119760, "road_luminaire.ldt": 28027.4}


def ies(table=None, gammas=GAMMAS, planes=PLANES, head="1 -1 1", factors="1 1 30"):
    table = table or TABLE
    rows = "\n".join(" ".join(f"{v:g}" for v in row) for row in table)
    return (f"IESNA:LM-63-2002\n[TEST] none\n[MANUFAC] none\nTILT=NONE\n"
            f"{head} {len(gammas)} {len(planes)} 1 2 0 0 0\n{factors}\n"
            f"{' '.join(map(str, gammas))}\n{' '.join(map(str, planes))}\n{rows}\n")


def ldt(flux, factor=1):
    """The same table in cd a klm: four planes, no symmetry."""
    head = ["maker", "1", "0", "4", "90", "7", "30", "report", "lamp", "1", "a.ldt", "today",
            "100", "0", "50", "0", "0", "0", "0", "0", "0", "100", "100", str(factor), "0", "1",
            "1", "LED", str(flux), "4000", "80", "30"] + ["0"] * 10
    values = [f"{v / (flux / 1000) / factor:.9g}" for row in TABLE[:4] for v in row]
    return "\r\n".join(head + ["0", "90", "180", "270", *map(str, GAMMAS), *values]) + "\r\n"


def rotated(q, v):
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


def axes(node):
    signs = [math.copysign(1, s) for s in node.get("scale", (1, 1, 1))]
    q = node.get("rotation", (0, 0, 0, 1))
    return [[s * v for v in rotated(q, unit)]
            for s, unit in zip(signs, ((1, 0, 0), (0, 1, 0), (0, 0, 1)))]


def intensity(local):
    """Of TABLE, bilinear, by the angles of a unit direction in the lamp's frame."""
    gamma = math.degrees(math.acos(max(-1, min(1, -local[2]))))
    c = math.degrees(math.atan2(local[1], local[0])) % 360
    i, k = min(int(c / 90), 3), min(int(gamma / 30), 5)
    s, t = c / 90 - i, gamma / 30 - k
    low, high = TABLE[i], TABLE[i + 1]
    return ((1 - s) * ((1 - t) * low[k] + t * low[k + 1])
            + s * ((1 - t) * high[k] + t * high[k + 1]))


def expected(node, place, normal):
    origin = node.get("translation", (0, 0, 0))
    away = [p - o for p, o in zip(place, origin)]
    distance = math.sqrt(sum(v * v for v in away))
    unit = [v / distance for v in away]
    local = [sum(a * u for a, u in zip(axis, unit)) for axis in axes(node)]
    cosine = max(0, -sum(n * u for n, u in zip(normal, unit)))
    return intensity(local) * cosine / distance ** 2


class Lamps:
    def __init__(self, program, folder):
        self.program, self.folder = os.path.abspath(program), folder
        self.write("lamp.ies", ies())
        self.write("lamp.ldt", ldt(2500))
        scene = Scene()
        for name, node in NODES.items():
            scene._node({"name": name, **node})
        scene.write(self.path("nodes.gltf"))

    def path(self, name):
        return os.path.join(self.folder, name)

    def write(self, name, text):
        with open(self.path(name), "w", encoding="utf-8", newline="") as file:
            file.write(text)

    def run(self, *line):
        return subprocess.run([self.program, *line], cwd=self.folder, capture_output=True,
                              text=True, check=False)

    def lux(self, scene, place, normal, *options):
        done = self.run("measure", scene, "--illuminance",
                        ",".join(f"{x:.9g}" for x in (*place, *normal)), "--samples", "64",
                        "--json", "--quiet", *options)
        assert done.returncode == 0, done.stderr
        return json.loads(done.stdout)["illuminance_lx"]

    def claim(self, report, what, found, wanted):
        report.claim(abs(found - wanted) <= 1e-3 * wanted + 1e-6,
                     f"{what}: {found:.6g} lx instead of {wanted:.6g}")


PLACES = (((0, 0, -2), (0, 0, 1)), ((1.5, 0, 0), (-1, 0, 0)), ((0, 3, 0), (0, -1, 0)),
          ((-1, -1, -1), (0.6, 0, 0.8)), ((0.2, -0.9, 1.3), (0, 0.8, -0.6)))


def check_nodes(report, lamps):
    for name, node in NODES.items():
        for offset, normal in PLACES:
            place = [o + d for o, d in zip(node.get("translation", (0, 0, 0)), offset)]
            for file in ("lamp.ies", "lamp.ldt")[:2 if name == "both" else 1]:
                found = lamps.lux("nodes.gltf", place, normal, "--light", f"{name}={file}")
                lamps.claim(report, f"{name} {offset} {file}", found,
                            expected(node, place, normal))


def check_factors(report, lamps):
    """Straight below: 400 cd from 2 m is 100 lx; multiplier, ballast, level; node: as well."""
    below = ((0, 0, -2), (0, 0, 1))
    lamps.write("twice.ies", ies(head="1 1000 2", factors="0.9 0.5 30"))
    lamps.write("factor.ldt", ldt(800, 2))
    for options, wanted in ((("--light", "plain=lamp.ies"), 100),
                            (("--light", "node:plain=lamp.ies"), 100),
                            (("--light", "plain=twice.ies"), 90),
                            (("--light", "plain=factor.ldt"), 100),
                            (("--light", "plain=lamp.ies", "--light-level", "plain=25"), 25),
                            (("--light", "plain=lamp.ies", "--light-level", "*=300%"), 300),
                            (("--light", "plain=lamp.ies", "--light-level", "plain=0"), 0),
                            (("--light", "plain=twice.ies", "--light", "plain=lamp.ies"), 100)):
        found = lamps.lux("nodes.gltf", *below, *options)
        lamps.claim(report, " ".join(options), found, wanted)


def check_flux(report, lamps):
    """The illuminance on a sphere around a lamp adds up to its flux, and to what check says."""
    gammas = list(range(0, 91, 5))
    lamps.write("lambert.ies", ies([[100 * math.cos(math.radians(g)) for g in gammas]], gammas,
                                   (0,)))
    rings, flux = 16, 0.0
    for i in range(rings):
        z = -1 + (2 * i + 1) / rings
        r = math.sqrt(1 - z * z)
        flux += 4 * math.pi / rings * lamps.lux("nodes.gltf", (r, 0, z), (-r, 0, -z), "--light",
                                                "plain=lambert.ies")
    report.claim(abs(flux / (100 * math.pi) - 1) < 5e-3, f"{flux} lm of 100 pi")
    done = lamps.run("check", "nodes.gltf", "--json", "--light", "turned=lambert.ies")
    lamp, = json.loads(done.stdout)["lights"]
    report.claim(abs(lamp["flux_lm"] / (100 * math.pi) - 1) < 2e-3 and lamp["max_cd"] == 100
                 and lamp["type"] == "luminaire" and lamp["name"] == "turned",
                 f"check: {lamp}")
    down = [-v for v in axes(NODES["turned"])[2]]
    report.claim(all(abs(a - b) < 1e-6 for a, b in zip(lamp["direction"], down)),
                 f"check: direction {lamp['direction']} instead of {down}")


def check_shadow(report, lamps):
    """A plate between lamp and head; and a lamp in place of KHR_lights_punctual's."""
    scene = Scene()
    scene._node({"name": "lamp", "translation": [0, 0, 0]})
    plate = scene.material("plate", pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1]})
    scene.quad(plate, [-0.5, -0.5, -1], [1, 0, 0], [0, 1, 0])
    scene.write(lamps.path("plate.gltf"))
    for place, is_lit in (((0, 0, -2), False), ((3, 0, -2), True)):
        found = lamps.lux("plate.gltf", place, (0, 0, 1), "--light", "lamp=lamp.ies")
        report.claim((found > 1) == is_lit, f"behind a plate at {place}: {found} lx")


def check_refused(report, lamps):
    lamps.write("word.ies", ies().replace("400 300", "400 bright", 1))
    lamps.write("short.ies", ies()[:-30])
    lamps.write("dark.ies", ies([[0] * 7] * 5))
    lamps.write("short.ldt", ldt(1000)[:120])
    for options, words in (
            (("--light", "porch=lamp.ies"), ('no node is named "porch"', '"plain"', '"both"')),
            (("--light", "plain=none.ies"), ("none.ies",)),
            (("--light", "plain=word.ies"), ("word.ies", "line 9", "bright")),
            (("--light", "plain=short.ies"), ("short.ies", "the file ends before")),
            (("--light", "plain=dark.ies"), ("dark.ies", "above 0 cd")),
            (("--light", "plain=short.ldt"), ("short.ldt", "the file ends before")),
            (("--light", "plain=lamp.ies", "--light-level", "plain=x"), ("--light-level", "x")),
            (("--light", "plain=lamp.ies", "--light-level", "moved=5"), ("moved", '"plain"'))):
        done = lamps.run("measure", "nodes.gltf", "--illuminance", "0,0,0,0,1,0", *options)
        report.claim(done.returncode == 3 and all(w in done.stderr for w in words)
                     and done.stderr.count("\n") == 1,
                     f"{options}: {done.returncode} {done.stderr}")
    done = lamps.run("measure", "nodes.gltf", "--illuminance", "0,0,0,0,1,0", "--light",
                     "plain")
    report.claim(done.returncode == 2, f"no file: {done.returncode} {done.stderr}")


def check_shared(report, lamps):
    if not os.path.isdir(SHARED):
        print("skipped: no ../shared/data/photometry")
        return
    for name, flux in SHARED_FLUX.items():
        done = lamps.run("check", "nodes.gltf", "--json", "--light",
                         f"plain={os.path.join(SHARED, name)}")
        lamp, = json.loads(done.stdout)["lights"]
        report.claim(abs(lamp["flux_lm"] / flux - 1) < 5e-3, f"{name}: {lamp}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        lamps = Lamps(sys.argv[-1], folder)
        for check in (check_nodes, check_factors, check_flux, check_shadow, check_refused,
                      check_shared):
            try:
                check(report, lamps)
            except AssertionError as error:
                report.claim(False, f"{check.__name__}: {error}")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
