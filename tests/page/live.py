# SPDX-License-Identifier: Apache-2.0
"""live.py PARHELION [FOLDER] -- what the reader of a review's page may move, in a browser: the
sun is dragged, and what is told is the row of the sweep's table, as it was judged. Without a
browser it is skipped. FOLDER: where screenshots go.
"""
import csv
import json
import os
import random
import shutil
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from report import Report  # noqa: E402
from review import PANEL, Reviewer, close, dashboard, moment, request  # noqa: E402
import browser  # noqa: E402

VERDICTS = ["pass", "fail", "too close", "cannot be judged"]
FIGURES = {"contrast": "contrast_ratio", "low": "contrast_low", "high": "contrast_high",
           "reflected": "reflected_cd_m2", "mirror": "sun_by_mirror_cd_m2", "level": "level",
           "lux": "display_lx"}


def document():
    return request(
        symbols={"bar": {"display": "screen", "uv": [0.1, 0.1, 0.9, 0.9]},
                 "end": {"display": "screen", "uv": [0.5, 0.1, 0.9, 0.9]}},
        precision={"contrast": 0.02}, frames={"size": [96, 54], "noise": 1, "worst": 2},
        levels={"dim": {"*": 0.05}, "auto": {
            "sensor": {"position_m": [0, 0.1, 0.3], "normal": [0, 1, 0]},
            "table_lx": [[0, 0.05], [2000, 0.3], [50000, 1]]}},
        conditions=[
            {**moment("grey", type="constant", luminance=3000), "level": "dim"},
            {"name": "suns", "level": "auto", "sweep": {"sun": {
                "azimuth_deg": [90, 270, 15], "elevation_deg": [10, 40, 10]}, "sky": "sky"}},
            {"name": "year", "level": "auto", "sweep": {
                "year": 2026, "where": [48, 11, 500], "step_minutes": 240,
                "headings_deg": [0, 90], "weather": "clear"}}])


class Sweep:
    """One sweep's part of the page, and its table."""

    def __init__(self, page, folder, review, number):
        self.page, self.number = page, number
        self.case = review["sweeps"][number]["worst"]
        with open(os.path.join(folder, review["sweeps"][number]["table"]),
                  encoding="utf-8") as file:
            self.rows = list(csv.DictReader(file))
        self.section = f"document.getElementById('s{number}').closest('section')"
        page.run(f"for(let e={self.section};e;e=e.parentElement)"
                 "if(e.tagName==='DETAILS')e.open=true")
        page.run(f"{self.section}.querySelector('.area').scrollIntoView({{block:'center'}})")
        page.wait(f"!!{self.section}.querySelector('.live-sun')")

    def find(self, selector, then):
        return self.page.run(f"{self.section}.querySelector('{selector}'){then}")

    def box(self, selector):
        return json.loads(self.page.run(f"JSON.stringify({self.section}.querySelector("
                                        f"'{selector}').getBoundingClientRect())"))

    def said(self):
        """The row of the sun that is read, and what is said of it."""
        at = int(self.find(".live-answer", ".dataset.sun"))
        data = json.loads(self.page.run(
            f"JSON.stringify({{...{self.section}.querySelector('.live-said').dataset}})"))
        return self.rows[at] if at >= 0 else None, data

    def slide(self, label, value):
        self.page.run(f"""[...{self.section}.querySelectorAll('.live .slide')].filter(
            l=>l.textContent.startsWith('{label}')).forEach(l=>{{
            const i=l.querySelector('input,select');i.value={value};
            i.dispatchEvent(new Event(i.tagName==='SELECT'?'change':'input'))}})""")


def check_reading(report, sweep, name):
    row, said = sweep.said()
    for key, column in FIGURES.items():
        report.claim(close(float(said[key]), float(row[column]), 5e-4),
                     f"{name}: {key} {said[key]}, in the table {row[column]}")
    margin = float(row["margin"])
    report.claim(abs(float(said["margin"]) - margin) < 1e-3 + 1e-4 * abs(margin) and
                 VERDICTS[int(said["verdict"])] == row["verdict"],
                 f"{name}: {said['margin']} {said['verdict']}, in the table {margin} "
                 f"{row['verdict']}")
    return row


