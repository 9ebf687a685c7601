# SPDX-License-Identifier: Apache-2.0
"""meeting.py PARHELION [REVIEW_FOLDER ...] -- a review's page fits a meeting: light, short
before anything is unfolded, two pages on paper, no wider than a telephone, usable by keyboard
and by a screen reader, light and dark; and its first screen is the answer, to a reader who sees
nothing else. Without a folder a small review is made.
"""
import base64
import json
import os
import re
import shutil
import subprocess
import sys
import tempfile

import browser

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path[:0] = [os.path.join(ROOT, "tests", "image"), os.path.join(ROOT, "tests", "structure")]
from gltf import Scene, png  # noqa: E402
from report import Report  # noqa: E402
from review import PANEL, Reviewer, dashboard, moment, request  # noqa: E402

MOST_BYTES, MOST_SCREENS, PAPER_PAGES = 3_000_000, 4, 2
SCREEN = (1280, 720)
MOST_SUMMARIES = 4
# What stands within the first screen, as its reader reads it: word by word, from the top.
SEEN = """(()=>{const out=[];const walk=document.createTreeWalker(document.body,
NodeFilter.SHOW_TEXT);while(walk.nextNode()){const n=walk.currentNode;
if(/SCRIPT|STYLE/.test(n.parentElement.tagName))continue;
const r=document.createRange();r.selectNodeContents(n);const b=r.getBoundingClientRect();
if(b.width&&b.bottom<=innerHeight&&n.data.trim())out.push(n.data.trim());}
return out.join('\\n');})()"""


def axe():
    """The accessibility checker's script, of npm; None where it cannot be had."""
    try:
        where = subprocess.run(["npm", "root", "-g"], capture_output=True, text=True,
                               check=True).stdout.strip()
        path = os.path.join(where, "axe-core", "axe.min.js")
        if not os.path.exists(path):
            folder = tempfile.mkdtemp()
            subprocess.run(["npm", "install", "--silent", "--prefix", folder, "axe-core"],
                           check=True, capture_output=True, timeout=120)
            path = os.path.join(folder, "node_modules", "axe-core", "axe.min.js")
        with open(path, encoding="utf-8") as file:
            return file.read()
    except (OSError, subprocess.SubprocessError):
        return None


def check_access(report, page, checker, where):
    """Nothing serious, folded or unfolded."""
    page.run(checker + ";0")
    for opens in (False, True):
        if opens:
            page.run("document.querySelectorAll('details').forEach(d=>d.open=true)")
        found = page.run("axe.run(document,{resultTypes:['violations']}).then(r=>r.violations"
                         ".filter(v=>/serious|critical/.test(v.impact)).map(v=>v.id+': '+"
                         "v.nodes.length+' '+v.nodes[0].html.slice(0,120)))")
        report.claim(not found, f"{where}, {'un' if opens else ''}folded: {found}")


def check_size(report, page, index):
    size = os.path.getsize(index)
    height = page.run("document.documentElement.scrollHeight")
    print(f"{index}: {size / 1e6:.2f} MB, {height / SCREEN[1]:.2f} screens", end="")
    report.claim(size <= MOST_BYTES, f"{index}: {size} bytes")
    report.claim(height <= MOST_SCREENS * SCREEN[1], f"{index}: {height} px tall")


def paper_pages(page):
    data = page.call("Page.printToPDF", paperWidth=8.27, paperHeight=11.69,
                     preferCSSPageSize=True)["data"]
    return len(re.findall(rb"/Type\s*/Page[^s]", base64.b64decode(data)))


def check_paper(report, page, index):
    few = paper_pages(page)
    page.run("document.getElementById('print-all').click()")
    all_pages = paper_pages(page)
    print(f", on paper {few} pages, with the appendix {all_pages}")
    report.claim(few <= PAPER_PAGES, f"{index}: {few} pages of A4")
    report.claim(all_pages >= few, f"{index}: {all_pages} pages with the appendix")
    page.run("document.getElementById('print-all').click()")


