# SPDX-License-Identifier: Apache-2.0
"""figures.py [--renew] [--logs [PARHELION]] [PAGE ...] -- every figure of a page stands on
something.

A figure is a number with a unit in the prose or a table of a page. It is an argument of a
command of its section, or a line of the page's list tests/image/figures/NAME.txt covers it:

    # a comment
    ~ PART OF A COMMAND     what the one command of the page prints that is this, or holds it
    $ COMMAND               what this prints in the page's folder, after the page's commands;
                            $ROOT is the checkout
    @ STEP                  what a step of tests/run.sh or long.sh printed
    < FILE                  what stands in a file of the checkout
    =                       nothing: the figures follow from a formula
    ! COMMAND               a measurement by hand: the page names the command
    : SOURCE                a definition, a limit or a standard's number, and where it is from
    * SOURCE                the whole page is a definition

and under it, of `~ $ @ < =`, one line a place of the page (a line that ends with \\ goes on):

    words of the page with {} for each figure || PATTERN => EXPRESSION, EXPRESSION

PATTERN is a regular expression in which {} is a number. n are the numbers of its first match,
rows those of all. There is an EXPRESSION (Python, with math) for each figure of the place;
without any they are n. Under `! : *` the words alone stand. Words may hold other numbers: these
are covered, and as written. The value is nowhere but in the page: a place whose words are not
on the page fails, and so does a figure that no place covers.

A figure may differ by one in its last digit; `{} +- {}` by what the page says, a count before
`passed` not at all. Zeros at the end of a whole number count as digits up to the third. --renew
writes what is printed now into the page and says so, figure by figure; what was renewed counts
as failed. Places of ~ and $ are compared by guides.py, which runs the pages; those of @ with
--logs, if the step's log is no older than PARHELION.
"""
import bisect
import math
import os
import re
import sys
from dataclasses import dataclass

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from readme import exists, named_paths  # noqa: E402
from report import Report, read  # noqa: E402

LISTS = "tests/image/figures"
PAGES = ("README.md", "scenes/README.md", "assets/panels/README.md", "assets/schemas/README.md")
NUMBER = r"[-+]?(?:(?:\d{1,3}(?:,\d{3})+|\d+)(?:\.\d+)?|\.\d+)(?:[eE][-+]?\d+)?"
UNIT = ("%|cd/m2|cd/m²|klx|lx|lux|cd|lm/W|lm|W/m2|W m|mm|cm|km|nm|m2|m|degrees?|minutes?|mrad|"
        "rad|s|seconds|hours?|ms|GB|MB|KB|kilobytes|megabytes|bytes|pixels|samples|K|stops?|"
        "sigmas?|times|passed|: ?1|u'v'|triangles|wavelengths|paths|directions|texels|levels|"
        "bounces|standard errors|errors")
FIGURE = re.compile(rf"(?<![\w.^/,-])({NUMBER}) ?(?:{UNIT})(?!\w)")
KINDS = "~$@<=!:*"
COMPARED = "~$@<="


# ---- pages ---------------------------------------------------------------------------------

def blank(match):
    return re.sub(r"[^\n]", " ", match[0])


class Page:
    """The text of a page without its blocks of code, runs of white space as one space."""

    def __init__(self, name):
        self.name, self.text = name, read(name)
        prose = re.sub(r"^```.*?^```$", blank, self.text, flags=re.M | re.S)
        prose = re.sub(r"^    .*$", blank, prose, flags=re.M)
        self.places = [i for i, c in enumerate(prose) if not c.isspace()
                       or i and not prose[i - 1].isspace()]
        self.flat = re.sub(r"\s", " ", "".join(prose[i] for i in self.places))
        self.headings = [m.start() for m in re.finditer(r"^#+ ", self.text, re.M)]

    def line(self, at):
        return self.text.count("\n", 0, self.places[at]) + 1

    def section(self, at):
        """The raw text from the heading above to the next one."""
        i = bisect.bisect_right(self.headings, self.places[at])
        edges = [0, *self.headings, len(self.text)]
        return self.text[edges[i]:edges[i + 1]]

    def figures(self):
        return list(FIGURE.finditer(self.flat))

    def write(self, edits):
        """edits: (place in `flat`, old, new)."""
        text = self.text
        for at, old, new in sorted(edits, reverse=True):
            start = self.places[at]
            text = text[:start] + new + text[start + len(old):]
        with open(os.path.join(ROOT, self.name), "w", encoding="utf-8") as file:
            file.write(text)


def list_name(page):
    return page[:-len(".md")].replace("assets/guides/", "").replace("/", "-")


