# SPDX-License-Identifier: Apache-2.0
"""review_page.py PARHELION [FOLDER] -- a review's page in a browser: what is told of the sun that
is pointed at is its row of the sweep's table, as it was judged; pictures, rays, paper. Without
a browser it is skipped. FOLDER: where screenshots go.
"""
import csv
import datetime
import json
import os
import random
import re
import shutil
import sys
import tempfile

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from report import Report  # noqa: E402
from review import PANEL, Reviewer, dashboard, moment, request  # noqa: E402
import browser  # noqa: E402

VERDICTS = {"pass": "Passes", "fail": "Fails", "too close": "Too close to call",
            "cannot be judged": "Cannot be judged"}
FIGURES = [("contrast_ratio", r"([\d.]+) : 1"), ("contrast_low", r"\(([\d.]+) to"),
           ("contrast_high", r"to ([\d.]+)\)"), ("sun_elevation_deg", r"sun ([\d.]+)° high"),
           ("vehicle_azimuth_deg", r"azimuth ([\d.]+)°"), ("display_lx", r"([\d.]+) lx"),
           ("reflected_cd_m2", r"reflected ([\d.]+)"),
           ("sun_by_mirror_cd_m2", r"in a mirror ([\d.]+)")]


def document():
    return request(
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
        self.page = page
        with open(os.path.join(folder, review["sweeps"][number]["table"]),
                  encoding="utf-8") as file:
            self.rows = list(csv.DictReader(file))
        self.section = f"document.getElementById('s{number}').closest('section')"
        open_card(page, self.section)
        page.wait(f"!!{self.section}.querySelector('.read')")

    def point(self, kind, across, up, area=".area"):
        """At shares of the area's width and height."""
        self.page.run(f"{self.section}.querySelector('{area}').scrollIntoView({{block:'center'}})")
        box = json.loads(self.page.run(f"JSON.stringify({self.section}.querySelector("
                                       f"'{area}').getBoundingClientRect())"))
        self.page.mouse(kind, box["x"] + across * box["width"],
                        box["y"] + (1 - up) * box["height"])

    def said(self, number=0):
        return self.page.run(f"{self.section}.querySelectorAll('.read')[{number}].textContent")

    def row(self):
        """Of the table: that of the time that is told, or of the cell."""
        told = re.search(r"(\d+-\d+-\d+) (\d+):(\d+) UTC, heading (\d+)", self.said())
        if not told:
            return self.rows[int(self.page.run(
                f"{self.section}.querySelector('.read').dataset.cell"))]
        day = datetime.date.fromisoformat(told[1]).timetuple().tm_yday
        hour = int(told[2]) + int(told[3]) / 60
        return next(r for r in self.rows if int(r["day_of_year"]) == day and
                    abs(float(r["hour_utc"]) - hour) < 0.02 and
                    float(r["heading_deg"]) == float(told[4]))


def check_reading(report, sweep, name):
    row, said = sweep.row(), sweep.said()
    for column, pattern in FIGURES:
        told, found = float(re.search(pattern, said)[1]), float(row[column])
        report.claim(abs(told - found) <= max(0.051, 0.006 * abs(found)),
                     f"{name}: {column} {told}, in the table {found}")
    report.claim(said.startswith(VERDICTS[row["verdict"]]), f"{name}: {said}, {row['verdict']}")
    return row


def check_map(report, sweep):
    """Pressed and dragged over the map: each time the row of the sun that is pointed at; then by
    arrow keys. What is only passed over changes nothing."""
    chance, keys = random.Random(3), {"ArrowRight": (195, 20), "ArrowUp": (195, 30),
                                      "ArrowLeft": (180, 30), "ArrowDown": (180, 20)}
    sweep.point("Pressed", 0.01, 0.99)
    for _ in range(12):
        across, up = chance.random(), chance.random()
        sweep.point("Moved", across, up)
        row = check_reading(report, sweep, "dragged")
        azimuth, elevation = 90 - 7.5 + across * 195, 5 + up * 40
        report.claim(abs(float(row["vehicle_azimuth_deg"]) - azimuth) < 7.6 and
                     abs(float(row["sun_elevation_deg"]) - elevation) < 5.1,
                     f"at {azimuth:.1f}, {elevation:.1f} the sun of {row}")
    sweep.point("Moved", 6.5 / 13, 1.5 / 4)
    sweep.point("Released", 6.5 / 13, 1.5 / 4)
    sweep.page.mouse("Moved", 9, 9, held=False)
    report.claim(sweep.row() is sweep.rows[13 + 6], "the sun moves though nothing is pressed")
    for key, at in keys.items():
        sweep.page.key(key)
        row = check_reading(report, sweep, key)
        found = float(row["vehicle_azimuth_deg"]), float(row["sun_elevation_deg"])
        report.claim(found == at, f"{key} leads to {found}")


def check_year(report, sweep):
    """Anywhere on the map: a step that was judged, with its time. A calendar's day and hour."""
    for across, up in ((0.5, 0.3), (0.2, 0.7), (0.9, 0.99)):
        sweep.point("Pressed", across, up)
        sweep.point("Released", across, up)
        check_reading(report, sweep, f"year, {across} {up}")
    sweep.point("Pressed", 150.5 / 365, 0.5, ".area[data-kind=calendar]")
    sweep.point("Released", 150.5 / 365, 0.5, ".area[data-kind=calendar]")
    rows = [r for r in sweep.rows if r["day_of_year"] == "151" and float(r["hour_utc"]) == 14]
    failing = sum(r["verdict"] == "fail" for r in rows)
    words = f"fails for {failing} of 2 headings" if failing else "passes"
    report.claim(sweep.said(1) == f"31 May, 12:00 UTC: {words}", f"calendar: {sweep.said(1)}")


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
    shown = page.run("""['.read','.picked','figure.frame'].map(s=>
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
            page.shot(os.path.join(folder, f"review_{name}.png"), whole=True)
            if name == "light":
                page.pdf(os.path.join(folder, "review_paper.pdf"))


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
    reviewer.review(document(), "whole", "--threads", "2", "--self-contained")
    folder = os.path.join(reviewer.folder, "whole")
    with open(os.path.join(folder, "review.json"), encoding="utf-8") as file:
        review = json.load(file)
    address = "file://" + os.path.join(folder, "index.html")
    cards = [(f"c{i}", case) for i, case in enumerate(review["cases"])]
    cards += [(f"s{i}", sweep["worst"]) for i, sweep in enumerate(review["sweeps"])]
    cards = [card for card, case in cards if case.get("frame")]
    report.claim(len(cards) >= 2, f"{len(cards)} cases have frames")
    with browser.Browser(program, address) as page:
        check_map(report, Sweep(page, folder, review, 0))
        check_year(report, Sweep(page, folder, review, 1))
        open_card(page, f"document.getElementById('{cards[0]}')")
        check_rays(report, page, cards[0])
        check_paper(report, page)
        check_page(report, page, address)
    if folder_of_shots:
        shots(program, address, folder_of_shots)


def main(program, folder_of_shots=None):
    report, found = Report(), browser.find()
    if not found:
        report.skip("no Chromium is installed: a review's page is not looked at")
        return report.finish()
    with tempfile.TemporaryDirectory() as folder:
        reviewer = Reviewer(program, folder)
        shutil.copy(PANEL, os.path.join(folder, "ips.panel"))
        dashboard().write(os.path.join(folder, "dash.gltf"))
        check(report, found, reviewer, folder_of_shots)
    return report.finish()


if __name__ == "__main__":
    sys.exit(main(*sys.argv[1:]))