def check_narrow(report, page, index):
    """A telephone: nothing is cut off; folded wide tables scroll in their place."""
    page.resize(390, 844)
    wide = page.run("[...document.querySelectorAll('table')].filter(t=>t.checkVisibility()&&"
                    "t.getBoundingClientRect().right>innerWidth+1).length")
    report.claim(wide == 0, f"{index}: {wide} tables scroll before anything is opened")
    page.run("document.querySelectorAll('details').forEach(d=>d.open=true)")
    over = page.run("document.documentElement.scrollWidth-innerWidth")
    report.claim(over <= 0, f"{index}: {over} px wider than 390")
    cut = page.run("[...document.querySelectorAll('table')].filter(t=>{const w=t.closest("
                   "'.wide');return t.getBoundingClientRect().right>innerWidth+1&&!(w&&"
                   "getComputedStyle(w).overflowX==='auto')}).length")
    report.claim(cut == 0, f"{index}: {cut} tables are cut off")
    page.resize(*SCREEN)


def check_keyboard(report, page, index):
    """Tab comes to links and folds, which Enter opens; what has the focus shows it."""
    page.run("document.querySelectorAll('details').forEach(d=>d.open=false);scrollTo(0,0);"
             "document.activeElement.blur()")
    seen = set()
    for _ in range(60):
        page.call("Input.dispatchKeyEvent", type="keyDown", key="Tab", code="Tab",
                  windowsVirtualKeyCode=9)
        page.call("Input.dispatchKeyEvent", type="keyUp", key="Tab", code="Tab",
                  windowsVirtualKeyCode=9)
        seen.add(page.run("document.activeElement.tagName"))
        if page.run("document.activeElement.tagName==='SUMMARY'"):
            break
    report.claim("SUMMARY" in seen, f"{index}: Tab comes to {seen}")
    drawn = page.run("getComputedStyle(document.activeElement).outlineStyle")
    report.claim(drawn != "none", f"{index}: the focus is not shown")


def check_reader(report, page, index, review):
    """A reader of the first screen's words alone finds verdict, worst case, when, the largest
    cause and the best remedy."""
    page.resize(*SCREEN)
    page.run("scrollTo(0,0)")
    words = page.run(SEEN)
    verdict = re.search(r"^(Fails|Passes|Too close to call|Cannot be judged)\b", words, re.M)
    wanted = {"pass": "Passes", "fail": "Fails", "too close": "Too close to call",
              "cannot be judged": "Cannot be judged"}
    report.claim(verdict and verdict[1] == wanted[review["verdict"]], f"{index}: no verdict")
    worst = re.search(r"([^\n:]+), seen by ([^,\n]+), (.+?): ", words)
    report.claim(bool(worst), f"{index}: no worst case in {words[:200]!r}")
    low = page.run("['.worst .shown','.worst .bars'].map(s=>document.querySelector(s)).filter("
                   "e=>e).map(e=>e.getBoundingClientRect().bottom)")
    report.claim(all(bottom <= SCREEN[1] for bottom in low), f"{index}: below the fold: {low}")
    if not worst:
        return
    cases = [c for c in review["cases"] + [s["worst"] for s in review["sweeps"]]
             if c["symbol"] in worst[1] and c["eye"] == worst[2] and
             worst[3].removeprefix("worst of ").startswith(c["condition"])]
    report.claim(len(cases) >= 1, f"{index}: {worst[0]!r} is no case")
    wanted = {"pass": ("Source",), "cannot be judged": ("Not judged", "Why", "What to do")}
    fails = ("Source", "What to do")
    for name in ("When", "Rests on") + wanted.get(review["verdict"], fails):
        report.claim(re.search(rf"^{name}\n(.+)", words, re.M), f"{index}: no '{name}' in "
                     f"the first screen")
    cause = re.search(r"^Source\n(\S.*?), (\d+) %", words, re.M)
    if cause and cases:
        light = cases[0]["cause_groups"]["light"]
        name = {"direct sunlight": "sun"}.get(cause[1], cause[1])
        report.claim(not light or light[0]["what"].startswith(name[:8]),
                     f"{index}: largest cause {cause[1]}, of {light[:1]}")