def all_pages():
    folder = os.path.join(ROOT, "assets", "guides")
    return list(PAGES) + [f"assets/guides/{name}" for name in sorted(os.listdir(folder))]


# ---- lists ---------------------------------------------------------------------------------

@dataclass
class Place:
    """A line of a list."""
    kind: str
    source: str
    words: str
    pattern: str
    expressions: str
    at: str  # file and line

    def found(self, page):
        whole = rf"({NUMBER})(?!\d|[.,]\d)"
        expression = re.escape(self.words).replace(r"\{\}", whole)
        return list(re.finditer(rf"(?<![\w.]){expression}", page.flat))


def parsed(line, kind, source, at):
    words, _, rest = line.partition(" || ")
    pattern, _, expressions = rest.partition("=>")
    return Place(kind, source, " ".join(words.split()), pattern.strip(), expressions.strip(),
                 at)


def read_list(page):
    name = f"{LISTS}/{list_name(page)}.txt"
    if not os.path.exists(os.path.join(ROOT, name)):
        return []
    places, kind, source, before = [], "", "", ""
    for number, line in enumerate(read(name).splitlines(), 1):
        if line.endswith("\\"):
            before += line[:-1].strip() + " "
            continue
        line, before = before + line.strip(), ""
        if not line or line.startswith("#"):
            continue
        if line[0] in KINDS and line[1:2] in ("", " "):
            kind, source = line[0], line[2:].strip()
            if kind == "*":
                places.append(Place(kind, source, "", "", "", f"{name}:{number}"))
        else:
            places.append(parsed(line, kind, source, f"{name}:{number}"))
    return places


# ---- comparing -----------------------------------------------------------------------------

def value(text):
    return float(text.replace(",", ""))


def last_digit(text):
    """What one in the last digit of a figure is."""
    mantissa, _, exponent = re.sub("[-+,]", "", text.lower().split("e")[0]), "", \
        text.lower().partition("e")[2]
    scale = 10.0 ** int(exponent or 0)
    if "." in mantissa:
        return scale * 10.0 ** -len(mantissa.partition(".")[2])
    zeros = len(mantissa) - len(mantissa.rstrip("0"))
    return scale * 10.0 ** max(0, min(zeros, len(mantissa) - 3))


def like(text, number):
    """A number with the digits, the sign and the commas of a figure."""
    step = last_digit(text)
    if "e" in text.lower():
        digits = len(text.lower().partition("e")[0].partition(".")[2])
        long = f"{number:.{digits}e}"
        return long if re.search(r"e[-+]?0", text) else re.sub(r"e([-+]?)0", r"e\1", long)
    digits = len(text.partition(".")[2])
    sign = "+" if text.startswith("+") else ""
    comma = "," if "," in text or number >= 10000 else ""
    return f"{round(number / step) * step:{sign}{comma}.{digits}f}"


def numbers(pattern, output):
    """Of every match of a pattern, its numbers."""
    expression = pattern.replace("{}", f"({NUMBER})")
    return [[value(group) for group in match.groups()]
            for match in re.finditer(expression, output, re.M)]


def computed(place, output):
    """The numbers that a place should have, or None where nothing like it is printed."""
    rows = numbers(place.pattern, output) if place.pattern else [[]]
    if not rows:
        return None
    names = {"n": rows[0], "rows": rows, **vars(math)}
    return [float(x) for x in eval(f"[{place.expressions}]", names)] or rows[0]


def compare(page, place, output):
    """(holds, message, edit) of each figure of a place; edit: (where on the page, old, new)."""
    wanted = computed(place, output)
    matches = place.found(page)
    if wanted is None or not matches:
        what = f"{place.kind} {place.source}"
        return [(False, f"{place.at}: {what} prints nothing like {place.pattern}", None)] \
            if matches else []
    results = []
    for match in matches:
        near = " +- " in place.words and value(match[2])
        if len(match.groups()) != len(wanted):
            return [(False, f"{place.at}: {len(wanted)} numbers for {len(match.groups())} "
                            "figures", None)]
        for i, (old, new) in enumerate(zip(match.groups(), wanted)):
            exact = page.flat[match.end(i + 1):].startswith(" passed")
            may = max((not exact) * last_digit(old), near if near and i == 0 else 0)
            holds = abs(value(old) - new) <= may * (1 + 1e-9)
            results.append((holds, f"{page.name}:{page.line(match.start(i + 1))}: {old} where "
                            f"{place.kind} {place.source} gives {like(old, new)} ({new:.6g}): "
                            f"{match[0]}", (match.start(i + 1), old, like(old, new))))
    return results


