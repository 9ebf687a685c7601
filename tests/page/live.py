# SPDX-License-Identifier: Apache-2.0
"""live.py PARHELION [FOLDER] -- what the reader of a review's page may move, in a browser: the
sun is dragged, and readings are those of the sweeps' tables; a picture is added up again, and
the value under the cursor is the frame's. Without a browser it is skipped. FOLDER: where
screenshots go.
"""
import base64
import csv
import json
import os
import random
import re
import shutil
import sys
import tempfile
import zlib

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from report import Report  # noqa: E402
from exr import Frame  # noqa: E402
from review import PANEL, Reviewer, close, dashboard, moment, request  # noqa: E402
import browser  # noqa: E402

VERDICTS = ["pass", "fail", "too close", "cannot be judged"]
LAYER_ERROR = 0.0043  # as review_live.h says


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
    wanted = [float(row["contrast_ratio"]), float(row["margin"])]
    found = [float(said["contrast"]), float(said["margin"])]
    report.claim(close(found[0], wanted[0], 1e-3) and abs(found[1] - wanted[1]) < 2e-3 *
                 (1 + abs(wanted[1])) and VERDICTS[int(said["verdict"])] == row["verdict"],
                 f"{name}: {found} {said['verdict']}, in the table {wanted} {row['verdict']}")
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


def check_brightness(report, sweep):
    """Another brightness: emitted light times it over the reflected of the table."""
    light, level = sweep.case["luminance_cd_m2"], sweep.case["level"]
    before = sweep.find(".cells image", ".getAttribute('href')")
    row, _ = sweep.said()
    for value in (-2, 1.5):
        sweep.slide("Display brightness", value)
        own = float(row["level"]) * 2 ** value / level
        bright, dark = (light[k] * own + float(row["reflected_cd_m2"])
                        for k in ("foreground", "background"))
        wanted = max(bright, dark) / min(bright, dark)
        found = float(sweep.said()[1]["contrast"])
        report.claim(close(found, wanted, 2e-3), f"brightness: {found}, required: {wanted}")
    report.claim(sweep.find(".cells image", ".getAttribute('href')") != before,
                 "the map stays as it was")
    sweep.slide("Display brightness", 0)
    report.claim(sweep.find(".cells image", ".getAttribute('href')") == before,
                 "the map does not come back")


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


class Look:
    """A case's picture in its card, and the frame that it is of."""

    def __init__(self, page, folder, case, card):
        self.page, self.card = page, f"document.getElementById('{card}')"
        self.frame = Frame(os.path.join(folder, case["frame"][:-4] + ".exr"))
        open_card(page, self.card)
        page.run(f"{self.card}.querySelector('.figures').scrollIntoView({{block:'center'}})")
        page.wait(f"!!{self.card}.querySelector('.look canvas[data-drawn]')")
        page.run(f"{self.card}.querySelector('.look').scrollIntoView({{block:'center'}})")

    def set(self, label, value):
        before = self.drawn()
        self.page.run(f"""[...{self.card}.querySelectorAll('.look label')].filter(
            l=>l.textContent.startsWith('{label}')).forEach(l=>{{
            const i=l.querySelector('input');
            if(i.type==='checkbox'){{if(i.checked!=={json.dumps(bool(value))})i.click();}}
            else{{i.value={value};i.dispatchEvent(new Event('input'));}}}})""")
        self.page.wait(f"{self.card}.querySelector('.look canvas').dataset.drawn>{before}")

    def drawn(self):
        return int(self.page.run(f"{self.card}.querySelector('.look canvas').dataset.drawn"))

    def value_at(self, x, y):
        """Under the cursor, cd/m2."""
        box = json.loads(self.page.run(f"JSON.stringify({self.card}.querySelector("
                                       "'.look canvas').getBoundingClientRect())"))
        self.page.mouse("Moved", box["x"] + (x + 0.5) * box["width"] / 96,
                        box["y"] + (y + 0.5) * box["height"] / 54)
        return float(self.page.run(f"{self.card}.querySelector('.look .read').dataset.value"))

    def luminance(self, x, y, share):
        """Of the frame: all that is not emitted to the eye, and that times `share`."""
        c, i = self.frame.channels, 96 * y + x
        total = shown = 0
        for letter, weight in zip("RGB", (0.212639, 0.715169, 0.072192)):
            total += weight * c[letter][i]
            if c["display.coverage"][i] > 0:
                shown += weight * c["display.emitted." + letter][i] * c["display.coverage"][i]
        return total - shown + share * shown