def check_summaries(report, program, folder, checker):
    """One page of paper a symbol, to which the grid leads."""
    names = sorted(name for name in os.listdir(folder) if name.startswith("summary-"))
    with open(os.path.join(folder, "index.html"), encoding="utf-8") as file:
        index = file.read()
    report.claim(names, f"{folder}: no symbol has a summary")
    for name in names[:MOST_SUMMARIES]:
        path = os.path.join(folder, name)
        report.claim(f'href="{name}"' in index or len(names) > 10, f"nothing leads to {path}")
        with browser.Browser(program, "file://" + path, SCREEN) as page:
            pages = paper_pages(page)
            report.claim(pages == 1, f"{path}: {pages} pages of A4")
            if checker:
                check_access(report, page, checker, path)
            report.claim(not page.errors, f"{path}: {page.errors}")


def check_folder(report, program, folder, checker):
    check_summaries(report, program, folder, checker)
    index = os.path.join(folder, "index.html")
    with open(os.path.join(folder, "review.json"), encoding="utf-8") as file:
        review = json.load(file)
    for dark in (False, True):
        with browser.Browser(program, "file://" + index, SCREEN, dark) as page:
            page.run("new Promise(done=>setTimeout(done,300))")
            if not dark:
                check_size(report, page, index)
                check_reader(report, page, index, review)
                check_paper(report, page, index)
                check_narrow(report, page, index)
                check_keyboard(report, page, index)
            if checker:
                check_access(report, page, checker, index + (", dark" if dark else ""))
            report.claim(not page.errors, f"{index}: {page.errors}")


def check_gazes(report, program, parhelion):
    """On a screen no column of the table of gazes is cut off."""
    with tempfile.TemporaryDirectory() as place:
        shutil.copy(PANEL, os.path.join(place, "ips.panel"))
        dashboard().write(os.path.join(place, "dash.gltf"))
        Reviewer(parhelion, place).review(request(
            precision={"contrast": 0.2}, eyes={"driver, seated low": {"position_m": [0.1, 0, 0.8]}},
            conditions=[moment("a bright day", type="constant", luminance=3000),
                        moment("night", type="constant", luminance=0.05)],
            gaze=[{"name": "mirror, left", "direction": [-0.5, 0.1, -1]}]), "out")
        index = os.path.join(place, "out", "index.html")
        with browser.Browser(program, "file://" + index, SCREEN) as page:
            page.run("document.querySelectorAll('details').forEach(d=>d.open=true)")
            right = page.run("[...document.querySelectorAll('.gazes,.gazes *')].map(e=>"
                             "e.getBoundingClientRect().right).reduce((a,b)=>Math.max(a,b))")
            report.claim(right <= SCREEN[0], f"a table of gazes ends at {right} px")


# Words of a table that are on more than one line, though they have no place to break.
BROKEN = """(()=>{const out=[];for(const cell of document.querySelectorAll(%r)){
const walk=document.createTreeWalker(cell,NodeFilter.SHOW_TEXT);
while(walk.nextNode()){const n=walk.currentNode;for(const m of n.data.matchAll(/[^\\s-]+/g)){
const r=document.createRange();r.setStart(n,m.index);r.setEnd(n,m.index+m[0].length);
if(new Set([...r.getClientRects()].map(b=>Math.round(b.top))).size>1)out.push(m[0]);}}}
return out;})()"""
CUT = ("[...document.querySelectorAll('.grid .wide')].filter(w=>w.scrollWidth>w.clientWidth+1||"
       "w.getBoundingClientRect().right>innerWidth).length")


def small_screen(place):
    """Writes a dark display of 2 cm about the origin that faces +Z."""
    scene = Scene()
    bars = png(30, 30, [[255 if 10 <= x < 20 and 8 <= y < 22 else 0 for x in range(30)
                         for _ in range(3)] for y in range(30)])
    shown = scene.material("screen", extensions={"PARHELION_display": {
        "panel": "ips.panel", "content": {"index": scene.image("image/png", bars)}}})
    scene.quad(shown, [-0.01, -0.01, 0], [0.02, 0, 0], [0, 0.02, 0])
    shutil.copy(PANEL, os.path.join(place, "ips.panel"))
    scene.write(os.path.join(place, "dash.gltf"))


