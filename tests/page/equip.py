# SPDX-License-Identifier: Apache-2.0
"""equip.py PARHELION [FOLDER] -- other people's models, and one of ours, equipped in a browser
by real clicks: a face becomes a display, an eye is set, materials get data, the file is saved,
applied, and what comes of it holds. Without a browser, or without the shared data, what needs
them is skipped. FOLDER: where screenshots go.
"""
import json
import math
import os
import subprocess
import sys
import tempfile
import time

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from report import Report  # noqa: E402
from other_maker import read_glb, strip, write_glb  # noqa: E402
import browser  # noqa: E402

DATA = os.path.join(ROOT, "..", "shared", "data", "gltf")
CAR = os.path.join(DATA, "cockpit", "torcs_car8-trb1.glb")
PLANE = os.path.join(DATA, "cockpit", "c172p_cockpit.glb")
BOX = os.path.join(DATA, "assimp", "BoxTextured-glTF", "BoxTextured.gltf")
DECK = os.path.join(ROOT, "scenes", "cockpit.gltf")
# WebGL on a machine without a graphics card
FLAGS = ("--use-gl=angle", "--use-angle=swiftshader", "--enable-unsafe-swiftshader")


class Work:
    """A folder of its own, the program in it, and a browser beside it."""

    def __init__(self, report, program, chromium, folder):
        self.report, self.chromium, self.folder = report, chromium, folder
        self.program = os.path.abspath(program)

    def path(self, name):
        return os.path.join(self.folder, name)

    def run(self, *line):
        return subprocess.run([self.program, *line], cwd=self.folder, capture_output=True,
                              text=True, check=False)

    def page(self, model, name):
        done = self.run("equip", model, "-o", name)
        self.report.claim(done.returncode == 0, f"{name}: {done.stderr}")
        print(f"{os.path.basename(model)}: {done.stdout.split(':')[1].split('.')[0].strip()}, "
              f"a page of {os.path.getsize(self.path(name))} bytes")
        return "file://" + self.path(name)

    def open(self, address, size=(1280, 900), dark=False):
        page = browser.Browser(self.chromium, address, size, dark, FLAGS)
        page.downloads(self.folder)
        try:
            page.wait("!!window.parhelionEquip")
        except RuntimeError:
            said = page.run("document.getElementById('hint').textContent")
            page.__exit__()
            raise RuntimeError(said) from None
        return page


# ---- hands ----

def click_point(page, point):
    """A place of the model, where it is on the screen."""
    x, y = page.run(f"parhelionEquip.project({list(point)})")
    page.click(x, y)


def click_button(page, name):
    page.run(f"document.getElementById('{name}').scrollIntoView({{block:'center'}})")
    x, y = page.run(f"(b=>[b.left+b.width/2,b.top+b.height/2])"
                    f"(document.getElementById('{name}').getBoundingClientRect())")
    page.click(x, y)


def equip(page):
    return page.run("parhelionEquip.equip()")


def save(work, page, name):
    path = work.path(name)
    click_button(page, "save")
    end = time.monotonic() + 20
    while not os.path.exists(path) and time.monotonic() < end:
        page.run("new Promise(done=>setTimeout(done,50))")
    with open(path, encoding="utf-8") as file:
        return json.load(file)


def check_page(report, page, name):
    foreign = [r for r in page.requests if not r.startswith(("data:", "blob:", "file:"))]
    files = [r for r in page.requests if r.startswith("file:")]
    report.claim(not page.errors, f"{name}: errors of the page: {page.errors}")
    report.claim(not foreign and len(files) == 1, f"{name}: asked for {foreign} {files}")
    report.claim(not page.run("document.querySelectorAll('#lacks li').length"),
                 f"{name}: the page still lacks something")
    for width in (390, 1280):
        page.resize(width, 900)
        wide = page.run("document.documentElement.scrollWidth")
        report.claim(wide <= width, f"{name}: {wide} pixels wide on a screen of {width}")


# ---- what comes of it ----

def apply(work, model, saved, scene, *options):
    """The scene's document, its check and its review's plan."""
    report = work.report
    done = work.run("equip", model, "--with", saved, "-o", scene, *options)
    report.claim(done.returncode == 0, f"{scene}: {done.stderr}")
    checked = json.loads(work.run("check", scene, "--json").stdout)
    report.claim(checked["ok"], f"{scene}: {checked['problems']}")
    review = scene.replace(".gltf", ".review.json")
    plan = work.run("review", review, "--dry-run")
    report.claim(plan.returncode == 0, f"{review}: {plan.stderr}")
    with open(work.path(scene), encoding="utf-8") as file:
        return json.load(file), checked


