# SPDX-License-Identifier: Apache-2.0
"""judged.py PARHELION [--all] [--seed N] -- one judged quantity a row, wherever it is written.

A small display in even light, bright and dim, is reviewed under generated house profiles of
every kind of limit (least and most, advice, slopes, with and without the veil); --all: more of
them, and every shipped profile. Of each case: the figure lies within its interval; the margin
is the closed form; the verdict follows from interval and limit; console, headline, grid, table,
card, CSV, JSON, JUnit, summary and exit status say the same; and a printed brightness,
reviewed, passes.
"""
import csv
import html
import json
import math
import os
import random
import re
import shutil
import subprocess
import sys
import tempfile
import xml.etree.ElementTree as xml

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "hostile"))
from judged_scene import SYMBOLS, request, write_scene  # noqa: E402
from report import Report  # noqa: E402

LEVEL = 0.08
SUMMARY_ROWS, CARDS_ALL = 5, 20
RATIO = {"contrast_ratio": lambda v: v, "luminance_contrast": lambda v: v + 1,
         "modulation": lambda v: (1 + v) / (1 - v) if v < 1 else math.inf}
WORDS = {"contrast_ratio": "contrast", "luminance_contrast": "luminance contrast",
         "modulation": "modulation", "character_height": "height",
         "stroke_ratio": "stroke ratio", "width_ratio": "width ratio"}
SAID = {"pass": "Passes", "fail": "Fails", "too close": "Too close to call",
        "cannot be judged": "Cannot be judged"}
RANK = {"pass": 0, "too close": 1, "cannot be judged": 2, "fail": 3}
UNIT = {"contrast_ratio": " : 1", "character_height": " arc min"}


# ---- profiles -------------------------------------------------------------------------------

def contrast_as(kind, ratio):
    return {"contrast_ratio": ratio, "luminance_contrast": ratio - 1,
            "modulation": (ratio - 1) / (ratio + 1)}[kind]


def limit_of(random_, kind, **more):
    """A value among those that the cases have."""
    if kind in RATIO:
        value = contrast_as(kind, math.exp(random_.uniform(math.log(1.1), math.log(25))))
    elif kind == "character_height":
        value = random_.uniform(10, 120)
    else:
        value = random_.uniform(0.05, 0.4)
    limit = {"ambient": "any", "kind": kind, "value": float(f"{value:.4g}"),
             "unit": "arcmin" if kind == "character_height" else "1", "source": "this test",
             "read_in_the_standard": False}
    limit.update(more)
    return limit


def house_profile(random_, i):
    kinds = list(RATIO)
    first = limit_of(random_, kinds[i % 3], name="the first")
    if i % 4 == 3:
        first["bound"] = "most"
    limits = [first]
    if i % 3 == 1:
        limits.append(limit_of(random_, "character_height", name="height"))
    if i % 3 == 2:
        limits.append(limit_of(random_, "stroke_ratio", name="strokes",
                               bound=random_.choice(["least", "most"])))
        limits.append(limit_of(random_, "width_ratio", name="width"))
    if i % 5 == 4:
        limits.append(limit_of(random_, kinds[(i + 1) % 3], name="another"))
    if i % 4 == 2:
        limits.append(limit_of(random_, "modulation", name="by height", value=0.2,
                               slope={"per_arcmin": 0.001, "reference_arcmin": 100,
                                      "heights_arcmin": [1, 150]}))
    limits.append(limit_of(random_, kinds[(i + 2) % 3], name="preferred", advice=True))
    random_.shuffle(limits)
    return {"title": f"House {i}", "edition": "1", "veil": i % 6 == 5,
            "ambient": {"night_below_lx": 1, "twilight_below_lx": 10, "source": "this test",
                        "read_in_the_standard": False}, "limits": limits}


# ---- what is expected -----------------------------------------------------------------------

def margin_of(limit):
    found, value = limit["found"], limit["value"]
    if found is None:
        return None
    if limit["kind"] in RATIO:
        found, value = (math.log(RATIO[limit["kind"]](v)) for v in (found, value))
    return value / found - 1 if limit["upper"] else found / value - 1