def small_request(name, luminance, **members):
    """The small screen, off, under a light of one luminance."""
    return request(**{
        "forward": [0, 0, -1], "precision": {"contrast": 0.2}, "levels": {"off": {"*": 0.0001}},
        "conditions": [{**moment(name, type="constant", luminance=luminance), "level": "off"}],
        **members})


def check_unjudged(report, program, parhelion):
    """What cannot be judged: the first screen says what that is, why, and what to do."""
    with tempfile.TemporaryDirectory() as place:
        small_screen(place)
        _, review = Reviewer(parhelion, place).review(small_request(
            "a bright day", 3000, eyes={"who stands behind it": {"position_m": [0, 0, -3]}}),
            "out")
        report.claim(review["verdict"] == "cannot be judged", review["verdict"])
        index = os.path.join(place, "out", "index.html")
        with browser.Browser(program, "file://" + index, SCREEN) as page:
            check_reader(report, page, index, review)


def check_names(report, program, parhelion):
    """Three eyes and symbols with long names: at 1280 px the grid is whole, no word of it is
    broken, and an eye to which a height is too small is told the contrast, too, all of it above
    the fold. Five eyes whose names cannot stand beside each other: those left out are
    counted."""
    names = ("Geschwindigkeitsanzeige", "remaining range in kilometres", "N1",
             "map's next turn")
    eyes = {"driver (5th percentile female)": 0.7, "Beifahrersitzposition, tall driver": 0.8,
            "eye box of the manufacturer": 5}
    more = {"Fahrersitzhöhenverstellungsposition": 0.75, "Beifahrersitzlehnenposition": 0.85}
    for which in (eyes, {**eyes, **more}):
        with tempfile.TemporaryDirectory() as place:
            small_screen(place)
            document = small_request(
                "low sun from behind on the left", 30, levels={"off": {"*": 1}},
                eyes={name: {"position_m": [0, 0, z]} for name, z in which.items()},
                symbols={name: {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]}
                         for name in names})
            Reviewer(parhelion, place).review(document, "out")
            index = os.path.join(place, "out", "index.html")
            with browser.Browser(program, "file://" + index, SCREEN) as page:
                report.claim(page.run(CUT) == 0, f"{len(which)} eyes: the grid is cut off")
                broken = page.run(BROKEN % ".grid th,.grid td")
                report.claim(not broken, f"{len(which)} eyes: broken words {broken}")
                seen = page.run(SEEN)
                shown = sum(name in seen for name in which)
                report.claim(shown == 3 if len(which) == 3 else 1 <= shown < 5 and
                             f"the worst {shown} of 5 eyes" in seen,
                             f"{shown} of {len(which)} eyes in {seen[:400]!r}")
                page.resize(390, 844)
                broken = page.run(BROKEN % ".grid th,.grid td")
                report.claim(not broken, f"{len(which)} eyes, 390 px: broken words {broken}")
                report.claim(page.run(CUT) == 0, f"{len(which)} eyes, 390 px: cut off")
                small = page.run("document.querySelector('.grid td.bad').innerText")
                report.claim(re.search(r"arc min high\s+contrast [\d.]+ : 1", small),
                             f"a height that fails: {small!r}")


def main(program, *folders):
    report, found, checker = Report(), browser.find(), axe()
    if not found:
        report.skip("pages of reviews: there is no Chromium")
        return report.finish()
    if not checker:
        report.skip("pages of reviews for screen readers: npm has no axe-core here")
    check_gazes(report, found, program)
    check_unjudged(report, found, program)
    check_names(report, found, program)
    for folder in folders:
        check_folder(report, found, os.path.abspath(folder), checker)
    if not folders:
        with tempfile.TemporaryDirectory() as place:
            out = os.path.join(place, "glance")
            subprocess.run([program, "review", "scenes/glance.review.json", "-o", out,
                            "--quiet"], cwd=ROOT, capture_output=True, check=False)
            check_folder(report, found, out, checker)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*[os.path.abspath(word) for word in sys.argv[1:]]))