def check_drag(report, sweep):
    """Pressed, moved over the map, released: each time the nearest sun's row."""
    chance, box = random.Random(3), sweep.box(".area")
    page, rows = sweep.page, sweep.rows
    page.mouse("Pressed", box["x"] + 5, box["y"] + 5)
    for _ in range(12):
        across, up = chance.random(), chance.random()
        page.mouse("Moved", box["x"] + across * box["width"],
                   box["y"] + (1 - up) * box["height"])
        row = check_reading(report, sweep, "dragged")
        azimuth, elevation = 90 - 7.5 + across * 195, 5 + up * 40
        report.claim(abs(float(row["vehicle_azimuth_deg"]) - azimuth) < 7.6 and
                     abs(float(row["sun_elevation_deg"]) - elevation) < 5.1,
                     f"at {azimuth:.1f}, {elevation:.1f} the sun of {row}")
    page.mouse("Released", box["x"] + 5, box["y"] + 5)
    before = sweep.said()[0]
    page.mouse("Moved", box["x"] + 9, box["y"] + 9)
    report.claim(sweep.said()[0] is before, "the sun moves though nothing is pressed")
    report.claim(len(rows) == 13 * 4, f"{len(rows)} suns")


def check_keys(report, sweep):
    sweep.slide("Azimuth", 180)
    sweep.slide("Height", 20)
    sweep.find(".live-sun", ".focus()")
    for key, azimuth, elevation in (("ArrowRight", 195, 20), ("ArrowUp", 195, 30),
                                    ("ArrowLeft", 180, 30), ("ArrowDown", 180, 20)):
        sweep.page.key(key)
        row = check_reading(report, sweep, key)
        at = float(row["vehicle_azimuth_deg"]), float(row["sun_elevation_deg"])
        report.claim(at == (azimuth, elevation), f"{key} leads to {at}")


def check_year(report, sweep):
    for day, step, heading in ((171, 3, 1), (354, 2, 0), (80, 1, 1), (81, 3, 0)):
        sweep.slide("Day", day)
        sweep.slide("Hour", step)
        sweep.slide("Heading", heading)
        row = check_reading(report, sweep, f"day {day}, step {step}")
        found = int(row["day_of_year"]), float(row["hour_utc"]), float(row["heading_deg"])
        report.claim(found == (day + 1, 4 * step + 2, 90 * heading),
                     f"day {day}, step {step}: {found}")
    sweep.slide("Hour", 0)
    report.claim(sweep.said()[0] is None and "below the horizon" in
                 sweep.find(".live-answer", ".textContent"), "the sun at midnight")
    box = sweep.box(".area[data-kind=calendar]")
    sweep.page.mouse("Pressed", box["x"] + box["width"] * 150.5 / 365,
                     box["y"] + box["height"] * 0.5)
    sweep.page.mouse("Released", box["x"], box["y"])
    row = check_reading(report, sweep, "calendar")
    report.claim(row["day_of_year"] == "151", f"day {row['day_of_year']} of the calendar")
    box = sweep.box(".area[data-kind=map]")
    sweep.page.mouse("Pressed", box["x"] + box["width"] * 0.5, box["y"] + box["height"] * 0.7)
    sweep.page.mouse("Released", box["x"], box["y"])
    check_reading(report, sweep, "map of a year")


def open_card(page, card):
    """With all that it is folded in."""
    page.run(f"for(let e={card};e;e=e.parentElement)if(e.tagName==='DETAILS')e.open=true")


# ---- the page ----

def check_page(report, page, where):
    outside = [r for r in page.requests if not r.startswith(("data:", "blob:", where))]
    report.claim(not page.errors, f"errors of the page: {page.errors}")
    report.claim(not outside, f"asked for: {outside}")
    for width in (390, 1280):
        page.resize(width, 900)
        wide = page.run("document.documentElement.scrollWidth")
        report.claim(wide <= width, f"{wide} pixels wide on a screen of {width}")


def check_rays(report, page, card):
    """A cause's link shows its rays over the picture."""
    shown = page.run(f"""(async()=>{{const link=document.querySelector('#{card} .causes a');
        if(!link)return null;
        link.click();
        await new Promise(done=>setTimeout(done,100));
        return [...document.querySelectorAll('#{card} figure.frame svg.rays g')].filter(g=>
          getComputedStyle(g).visibility==='visible').length;}})()""")
    report.claim(shown == 1, f"{shown} causes show their rays over the picture")


def check_paper(report, page):
    """Nothing that moves; the pictures of cases that fail, where their reader asks for all."""
    page.run("document.getElementById('print-all').click()")
    page.call("Emulation.setEmulatedMedia", media="print")
    shown = page.run("""['.live','.live-sun','figure.frame'].map(s=>
        [...document.querySelectorAll(s)].filter(e=>e.offsetParent).length)""")
    report.claim(shown[:2] == [0, 0] and shown[2] > 0, f"on paper: {shown}")
    page.call("Emulation.setEmulatedMedia", media="")
    page.run("document.getElementById('print-all').click()")