def verdict_of(limit):
    low, high = limit["interval"]
    if limit["found"] is None or low is None or high is None:
        return "cannot be judged"
    if limit["upper"]:
        low, high, value = -high, -low, -limit["value"]
    else:
        value = limit["value"]
    return "pass" if low >= value else "fail" if high < value else "too close"


def counts(limit):
    is_listed = limit["kind"] in ("width_ratio", "stroke_ratio") and limit["found"] is None
    return not limit["advice"] and not is_listed


def case_verdict(case):
    """The worst of the limits that count; nothing can be judged without one."""
    own = [verdict_of(limit) for limit in case["limits"] if counts(limit)]
    return max(own, key=RANK.get) if own else "cannot be judged"


def judged_of(case):
    """The limit that the row is about: the worst with the case's verdict; in a pass that of the
    contrast."""
    own = [limit for limit in case["limits"] if counts(limit) and
           verdict_of(limit) == case["verdict"]]
    if case["verdict"] == "pass" and case["limit"]:
        return case["limit"]
    return min(own, key=margin_of) if own else case["limit"]


def required(limit):
    return (f"{'<=' if limit['upper'] else '>='} {limit['value']:.4g}" +
            UNIT.get(limit["kind"], ""))


def bound(limit):
    """As sentences have it."""
    return (f"{'maximum' if limit['upper'] else 'minimum'} {limit['value']:.4g}" +
            UNIT.get(limit["kind"], ""))


def last_digit(shown):
    """What the last digit that is shown stands for."""
    if "." in shown:
        return 10.0 ** -len(shown.split(".")[1])
    return 10.0 ** (len(shown) - len(shown.rstrip("0")))


def says(text, limit):
    """Does a text begin with the limit's figure, rounded to what its last digit says?"""
    match = re.search(r"-?\d+(?:\.\d+)?(?:e[+-]\d+)?", text)
    if limit["found"] is None:
        return True
    if not match:
        return "∞" in text
    shown = match.group(0)
    return (abs(float(shown) - limit["found"]) <=
            0.51 * last_digit(shown) + 1e-5 * abs(limit["found"]))


def side_is_kept(text, limit):
    """A figure that is printed never stands on the other side of its limit, or on it."""
    match = re.search(r"-?\d+(?:\.\d+)?", text)
    if limit["found"] is None or not match or limit["found"] == limit["value"]:
        return True
    return (float(match.group(0)) - limit["value"]) * (limit["found"] - limit["value"]) > 0


# ---- what was written -----------------------------------------------------------------------

def cells_of(row):
    row = re.sub(r"<svg.*?</svg>", "", row, flags=re.S)
    return [html.unescape(re.sub(r"<[^>]*>", "", cell))
            for cell in re.findall(r"<td[^>]*>(.*?)</td>", row, flags=re.S)]


class Page:
    """A page's verdict, grid, list and cards as texts."""

    def __init__(self, path):
        text = open(path, encoding="utf-8").read()
        found = re.search(r'<div class="verdict[^"]*"><h1><b>(.*?)</b>: (.*?)</h1>', text, re.S)
        self.headline = [html.unescape(part) for part in found.groups()] if found else ["", ""]
        self.is_green = 'class="verdict same"' in text
        self.list = {}
        tables = re.findall(r'<table class="list">(.*?)</table>', text, re.S)
        for row in re.findall(r"<tr>(.*?)</tr>", "".join(tables), re.S):
            cells = cells_of(re.sub("<small.*?</small>", "", row))
            if len(cells) >= 8:
                self.list[cells[1].strip(), cells[2]] = cells
        grid = re.search(r'<div class="grid[^"]*">(.*?)</table>', text, re.S)
        self.grid = re.findall(
            r'<td class="(\w+)"><a[^>]*title="([^"]*)"><i>.*?</i>\s*<b>(.*?)</b>',
            grid.group(1) if grid else "", re.S)
        self.cards = {}
        for kind, body in re.findall(r'<details class="case (\w+)"[^>]*>(.*?)</summary>', text,
                                     re.S):
            where = html.unescape("".join(re.findall(r'class="where">(.*?)<', body)))
            name = html.unescape("".join(re.findall(r"<b>(.*?)</b>", body)))
            ratio = html.unescape("".join(re.findall(r'class="ratio">(.*?)<', body)))
            self.cards[name, where.split(", ")[-1]] = (kind, ratio)


