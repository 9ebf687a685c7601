# SPDX-License-Identifier: Apache-2.0
"""review_denoised.py PARHELION [FOLDER] -- a review's pictures are denoised, nothing else is:
review, tables, frames' light and maps are the same bytes with and without; the label stands at
each picture that is, and nowhere else; such a picture is what `develop --denoise` makes of the
frame beside it, exposed as the frame itself. FOLDER: where a copy of all goes.
"""
import json
import os
import re
import shutil
import sys
import tempfile

from exr import Frame
from review import PANEL, ROOT, Reviewer, dashboard, moment, request

sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report  # noqa: E402

LABEL = "denoised preview, not for figures"
LIGHT = ("R", "G", "B", "variance.R", "display.emitted.G", "display.reflected.B")


def document(**frames):
    return request(
        precision={"contrast": 0.05}, variants={"dimmer": {"brightness": {"*": 0.5}}},
        frames={"size": [64, 36], "noise": 1, "worst": 2, **frames},
        conditions=[moment("grey", type="constant", luminance=3000),
                    moment("dim", type="constant", luminance=300)])


def bytes_of(*names):
    with open(os.path.join(*names), "rb") as file:
        return file.read()


def figures_of(folder, name):
    """Without what names the request's own file by its bytes."""
    text = bytes_of(folder, name).decode()
    return re.sub(r'("path": "r\.json",\s*"sha256": ")[0-9a-f]+', r"\1", text)


def is_picture(name):
    return name.endswith(".png") and not re.search("-(luminance|contrast).png$", name)


def check_figures(report, with_it, without):
    for name in ("review.json", "cases.csv"):
        a, b = figures_of(with_it, name), figures_of(without, name)
        report.claim(a == b and len(a) > 100, f"{name}: other figures")
    names = sorted(os.listdir(os.path.join(without, "frames")))
    report.claim(sorted(os.listdir(os.path.join(with_it, "frames"))) == names,
                 "other files in frames/")
    frames = [name for name in names if name.endswith(".exr")]
    report.claim(len(frames) == 3, f"frames: {frames}")
    for name in frames:
        a, b = (Frame(os.path.join(folder, "frames", name)).channels
                for folder in (with_it, without))
        other = [c for c in LIGHT if c in b and a[c].tobytes() != b[c].tobytes()]
        report.claim("R" in b and not other, f"{name}: other light in {other}")
    for name in (name for name in names if name.endswith(".png")):
        same = bytes_of(with_it, "frames", name) == bytes_of(without, "frames", name)
        report.claim(same != is_picture(name), f"{name}: {'the same' if same else 'other'} "
                     "with and without")


def check_labels(report, with_it, without):
    """Two cards, two pictures of the variant, the first screen; in each file of the pictures."""
    page = bytes_of(with_it, "index.html").decode()
    cards = re.findall(r"<figcaption>[^<]*(?:<b>([^<]*)</b>)?[^<]*</figcaption>", page)
    report.claim(cards.count(LABEL) == 2 + 2 and page.count(LABEL) == 2 + 2 + 1,
                 f"labels in captions: {cards.count(LABEL)}, in the page: {page.count(LABEL)}")
    figures = re.findall(r"<figure[^>]*><h[34]>([^<]*)<.*?</figure>", page, re.S)
    labelled = [title for title, figure in
                zip(figures, re.findall(r"<figure.*?</figure>", page, re.S)) if LABEL in figure]
    report.claim(sorted(labelled) == ["As it stands", "Frame", "Frame", "dimmer"],
                 f"labelled: {labelled}")
    for name in os.listdir(os.path.join(with_it, "frames")):
        if name.endswith(".png"):
            report.claim((LABEL.encode() in bytes_of(with_it, "frames", name)) ==
                         is_picture(name), f"{name}: its description")
    for at, _, names in os.walk(without):
        for name in names:
            report.claim(LABEL.encode() not in bytes_of(at, name), f"{name}: has the label")


def difference(reviewer, a, b):
    done = reviewer.run("compare", a, b, "--metric", "mse", "--json")
    return float(re.search(r'"max_difference": ([\d.e-]+)', done.stdout).group(1))


def check_picture(report, reviewer, folder):
    """As the command makes it; exposure_ev is that of the frame, which is not denoised."""
    name = next(n for n in sorted(os.listdir(os.path.join(folder, "frames")))
                if is_picture(n) and "variant" not in n)
    frame = os.path.join(folder, "frames", name[:-4] + ".exr")
    told = json.loads(reviewer.run("develop", frame, "-o", "own.png", "--json").stdout)
    own = reviewer.run("develop", frame, "-o", "again.png", "--denoise", "--adapt", "none",
                       "--exposure", f"{told['exposure_ev']:.2f}")
    report.claim(own.returncode == 0, own.stderr)
    far = [difference(reviewer, os.path.join(folder, "frames", name), other)
           for other in ("again.png", "own.png")]
    report.claim(far[0] < 0.006 < 0.1 < far[1],
                 f"{name}: codes differ by {far[0]} from the command's, by {far[1]} from those "
                 "of the frame itself")


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(sys.argv[1], folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        dashboard().write(os.path.join(folder, "dash.gltf"))
        reviewer.review(document(), "with")
        reviewer.review(document(denoise=False), "without")
        with_it, without = (os.path.join(folder, name) for name in ("with", "without"))
        check_figures(report, with_it, without)
        check_labels(report, with_it, without)
        check_picture(report, reviewer, with_it)
        if len(sys.argv) > 2:
            shutil.copytree(folder, sys.argv[2], dirs_exist_ok=True)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main())
