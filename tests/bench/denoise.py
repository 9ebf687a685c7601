# SPDX-License-Identifier: Apache-2.0
"""denoise.py [--only NAME] [--size WxH] [--crop X0,Y0,X1,Y1] [--reference N] [--keep DIR]
PARHELION -- how close pictures of 4 and 24 samples come to one of many, denoised and not: FLIP
and the share of pixels whose L* is off by more than 3, on the views and lights that ship; then
the light of the denoised picture by that of the frame, and what the worst block of 64x64 pixels
gained or lost.

All pictures of a view have the exposure of its reference. The reference is of another seed; it
has noise of its own, which counts in every column alike. Frames are kept in DIR (default:
.build/denoise) and taken from there the next time: after a change of the tracer empty it. What
is measured is `develop`, of the program that is given.
"""
import argparse
import json
import os
import struct
import subprocess
import zlib

HERE = os.path.dirname(os.path.abspath(__file__))
ROOT = os.path.normpath(os.path.join(HERE, "..", ".."))
CAR, DECK = "car_dashboard.gltf", "cockpit.gltf"
LIGHTS = {  # of a scene: the file and how bright the displays are set
    CAR: {"noon": ("noon.gltf", 100), "night": ("night.gltf", 4)},
    DECK: {"low_sun": ("low_sun_left.gltf", 100), "dusk": ("dusk.gltf", 6),
           "cloud": ("cloud_noon.gltf", 100), "night": ("flight_night.gltf", 1)},
}
CAMERAS = {CAR: ["driver-eye", "passenger-eye", "outside"],
           DECK: ["captain", "pfd", "first_officer", "wide"]}
FEW = (4, 24)


def views():
    """Every camera under every light, the first camera of both scenes first."""
    for rank in range(4):
        for scene, cameras in CAMERAS.items():
            for light, (file, level) in LIGHTS[scene].items():
                if rank < len(cameras):
                    yield (f"{cameras[rank]} {light}",
                           [os.path.join(ROOT, "scenes", scene),
                            os.path.join(ROOT, "scenes", file), "--camera", cameras[rank],
                            "--display-level", f"*={level}"])


def run(words):
    done = subprocess.run(words, capture_output=True, text=True)
    if not done.stdout.startswith("{"):
        raise SystemExit(done.stdout + done.stderr)
    return json.loads(done.stdout)