def compare_all(report, page, results, renew):
    """Claims; with `renew` the page is mended, and the claims fail all the same."""
    edits = [edit for holds, _, edit in results if not holds and edit]
    for holds, message, edit in results:
        report.claim(holds, ("renewed " if renew and edit else "") + message)
    if renew and edits:
        page.write(edits)


# ---- the law -------------------------------------------------------------------------------

def arguments(section):
    """Numbers in the commands of a section."""
    blocks = re.findall(r"^```sh\n(.*?)^```", section, re.M | re.S)
    return {abs(value(n)) for block in blocks for n in re.findall(NUMBER, block)}


def uncovered(page, places):
    covered = [m.span() for place in places for m in place.found(page) if place.words]
    return [f"{page.name}:{page.line(m.start())}: {m[0]}" for m in page.figures()
            if not any(a <= m.start() and m.end(1) <= b for a, b in covered)
            and abs(value(m[1])) not in arguments(page.section(m.start()))]


def wrong_lines(page, places):
    """Places that are not on the page, and those that say too little."""
    for place in places:
        figures = place.words.count("{}")
        if place.kind != "*" and not place.found(page):
            yield f"{place.at}: {page.name} has no \"{place.words}\""
        if (place.kind in COMPARED) != (figures > 0):
            yield f"{place.at}: {figures} figures under {place.kind or 'nothing'}"
        if place.kind in COMPARED and not (place.pattern or place.expressions):
            yield f"{place.at}: compared with nothing"
        if place.kind in "~$@<!:*" and not place.source:
            yield f"{place.at}: no source"
        for path in named_paths(place.source):
            if not exists(path):
                yield f"{place.at}: {path} is not there"
        if place.kind == "!" and not any(place.source in page.section(m.start())
                                         for m in place.found(page)):
            yield f"{place.at}: {page.name} does not name \"{place.source}\" beside it"


def check_law(report, page, places):
    report.claim_none(f"{page.name}: lines of its list", list(wrong_lines(page, places)))
    if not any(place.kind == "*" for place in places):
        report.claim_none(f"{page.name}: figures that stand on nothing",
                          uncovered(page, places))


def check_can_fail(report):
    """A figure that is stale, one that nothing covers, and the width of the last digit."""
    place = Place("$", "x", "it is {} +- {} lx, {} m", r"{} \+- {}, {}", "", "")
    page = Page("README.md")
    page.flat = "So it is 3.14 +- 0.02 lx, 1,230 m off, and 5 lx more."
    page.places, page.headings = list(range(len(page.flat))), []
    page.text = page.flat
    for output, wanted in (("3.15 +- 0.02, 1231", [1, 1, 1]), ("3.12 +- 0.03, 1241", [1, 1, 0]),
                           ("3.17 +- 0.04, 1240", [0, 0, 1]), ("none", [0])):
        got = [holds for holds, _, _ in compare(page, place, output)]
        report.claim(got == [bool(w) for w in wanted], f"{output}: {got}")
    report.claim(len(uncovered(page, [place])) == 1, f"uncovered: {uncovered(page, [place])}")
    for old, number, new in (("0.29", 0.274, "0.27"), ("28,700", 28651.3, "28,700"),
                             ("+1.06", 2.345, "+2.35"), ("1.6e-07", 1.74e-7, "1.7e-07"),
                             ("2e-4", 3e-4, "3e-4"), ("-0.5", 0.26, "0.3")):
        report.claim(like(old, number) == new, f"{number} is written {like(old, number)}")


# ---- what needs no program -----------------------------------------------------------------

def log_of(step, program):
    """What a step printed; None without a log, or with one of an older program."""
    log = os.path.join(ROOT, ".build", "logs", step + ".log")
    if not os.path.exists(log) or (program and
                                   os.path.getmtime(log) < os.path.getmtime(program)):
        return None
    with open(log, encoding="utf-8", errors="replace") as file:
        return file.read()


def outputs(report, place, logs, program):
    if place.kind == "<":
        return read(place.source)
    if place.kind == "=":
        return ""
    text = log_of(place.source, program) if logs and place.kind == "@" else None
    if text is None and logs and place.kind == "@":
        report.skip(f"{place.at}: the step {place.source} has not run on this program")
    return text


def main():
    report, words = Report(), sys.argv[1:]
    renew, logs = "--renew" in words, "--logs" in words
    words = [word for word in words if not word.startswith("--")]
    program = words.pop(0) if words and not words[0].endswith(".md") else None
    check_can_fail(report)
    for name in words or all_pages():
        page, places, results = Page(name), read_list(name), []
        check_law(report, page, places)
        for place in places:
            text = outputs(report, place, logs, program)
            if text is not None:
                results += compare(page, place, text)
        compare_all(report, page, results, renew)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