class Written:
    def __init__(self, folder, done):
        self.status, self.console = done.returncode, done.stdout.splitlines()
        self.review = json.load(open(os.path.join(folder, "review.json"), encoding="utf-8"))
        with open(os.path.join(folder, "cases.csv"), encoding="utf-8", newline="") as file:
            self.csv = {(row["subject"], row["condition"]): row for row in csv.DictReader(file)
                        if row["decides"] == "true"}
        suite = xml.parse(os.path.join(folder, "junit.xml")).getroot().find("testsuite")
        self.junit = {case.get("name"): case for case in suite.findall("testcase")}
        self.page = Page(os.path.join(folder, "index.html"))
        self.summaries = {name: Page(os.path.join(folder, f"summary-{name}.html"))
                          for name in SYMBOLS
                          if os.path.exists(os.path.join(folder, f"summary-{name}.html"))}


# ---- claims ---------------------------------------------------------------------------------

def claim_limits(report, where, case):
    for limit in case["limits"]:
        name = f"{where}, {limit['name']} ({limit['kind']})"
        low, high = limit["interval"]
        if limit["found"] is not None:
            report.claim(low <= limit["found"] <= high, f"{name}: {limit['found']} within "
                         f"{low} to {high}")
            wanted = margin_of(limit)
            report.claim(abs(limit["margin"] - wanted) <= 1e-4 * (1 + abs(wanted)),
                         f"{name}: margin {limit['margin']}, expected {wanted:.6g}")
        report.claim(limit["verdict"] == verdict_of(limit),
                     f"{name}: {limit['verdict']}, expected {verdict_of(limit)}")


def claim_row(report, name, text, limit):
    report.claim(says(text, limit) and side_is_kept(text, limit),
                 f"{name}: '{text}' for {limit['found']} against {required(limit)}")


def claim_console(report, where, written, case, limit):
    key = f" {case['condition']}, eye, {case['symbol']}"
    rows = [row for row in written.console if key in row]
    if not report.claim(len(rows) == 1, f"{where}: {len(rows)} rows on the console"):
        return
    verdict, rest = rows[0].split(key, 1)
    report.claim(verdict.strip() == case["verdict"], f"{where}: console says {verdict.strip()}")
    figure = re.match(r": ([a-z ]+) (.*?) \((m[a-z]+ .*?)\)(?:,|$)", rest)
    if not report.claim(bool(figure), f"{where}: console '{rest}'"):
        return
    report.claim(figure.group(1) == WORDS[limit["kind"]] and figure.group(3) == bound(limit),
                 f"{where}: console '{rest}', expected {limit['kind']} {bound(limit)}")
    claim_row(report, f"{where}: console", figure.group(2), limit)


def claim_csv(report, where, written, case, limit):
    row = written.csv[case["symbol"], case["condition"]]
    report.claim(row["finding_verdict"] == case["verdict"] and row["quantity"] == limit["kind"],
                 f"{where}: CSV {row['finding_verdict']} by {row['quantity']}")
    values = [("limit", limit["value"]), ("margin", limit["margin"]),
              ("found", limit["found"]), ("found_low", limit["interval"][0]),
              ("found_high", limit["interval"][1])]
    for key, value in values:
        got = row.get(key) or "nan"
        report.claim(abs(float(got) - value) <= 2e-5 * (1 + abs(value)),
                     f"{where}: CSV {key} {got}, expected {value}")


def claim_junit(report, where, written, case, limit):
    test = written.junit[f"{case['symbol']}, seen by eye, {case['condition']}"]
    kind = {"fail": "failure", "too close": "skipped", "cannot be judged": "error"}
    children = [child.tag for child in test if child.tag != "system-out"]
    expected = [kind[case["verdict"]]] if case["verdict"] in kind else []
    report.claim(children == expected, f"{where}: JUnit {children}, expected {expected}")
    said = test.find("system-out").text
    report.claim(said.startswith(SAID[case["verdict"]]) and bound(limit) in said,
                 f"{where}: JUnit '{said}', expected {bound(limit)}")
    claim_row(report, f"{where}: JUnit", said.split(WORDS[limit["kind"]], 1)[-1], limit)