def rows_of_png(path):
    """Rows of R, G, B bytes of a picture that `develop` wrote: 8 bits, not interlaced."""
    with open(path, "rb") as file:
        data, at, packed = file.read(), 8, b""
    while at < len(data):
        size, kind = struct.unpack(">I4s", data[at:at + 8])
        body = data[at + 8:at + 8 + size]
        if kind == b"IHDR":
            width, height, bits, colours, _, _, interlaced = struct.unpack(">IIBBBBB", body)
            assert (bits, interlaced) == (8, 0) and colours in (2, 6), path
            step = 3 if colours == 2 else 4
        packed += body if kind == b"IDAT" else b""
        at += 12 + size
    raw, above, stride = zlib.decompress(packed), bytes(width * step), width * step + 1
    for y in range(height):
        kind, row = raw[y * stride], bytearray(raw[y * stride + 1:(y + 1) * stride])
        for i in range(len(row)):
            left, corner = (row[i - step], above[i - step]) if i >= step else (0, 0)
            guess = left + above[i] - corner
            nearest = min((abs(guess - v), k, v) for k, v in
                          enumerate((left, above[i], corner)))[2]
            row[i] = row[i] + (0, left, above[i], (left + above[i]) // 2, nearest)[kind] & 255
        yield row[0::step], row[1::step], row[2::step]
        above = row


LINEAR = [v / 12.92 if v <= 0.04045 else ((v + 0.055) / 1.055) ** 2.4
          for v in (k / 255 for k in range(256))]


def lightness(path):
    """CIE L* of each pixel of a picture in sRGB."""
    out = []
    for red, green, blue in rows_of_png(path):
        for r, g, b in zip(red, green, blue):
            y = 0.2126 * LINEAR[r] + 0.7152 * LINEAR[g] + 0.0722 * LINEAR[b]
            out.append(116 * y ** (1 / 3) - 16 if y > 216 / 24389 else 24389 / 27 * y)
    return out


class Bench:
    def __init__(self, arguments):
        self.program, self.keep = os.path.abspath(arguments.program), arguments.keep
        self.size, self.reference = arguments.size, arguments.reference
        self.crop = arguments.crop
        width, height = (int(side) for side in self.size.split("x"))
        x0, y0, x1, y1 = (int(side) for side in self.crop.split(","))
        self.outside = width * height / ((x1 - x0) * (y1 - y0))  # what is black in both

    def path(self, view, name):
        return os.path.join(self.keep, f"{view.replace(' ', '_')}.{name}")

    def frame(self, view, words, samples, seed):
        out = self.path(view, f"{self.size}.{samples}.exr")
        if not os.path.exists(out):
            run([self.program, "render", *words, "--size", self.size, "--crop", self.crop,
                 "--spp", str(samples), "--seed", str(seed), "--layers", "all",
                 "-o", out, "--quiet", "--json"])
        return out

    def develop(self, view, frame, name, *words):
        picture = self.path(view, f"{name}.png")
        answer = run([self.program, "develop", frame, "-o", picture, "--json", *words])
        return picture, answer

    def flip(self, reference, picture):
        answer = run([self.program, "compare", reference, picture, "--metric", "flip", "--json",
                      "--quiet"])
        return answer["metrics"]["flip"] * self.outside

    def off(self, reference, picture):
        """Share of pixels off by more than 3 in L*; what was not rendered is black in both."""
        pairs = list(zip(lightness(reference), lightness(picture)))
        return sum(abs(a - b) > 3 for a, b in pairs) / len(pairs) * self.outside

    def row(self, view, words):
        wanted, answer = self.develop(view, self.frame(view, words, self.reference, 1), "many",
                                      "--adapt", "none")
        exposure = f"--exposure={answer['exposure_ev']:.6f}"
        figures, energies = [], []
        for samples in FEW:
            frame = self.frame(view, words, samples, 0)
            noisy, _ = self.develop(view, frame, f"noisy{samples}", exposure)
            clean, answer = self.develop(view, frame, f"clean{samples}", exposure, "--denoise")
            figures += [self.flip(wanted, noisy), self.flip(wanted, clean),
                        self.off(wanted, noisy), self.off(wanted, clean)]
            energies += [answer["denoised"]["energy_ratio"], answer["denoised"]["block_error"]]
        print(f"| {view} | " + " | ".join(f"{f:.4f}" for f in figures) + " | " +
              " | ".join(f"{energy:.4f}" for energy in energies) + " |", flush=True)
        return figures


def main():
    parser = argparse.ArgumentParser()
    parser.add_argument("--only", default="")
    parser.add_argument("--size", default="480x270")
    parser.add_argument("--crop", default="144,100,336,208")
    parser.add_argument("--reference", type=int, default=512)
    parser.add_argument("--keep", default=os.path.join(ROOT, ".build", "denoise"))
    parser.add_argument("program")
    arguments = parser.parse_args()
    os.makedirs(arguments.keep, exist_ok=True)
    bench, rows = Bench(arguments), []
    print("| view | " + " | ".join(f"{n} | {n} denoised | off {n} | off {n} denoised"
                                   for n in FEW) + " | " +
          " | ".join(f"energy {n} | block {n}" for n in FEW) + " |\n" +
          "|---" * (1 + 6 * len(FEW)) + "|")
    for view, words in views():
        if arguments.only in view:
            rows.append(bench.row(view, words))
    means = [sum(column) / len(rows) for column in zip(*rows)]
    print("| mean | " + " | ".join(f"{mean:.4f}" for mean in means) +
          " |" * (1 + 2 * len(FEW)))


if __name__ == "__main__":
    main()