def check_value(report, look):
    chance = random.Random(7)
    seen = [i for i, share in enumerate(look.frame.channels["display.coverage"]) if share > 0]
    report.claim(len(seen) > 300, f"{len(seen)} pixels of a display")
    for label, value, share in (("Exposure", 1, 1), ("Display brightness", 2, 4),
                                ("Displays on", False, 0), ("False colours", True, 0),
                                ("Displays on", True, 4), ("Display brightness", 0, 1)):
        look.set(label, value)
        for i in chance.sample(seen, 4) + chance.sample(range(96 * 54), 4):
            wanted = look.luminance(i % 96, i // 96, share)
            found = look.value_at(i % 96, i // 96)
            report.claim(abs(found - wanted) <= (LAYER_ERROR + 1e-4) * wanted + 2e-5,
                         f"{label} {value}: {found:.6g} under the cursor, "
                         f"{wanted:.6g} in the frame")


def check_label(report, look):
    """It stands at the denoised picture alone: not at false colours, nor at the eye's view."""
    for label in ("False colours", "Spread as in an eye"):
        for value in (True, False):
            look.set(label, value)
            shown = look.page.run(f"{look.card}.querySelector('.look b.label').offsetHeight>0")
            said = look.page.run(f"{look.card}.querySelector('.look b.label').textContent")
            report.claim(shown == (not value) and said == "denoised preview, not for figures",
                         f"{label} {value}: the label is shown: {shown}, '{said}'")


def check_picture(report, look):
    """At first it is the frame's own picture."""
    for label, value in (("False colours", False), ("Exposure", 0)):
        look.set(label, value)
    worst = look.page.run(f"""(async()=>{{
        const card={look.card},view=card.querySelector('.look canvas');
        const again=card.querySelector('figure.frame use');
        const shown=again?document.querySelector(again.getAttribute('href')):
          card.querySelector('figure.frame svg image,figure.frame img');
        const own=new Image(),copy=document.createElement('canvas');
        own.src=shown.getAttribute('href')||shown.src;
        await own.decode();
        copy.width=view.width;copy.height=view.height;
        copy.getContext('2d').drawImage(own,0,0);
        const [a,b]=[view,copy].map(c=>c.getContext('2d').getImageData(0,0,c.width,c.height)
          .data);
        return [...a].map((v,i)=>Math.abs(v-b[i])).sort((x,y)=>x-y);}})()""")
    mean, most = sum(worst) / len(worst), worst[int(0.99 * len(worst))]
    report.claim(mean < 1 and most <= 5, f"codes beside the frame's picture: {mean:.2f} in the "
                 f"mean, 99 % below {most}")
    print(f"codes beside the frame's own picture: {mean:.2f} in the mean, 99 % within {most}")


def check_eye(report, look):
    """An eye spreads light and makes none; over a narrow view all pixels are alike."""
    means = look.page.run("""(async()=>{const p=liveTools.data.pictures[0],out=[];
        for(const layer of p.layers){const codes=await liveTools.unpack(layer,96*54,4);
          out.push(codes.reduce((s,c)=>s+(c&4095?1e-5*Math.exp(((c&4095)-1)*Math.log(1e15)/
            4094):0),0)/codes.length);}
        return out;})()""")
    report.claim(len(means) == 6 and close(means[2], means[0], 0.005) and
                 close(means[3], means[1], 0.005) and close(means[5], means[1], 0.05),
                 f"means of the layers {means}")
    sharp = look.value_at(48, 27)
    look.set("Spread as in an eye", True)
    report.claim(look.value_at(48, 27) != sharp, "the eye changes nothing")
    look.set("Spread as in an eye", False)
    report.claim(look.value_at(48, 27) == sharp, "the eye stays")


# ---- pictures a second ----

def decoded(text, size):
    """Four planes of bytes: page.h."""
    data = zlib.decompress(base64.b64decode(text))
    planes = []
    for plane in range(4):
        values, value = bytearray(), 0
        for byte in data[plane * size:(plane + 1) * size]:
            value = value + byte & 255
            values.append(value)
        planes.append(bytes(values))
    return planes


def enlarged(text, width, height, times):
    data = bytearray()
    for plane in decoded(text, width * height):
        large = b"".join(b"".join(bytes([v]) * times for v in plane[y * width:(y + 1) * width])
                         * times for y in range(height))
        data += bytes(b - a & 255 for a, b in zip(b"\0" + large, large))
    return base64.b64encode(zlib.compress(bytes(data), 1)).decode()


def check_rate(report, program, page_file, card):
    """The same page with a picture of 960 x 540: how fast it follows a slider."""
    with open(page_file, encoding="utf-8") as file:
        text = file.read()
    block = re.search(r'id="live-data">\n(.*?)</script>', text, re.S).group(1)
    data = json.loads(block)
    for picture in data["pictures"]:
        picture["layers"] = [layer if at in (2, 3) else enlarged(layer, 96, 54, 10)
                             for at, layer in enumerate(picture["layers"])]
        picture["width"], picture["height"] = 960, 540
    large = page_file[:-5] + "_large.html"
    with open(large, "w", encoding="utf-8") as file:
        file.write(text.replace(block, json.dumps(data)))
    with browser.Browser(program, "file://" + large) as page:
        open_card(page, f"document.getElementById('{card}')")
        page.run(f"document.querySelector('#{card} .figures').scrollIntoView()")
        page.wait(f"!!document.querySelector('#{card} .look canvas[data-drawn]')")
        for title, label in (("photograph", ""), ("false colours", "False colours")):
            if label:
                page.run(f"[...document.querySelectorAll('#{card} .tick')].find(l=>"
                         f"l.textContent==='{label}').click()")
            rate = page.run(f"""new Promise(done=>{{
                const look=document.querySelector('#{card} .look');
                const canvas=look.querySelector('canvas');
                const slider=look.querySelectorAll('input[type=range]')[1];
                const start=performance.now(),first=+canvas.dataset.drawn;
                let turns=0;
                (function again(){{
                  slider.value=Math.sin(turns++/9)*3;
                  slider.dispatchEvent(new Event('input'));
                  const passed=performance.now()-start;
                  if(passed<1500)requestAnimationFrame(again);
                  else done(1000*(+canvas.dataset.drawn-first)/passed);
                }})();}})""")
            report.claim(rate > 0, f"{title}: nothing is drawn")
            print(f"{title} of 960 x 540 in the browser: {rate:.0f} pictures a second")


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
        return [...document.querySelectorAll('#{card} .look-view svg.rays g')].filter(g=>
          getComputedStyle(g).visibility==='visible').length;}})()""")
    report.claim(shown == 1, f"{shown} causes show their rays over the picture")


def check_paper(report, page):
    """Nothing that moves; the pictures of cases that fail, where their reader asks for all."""
    page.run("document.getElementById('print-all').click()")
    page.call("Emulation.setEmulatedMedia", media="print")
    shown = page.run("""['.live','.look','.live-sun','figure.frame'].map(s=>
        [...document.querySelectorAll(s)].filter(e=>e.offsetParent).length)""")
    report.claim(shown[:3] == [0, 0, 0] and shown[3] > 0, f"on paper: {shown}")
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
            page.wait("document.querySelectorAll('.look canvas[data-drawn]').length>1")
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
    """Pictures and layers in files beside the page: it finds them all, and asks for no layers
    before its reader looks at a picture; without them the picture stays."""
    _, review = reviewer.review(document(), "beside", "--threads", "2")
    folder = os.path.join(reviewer.folder, "beside")
    where = "file://" + folder + "/"
    cards = [f"c{i}" for i, case in enumerate(review["cases"]) if case.get("frame")]
    case = review["cases"][int(cards[0][1:])]
    size = os.path.getsize(os.path.join(folder, "index.html"))
    with browser.Browser(program, where + "index.html") as page:
        asked = [name for name in page.requests if name.endswith(".layers.js")]
        report.claim(not asked, f"layers before anybody looks: {asked}")
        check_value(report, Look(page, folder, case, cards[0]))
        page.run("document.querySelectorAll('details').forEach(d=>d.open=true);"
                 "document.querySelectorAll('img').forEach(i=>i.loading='eager')")
        page.wait("[...document.images].every(i=>i.complete)")
        missing = page.run("[...document.images].filter(i=>!i.naturalWidth).map(i=>i.src)")
        report.claim(not missing, f"pictures that are not there: {missing}")
        first = page.run("(i=>[i.width,i.height,i.naturalWidth,i.naturalHeight])"
                         "(document.querySelector('.worst img'))")
        tall = min(270, first[0] * first[3] / first[2])
        report.claim(abs(first[1] - tall) < 2, f"the first picture is stretched: {first}")
        check_first(report, page)
        count = page.run("[...document.images].filter(i=>i.src.endsWith('.png')).length")
        report.claim(count >= 4, f"{count} pictures")
        check_page(report, page, where)
    for name in os.listdir(os.path.join(folder, "frames")):
        if name.endswith(".js"):
            os.remove(os.path.join(folder, "frames", name))
    with browser.Browser(program, where + "index.html") as page:
        open_card(page, f"document.getElementById('{cards[0]}')")
        page.run(f"document.querySelector('#{cards[0]} .figures').scrollIntoView()")
        page.run("new Promise(done=>setTimeout(done,500))")
        shown = page.run(f"!!document.querySelector('#{cards[0]} figure.frame img')"
                         f".naturalWidth&&!document.querySelector('#{cards[0]} .look canvas')")
        report.claim(shown, "without layers the picture does not stay")
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
    cards = [(card, case) for card, case in cards if case.get("frame")]
    report.claim(len(cards) >= 2, f"{len(cards)} cases have frames")
    with browser.Browser(program, address) as page:
        # the second of two symbols: what belongs to its display stands with the first
        suns, year = (Sweep(page, folder, review, i) for i in (1, 3))
        check_year(report, year)
        suns.find(".area", ".scrollIntoView({block:'center'})")
        check_drag(report, suns)
        check_keys(report, suns)
        check_brightness(report, suns)
        for card, case in cards[:2]:
            look = Look(page, folder, case, card)
            check_value(report, look)
            check_picture(report, look)
            check_label(report, look)
        check_eye(report, look)
        check_rays(report, page, cards[0][0])
        check_paper(report, page)
        check_page(report, page, address)
    check_rate(report, program, os.path.join(folder, "index.html"), cards[0][0])
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