def node_of(document, name):
    return next(node for node in document["nodes"] if node.get("name") == name)


def turned(q, v):
    x, y, z, w = q
    t = [2 * (y * v[2] - z * v[1]), 2 * (z * v[0] - x * v[2]), 2 * (x * v[1] - y * v[0])]
    return [v[0] + w * t[0] + y * t[2] - z * t[1], v[1] + w * t[1] + z * t[0] - x * t[2],
            v[2] + w * t[2] + x * t[1] - y * t[0]]


def check_scene(report, document, saved, name):
    """Displays and eyes are where the page had them, to 10 micrometres."""
    for display in saved["displays"]:
        node = node_of(document, display["name"])
        for axis, key in (([1, 0, 0], "right"), ([0, 1, 0], "up")):
            far = math.dist(turned(node["rotation"], axis), display[key])
            report.claim(far < 1e-5, f"{name}: {display['name']}'s {key} is off by {far}")
        far = math.dist(node["translation"], display["centre_m"]) - display["before_mm"] / 1e3
        report.claim(abs(far) < 1e-5, f"{name}: {display['name']} is off by {far} m")
    for eye in saved["eyes"]:
        node = node_of(document, eye["name"])
        target = next(d["centre_m"] for d in saved["displays"] if d["name"] == eye["looks_at"])
        way = [t - p for t, p in zip(target, eye["position_m"])]
        far = math.dist(turned(node["rotation"], [0, 0, -1]),
                        [w / math.hypot(*way) for w in way])
        report.claim(far < 1e-5, f"{name}: {eye['name']} looks {far} aside")


def check_review(work, name, saved):
    with open(work.path(name), encoding="utf-8") as file:
        review = json.load(file)
    names = [condition["name"] for condition in review["conditions"]]
    work.report.claim(names == ["an ordinary day", "an ordinary night", "noon", "night",
                                "any sun", "a year"], f"{name}: {names}")
    work.report.claim(list(review["eyes"]) == [eye["name"] for eye in saved["eyes"]] and
                      review["forward"] == saved["forward"], f"{name}: {review['eyes']}")


def check_reopened(report, page, saved):
    """What was saved is taken up again, figures of somebody's own included."""
    saved = json.loads(json.dumps(saved))
    saved["materials"][0] = {"index": saved["materials"][0]["index"],
                             "base_color": [0.2, 0.1, 0.1], "roughness": 0.4}
    page.run(f"""(()=>{{const files=new DataTransfer(),field=document.getElementById('open');
        files.items.add(new File([{json.dumps(json.dumps(saved))}],'a.json'));
        field.files=files.files;
        field.dispatchEvent(new Event('change'));}})()""")
    page.wait("document.getElementById('hint').textContent==='Taken up again.'")
    report.claim(equip(page) == saved, f"taken up again: {equip(page)}, it was {saved}")


# ---- models ----

def click_word(page, word):
    """A button of the last card, by what it says."""
    page.click(*page.run(f"""(()=>{{const b=[...document.querySelectorAll('.card button')]
        .find(b=>b.textContent==={json.dumps(word)});
        b.scrollIntoView({{block:'center'}});
        const r=b.getBoundingClientRect();
        return [r.left+r.width/2,r.top+r.height/2];}})()"""))


def check_inside(report, page, before):
    """The face is a trapezoid: a rectangle in it is smaller. The content's shape is kept.
    Numbers put it back."""
    click_word(page, "Inside the face")
    within = equip(page)["displays"][0]
    report.claim(within["width_m"] <= before["width_m"] and
                 0.3 < within["height_m"] * within["width_m"] /
                 (before["height_m"] * before["width_m"]) < 0.98, f"inside: {within}")
    click_word(page, "The content's shape")
    shaped = equip(page)["displays"][0]
    report.claim(abs(shaped["width_m"] / shaped["height_m"] - 1920 / 720) < 0.01,
                 f"the content's shape: {shaped}")
    page.run("""document.querySelector('#displays details').open=true;
        (f=>[[0,1000*W],[1,1000*H],[2,0],[3,0]].forEach(([i,v])=>{f[i].value=v;
        f[i].dispatchEvent(new Event('input'));}))
        (document.querySelectorAll('#displays input[type=number]'))"""
             .replace("W", str(before["width_m"])).replace("H", str(before["height_m"])))
    again = equip(page)["displays"][0]
    report.claim(again == before, f"put back: {again}, it was {before}")