def claim_pages(report, where, written, case, limit):
    key = case["symbol"], case["condition"]
    for name, page in [("page", written.page), ("summary", written.summaries[case["symbol"]])]:
        if key not in page.list and len(page.list) == SUMMARY_ROWS:
            continue  # it has the worst alone
        if not report.claim(key in page.list, f"{where}: no row on the {name}"):
            continue
        cells = page.list[key]
        report.claim(cells[0] == SAID[case["verdict"]] and cells[6] == required(limit),
                     f"{where}: row {cells} of the {name}, expected {required(limit)}")
        claim_row(report, f"{where}: figure of the {name}", cells[4], limit)
        low = re.search(r"[\d.]+", cells[5])
        if limit["interval"][0] != limit["interval"][1] and low:
            report.claim(abs(float(low.group(0)) - limit["interval"][0]) <=
                         0.1 * (limit["interval"][1] - limit["interval"][0]) +
                         0.51 * last_digit(low.group(0)),
                         f"{where}: interval {cells[5]} of the {name}, {limit['interval']}")
    if key not in written.page.cards and len(written.review["cases"]) > CARDS_ALL:
        return  # it stands on the page beside
    kind, ratio = written.page.cards.get(key, ("", ""))
    report.claim(kind == {"pass": "good", "fail": "bad", "too close": "close"}.get(
        case["verdict"], "hidden"), f"{where}: card '{kind}'")
    claim_row(report, f"{where}: card", ratio, limit)


def claim_case(report, where, written, case):
    claim_limits(report, where, case)
    report.claim(case["verdict"] == case_verdict(case),
                 f"{where}: {case['verdict']}, its limits say {case_verdict(case)}")
    limit = judged_of(case)
    if limit is None or case["verdict"] == "cannot be judged":
        report.claim(case.get("reason") is not None or case["verdict"] != "cannot be judged",
                     f"{where}: no reason")
        return
    report.claim(case.get("judged") == limit, f"{where}: judged by {case.get('judged')}")
    claim_console(report, where, written, case, limit)
    claim_csv(report, where, written, case, limit)
    claim_junit(report, where, written, case, limit)
    claim_pages(report, where, written, case, limit)


def worst_of(cases):
    """By verdict, then by the margin of what the row is about."""
    asked = [case for case in cases if case.get("reason") != "no limit"]
    return min(asked, key=lambda case: (-RANK[case["verdict"]],
                                        judged_of(case)["margin"])) if asked else None


def claim_answer(report, where, page, cases, verdict):
    """The headline and the grid, of all cases or of a symbol's."""
    worst = worst_of(cases)
    said = re.split(" (?:at|in|by) |; ", page.headline[0])[0]
    report.claim(said == SAID[verdict], f"{where}: headline {page.headline}")
    report.claim(page.is_green == (verdict == "pass"), f"{where}: green {page.is_green}")
    if worst is None:
        return
    limit = judged_of(worst)
    text = page.headline[1]
    report.claim(f"{worst['symbol']}, seen by eye, {worst['condition']}" in text and
                 bound(limit) in text,
                 f"{where}: headline '{text}', expected {worst['condition']} {bound(limit)}")
    claim_row(report, f"{where}: headline", text.split(WORDS[limit["kind"]], 1)[-1], limit)
    for symbol in sorted({case["symbol"] for case in cases}):
        own = worst_of([case for case in cases if case["symbol"] == symbol])
        grid = [list(map(html.unescape, cell)) for cell in page.grid]
        cells = [cell for cell in grid if bound(judged_of(own)) in cell[1] and
                 cell[1].startswith(SAID[own["verdict"]])]
        report.claim(any(says(cell[2], judged_of(own)) for cell in cells),
                     f"{where}: grid {page.grid} for {symbol}, {judged_of(own)['found']} "
                     f"against {required(judged_of(own))}")