def shots(program, address, folder):
    for name, size, dark in (("light", (1280, 900), False), ("dark", (1280, 900), True),
                             ("narrow", (390, 800), False)):
        with browser.Browser(program, address, size, dark) as page:
            page.run("document.querySelectorAll('details').forEach(e=>{e.open=true})")
            for i in range(page.run("document.querySelectorAll('.area,figure.frame').length")):
                page.run(f"document.querySelectorAll('.area,figure.frame')[{i}]"
                         ".scrollIntoView();new Promise(done=>setTimeout(done,500))")
            page.wait("document.querySelectorAll('.live').length==4")
            page.shot(os.path.join(folder, f"live_{name}.png"), whole=True)
            if name == "light":
                page.pdf(os.path.join(folder, "live_paper.pdf"))


def check_first(report, page):
    """The first screen: a line around the symbol, in its picture; a grid without a bar."""
    rim, shown, over = page.run(
        "(box=>[box('.worst .rim path'),box('.worst .shown'),"
        "(g=>g.scrollWidth-g.clientWidth)(document.querySelector('.first .grid>*'))])"
        "(s=>(b=>[b.left,b.top,b.right,b.bottom])"
        "(document.querySelector(s).getBoundingClientRect()))")
    share = [(min(rim[k + 2], shown[k + 2]) - max(rim[k], shown[k])) / (rim[k + 2] - rim[k])
             for k in (0, 1)]
    report.claim(min(share) > 0.6, f"the symbol's line {rim} in {shown}: {share}")
    report.claim(over <= 0, f"the grid is {over} px wider than its place")


def check_beside(report, program, reviewer):
    """Pictures in files beside the page: it finds them all."""
    reviewer.review(document(), "beside", "--threads", "2")
    folder = os.path.join(reviewer.folder, "beside")
    where = "file://" + folder + "/"
    size = os.path.getsize(os.path.join(folder, "index.html"))
    with browser.Browser(program, where + "index.html") as page:
        page.run("document.querySelectorAll('details').forEach(d=>d.open=true);"
                 "document.querySelectorAll('img').forEach(i=>i.loading='eager')")
        page.wait("[...document.images].every(i=>i.complete)")
        missing = page.run("[...document.images].filter(i=>!i.naturalWidth).map(i=>i.src)")
        report.claim(not missing, f"pictures that are not there: {missing}")
        first = page.run("(i=>[i.width,i.height,i.naturalWidth,i.naturalHeight])"
                         "(document.querySelector('.worst img'))")
        tall = min(230, first[0] * first[3] / first[2])
        report.claim(abs(first[1] - tall) < 2, f"the first picture is stretched: {first}")
        check_first(report, page)
        count = page.run("[...document.images].filter(i=>i.src.endsWith('.png')).length")
        report.claim(count >= 4, f"{count} pictures")
        check_page(report, page, where)
    print(f"the page beside its pictures: {size / 1e3:.0f} kB")


def check(report, program, reviewer, folder_of_shots):
    check_beside(report, program, reviewer)
    reviewer.review(document(), "live", "--threads", "2", "--self-contained")
    folder = os.path.join(reviewer.folder, "live")
    with open(os.path.join(folder, "review.json"), encoding="utf-8") as file:
        review = json.load(file)
    address = "file://" + os.path.join(folder, "index.html")
    cards = [(f"c{i}", case) for i, case in enumerate(review["cases"])]
    cards += [(f"s{i}", sweep["worst"]) for i, sweep in enumerate(review["sweeps"])]
    cards = [card for card, case in cards if case.get("frame")]
    report.claim(len(cards) >= 2, f"{len(cards)} cases have frames")
    with browser.Browser(program, address) as page:
        # the second of two symbols: what belongs to its display stands with the first
        suns, year = (Sweep(page, folder, review, i) for i in (1, 3))
        check_year(report, year)
        suns.find(".area", ".scrollIntoView({block:'center'})")
        check_drag(report, suns)
        check_keys(report, suns)
        open_card(page, f"document.getElementById('{cards[0]}')")
        check_rays(report, page, cards[0])
        check_paper(report, page)
        check_page(report, page, address)
    if folder_of_shots:
        shots(program, address, folder_of_shots)


def main(program, folder_of_shots=None):
    report, found = Report(), browser.find()
    if not found:
        report.skip("no Chromium is installed: what moves in a review's page is not looked at")
        return report.finish()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        dashboard().write(os.path.join(folder, "dash.gltf"))
        check(report, found, reviewer, folder_of_shots)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