def check_car(work):
    """From the .glb to the scene by two clicks: its eye is proposed."""
    report, start = work.report, time.monotonic()
    with work.open(work.page(CAR, "car.html")) as page:
        click_point(page, [0.489, 0.64, 0.32])
        found = equip(page)["displays"]
        report.claim(len(found) == 1 and found[0]["on"] == "CONSOLEFRONT_s_0",
                     f"the car: clicked {found}")
        check_inside(report, page, found[0])
        saved = save(work, page, "torcs_car8-trb1.equip.json")
        document, _ = apply(work, CAR, "torcs_car8-trb1.equip.json", "car.gltf")
        print(f"the car: 2 clicks and {time.monotonic() - start:.1f} s from the .glb to "
              f"car.gltf, with the page, the browser, check and the review's plan")
        check_page(report, page, "the car")
    display = saved["displays"][0]
    report.claim(abs(display["width_m"] - 0.568) < 2e-3 and
                 abs(display["height_m"] - 0.263) < 2e-3, f"the car's display: {display}")
    check_scene(report, document, saved, "the car")
    check_review(work, "car.review.json", saved)
    report.claim("camera" in saved["eyes"][0]["proposed_from"], f"{saved['eyes']}")
    for name in ("car.bin", "ips_cluster.panel", "cluster.png"):
        report.claim(os.path.isfile(work.path(name)), f"no {name} beside car.gltf")
    done = work.run("equip", CAR, "--with", "torcs_car8-trb1.equip.json", "-o", "car.gltf")
    report.claim(done.returncode == 4 and "is there already" in done.stderr, done.stderr)
    apply(work, CAR, "torcs_car8-trb1.equip.json", "car.gltf", "--overwrite")


def check_bare_car(work):
    """Without textures and camera: materials are chosen, the eye is before the headrest."""
    report = work.report
    document, rest = read_glb(CAR)
    missing = strip(document)
    document["nodes"] = [{k: v for k, v in n.items() if k != "camera"}
                         for n in document["nodes"]]
    del document["cameras"]
    write_glb(work.path("bare.glb"), document, rest)
    with work.open(work.page("bare.glb", "bare.html")) as page:
        report.claim("wheel" in equip(page)["eyes"][0]["proposed_from"] or
                     "WHEEL" in equip(page)["eyes"][0]["proposed_from"],
                     f"proposed from {equip(page)['eyes']}")
        eye = equip(page)["eyes"][0]["position_m"]
        report.claim(math.dist(eye, [-0.18, 0.87, 0.32]) < 0.02, f"the bare car's eye: {eye}")
        click_point(page, [0.489, 0.64, 0.32])
        for row, choice in enumerate(("trim, black plastic", "leather, black")):
            page.run(f"(s=>{{s.value='{choice}';s.dispatchEvent(new Event('change'))}})"
                     f"(document.querySelectorAll('#materials select')[{row}])")
        click_button(page, "mode-eye")
        click_button(page, "view-front")
        page.run("new Promise(done=>setTimeout(done,200))")
        click_button(page, "view-all")
        page.run("new Promise(done=>setTimeout(done,200))")
        x, y = page.run("(b=>[b.left+b.width/2,b.top+b.height/2])"
                        "(document.getElementById('canvas').getBoundingClientRect())")
        page.click(x, y)
        now = equip(page)["eyes"][0]
        report.claim(now["position_m"] != eye and "before" in now["proposed_from"] or
                     "above" in now["proposed_from"], f"the clicked eye: {now}")
        saved = save(work, page, "bare.equip.json")
        check_reopened(report, page, saved)
        check_page(report, page, "the bare car")
    report.claim([m["name"] for m in saved["materials"]] == missing, f"{saved['materials']}")
    _, checked = apply(work, "bare.glb", "bare.equip.json", "bare.gltf")
    report.claim(not [p for p in checked["problems"] if "optical" in p["message"]],
                 f"the bare car: {checked['problems']}")