def claim_review(report, where, written):
    cases = written.review["cases"]
    for case in cases:
        claim_case(report, f"{where}, {case['condition']}, {case['symbol']}", written, case)
    asked = [case["verdict"] for case in cases if case.get("reason") != "no limit"]
    verdict = max(asked, key=RANK.get) if asked else "cannot be judged"
    report.claim(written.review["verdict"] == verdict, f"{where}: {written.review['verdict']}")
    report.claim(written.status == (verdict in ("fail", "cannot be judged")),
                 f"{where}: status {written.status} of {verdict}")
    last = written.console[-1] if written.console else ""
    report.claim(last == written.page.headline[0] == written.review["headline"],
                 f"{where}: last line '{last}'")
    claim_answer(report, where, written.page, cases, verdict)
    for symbol, page in written.summaries.items():
        own = [case for case in cases if case["symbol"] == symbol]
        asked = [case["verdict"] for case in own if case.get("reason") != "no limit"]
        claim_answer(report, f"{where}, summary of {symbol}", page, own,
                     max(asked, key=RANK.get) if asked else "cannot be judged")


# ---- remedies -------------------------------------------------------------------------------

def brightnesses(cases):
    """(case, level, remedy) of each printed brightness that the panel can show."""
    for case in cases:
        for remedy in case["remedies"]:
            to = re.match(r"(?:raise the brightness level|dim) from [\d.e-]+ % to ([\d.e-]+) %",
                          remedy["what"])
            if to and float(to.group(1)) <= 100:
                yield case, float(to.group(1)) / 100, remedy


def claim_remedies(report, where, run, cases, lights, profile):
    asked = list(brightnesses(cases))
    for symbol in sorted({case["symbol"] for case, _, _ in asked}):
        own = [row for row in asked if row[0]["symbol"] == symbol]
        levels = {f"r{i}": level for i, (_, level, _) in enumerate(own)}
        conditions = {f"r{i}": (f"r{i}", lights[case["condition"]])
                      for i, (case, _, _) in enumerate(own)}
        written = run(request(conditions, levels, [symbol]), profile)
        for i, (before, level, remedy) in enumerate(own):
            after = written.review["cases"][i]
            name = f"{where}, {before['condition']}, {symbol}: {remedy['what']}"
            then = remedy.get("then") or {"name": before["limit"]["name"]}
            limit = next(one for one in after["limits"] if one["name"] == then["name"])
            report.claim(limit["verdict"] == "pass",
                         f"{name}: {limit['found']} {limit['interval']} against "
                         f"{required(limit)}")
            promised = remedy.get("verdict", "pass")
            report.claim(promised != "pass" or after["verdict"] == "pass",
                         f"{name}: promised {promised}, is {after['verdict']}")


# ---- all of it ------------------------------------------------------------------------------

def main():
    program = os.path.abspath(sys.argv[1])
    is_all = "--all" in sys.argv
    seed = int(sys.argv[sys.argv.index("--seed") + 1]) if "--seed" in sys.argv else 62
    report, random_ = Report(), random.Random(seed)
    lights = {"dim": 30.0, "grey": 700.0, "bright": 9000.0}
    if is_all:
        lights = {f"{10 ** (k / 3):.3g}": 10 ** (k / 3) for k in range(3, 15)}
    profiles = [house_profile(random_, i) for i in (range(24) if is_all else (3, 4, 5))]
    names = sorted(name[:-5] for name in os.listdir(os.path.join(ROOT, "assets/profiles"))
                   if name.endswith(".json")) if is_all else []
    with tempfile.TemporaryDirectory() as folder:
        write_scene(folder)

        def run(asked, profile):
            out = os.path.join(folder, "out")
            shutil.rmtree(out, ignore_errors=True)
            json.dump(asked, open(os.path.join(folder, "r.review.json"), "w"))
            done = subprocess.run([program, "review", "r.review.json", "-o", out, "--quiet",
                                   "--profile", profile], cwd=folder, capture_output=True,
                                  text=True, timeout=600)
            if done.returncode > 1:
                sys.exit(f"{profile}: status {done.returncode}: {done.stderr}")
            return Written(out, done)

        for i, profile in enumerate(profiles + names):
            name = profile if isinstance(profile, str) else os.path.join(folder, f"p{i}.json")
            where = profile if isinstance(profile, str) else profile["title"]
            if not isinstance(profile, str):
                json.dump(profile, open(name, "w"))
            conditions = {key: ("low", light) for key, light in lights.items()}
            written = run(request(conditions, {"low": LEVEL}), name)
            claim_review(report, where, written)
            claim_remedies(report, where, run, written.review["cases"], lights, name)
    report.finish()


main()