def check_plane(work):
    """A large model: drag, then click the face under a place."""
    report = work.report
    with work.open(work.page(PLANE, "plane.html")) as page:
        before = page.run("parhelionEquip.project([-0.5,-0.1,0])")
        page.mouse("Pressed", 400, 300)
        for step in range(1, 6):
            page.mouse("Moved", 400 + 4 * step, 300)
        page.mouse("Released", 420, 300)
        after = page.run("parhelionEquip.project([-0.5,-0.1,0])")
        report.claim(math.dist(before, after) > 5 and "displays" not in equip(page),
                     f"a drag: {before} {after}")
        click_button(page, "view-eye")
        page.run("new Promise(done=>setTimeout(done,200))")
        page.click(740, 460)
        found = equip(page).get("displays", [])
        report.claim(len(found) == 1, f"the plane: {found}")
        saved = save(work, page, "c172p_cockpit.equip.json")
        check_page(report, page, "the plane")
    document, _ = apply(work, PLANE, "c172p_cockpit.equip.json", "plane.gltf")
    check_scene(report, document, saved, "the plane")


def check_box(work):
    """A .gltf whose files lie elsewhere; its eye is clicked."""
    report = work.report
    with work.open(work.page(BOX, "box.html")) as page:
        report.claim(not equip(page)["eyes"], "a box has an eye")
        click_button(page, "view-front")
        page.run("new Promise(done=>setTimeout(done,200))")
        click_point(page, [0, 0, 0.5])
        click_button(page, "mode-eye")
        click_point(page, [0.1, 0.2, 0.5])
        saved = save(work, page, "BoxTextured.equip.json")
        check_page(report, page, "the box")
    display, eye = saved["displays"][0], saved["eyes"][0]
    report.claim(math.dist([display["width_m"], display["height_m"]], [1, 1]) < 1e-5,
                 f"the box's display: {display}")
    report.claim(math.dist(eye["position_m"], [0.1, 0.2, 0.75]) < 0.02, f"the box's eye: {eye}")
    document, _ = apply(work, BOX, "BoxTextured.equip.json", "box.gltf")
    check_scene(report, document, saved, "the box")
    report.claim(document["images"][0]["uri"] == "CesiumLogoFlat.png" and
                 os.path.isfile(work.path("CesiumLogoFlat.png")), f"{document['images']}")


def check_deck(work):
    """A scene of ours, equipped once more: what it names is found from its new place."""
    report = work.report
    with work.open(work.page(DECK, "deck.html")) as page:
        report.claim("Displays already" in page.run("document.body.innerText"),
                     "the deck's own displays are not told")
        box = page.run("(b=>[b.left,b.top,b.width,b.height])"
                       "(document.getElementById('canvas').getBoundingClientRect())")
        page.click(box[0] + box[2] / 2, box[1] + box[3] * 0.75)
        found = equip(page).get("displays", [])
        report.claim(len(found) == 1, f"the deck: {found}")
        saved = save(work, page, "cockpit.equip.json")
        check_page(report, page, "the deck")
    document, checked = apply(work, DECK, "cockpit.equip.json", "deck.gltf")
    check_scene(report, document, saved, "the deck")
    report.claim(len(checked["displays"]) > 2, f"{checked['displays']}")


def shots(work, model, folder):
    address = work.page(model, "shot.html")
    for name, size, dark in (("light", (1280, 800), False), ("dark", (1280, 800), True),
                             ("narrow", (390, 800), False)):
        with work.open(address, size, dark) as page:
            click_point(page, [0.489, 0.64, 0.32])
            click_word(page, "Inside the face")
            page.run("window.scrollTo(0,0);document.querySelector('.steps').scrollTop=0;"
                     "new Promise(done=>setTimeout(done,400))")
            page.shot(os.path.join(folder, f"equip_{name}.png"))


def main(program, folder_of_shots=None):
    report, found = Report(), browser.find()
    if not found:
        report.skip("no Chromium is installed: a model is not equipped by clicks")
        return report.finish()
    with tempfile.TemporaryDirectory() as folder:
        work = Work(report, program, found, folder)
        try:
            check_deck(work)
        except RuntimeError as fault:
            report.claim(False, f"a browser without WebGL? {fault}")
            return report.finish()
        if not os.path.isfile(CAR):
            report.skip(f"no {os.path.relpath(CAR, ROOT)}: models of others are not equipped")
            return report.finish()
        for check in (check_car, check_bare_car, check_plane, check_box):
            check(work)
        if folder_of_shots:
            shots(work, CAR, folder_of_shots)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
