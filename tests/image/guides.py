# SPDX-License-Identifier: Apache-2.0
"""guides.py [--keep FOLDER] [--few] [--renew] PARHELION [PAGE ...] -- the guides and the README
do what they say.

Every ```sh block of assets/guides/*.md and of README.md (but for building and installing, which
other tests do) runs as written, each page in a folder of its own where scenes/
and assets/ lie, and its scripts: ```python blocks that begin with their file's name,
`# NAME.py`. A command ends with status 0, or with the one that the page states behind it:
`# status 1`. What it is to write is there afterwards, but for one that is refused (2 to 4), and
so is every file that a page names. Layers of noise that it asks for hold numbers. The figures
of a page are those that its commands print now (figures.py: how they are tied, and what --renew
does).
--keep: what the first page makes stays in the folder; --few: of its review's variants one: each
takes as long as the review.
"""
import contextlib
import glob
import json
import math
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

ROOT = os.path.dirname(os.path.dirname(os.path.dirname(os.path.abspath(__file__))))
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
import figures  # noqa: E402
from exr import Frame  # noqa: E402
from readme import exists, named_paths  # noqa: E402
from report import Report, read  # noqa: E402

SET_UP = ("sh scenes/demo.sh", "sh tests/run.sh", "cd .build/release && alias ",
          "cmake ", "cpack ", "sudo apt ")
DONE, REFUSED = (0, 1), (2, 3, 4)
OUTPUTS = ("-o", "--png", "--report", "--junit")
COLUMNS = 96
WHO = {f"GIT_{who}_{what}": "reader@guide.invalid" for who in ("AUTHOR", "COMMITTER")
       for what in ("NAME", "EMAIL")}  # of the commits of a page


def commands(text):
    """(command, status) of every shell block, continuation lines joined."""
    found = []
    for block in re.findall(r"^```sh\n(.*?)^```", text, re.M | re.S):
        for line in block.replace("\\\n", " ").splitlines():
            match = re.search(r"#\s*status (\d+)", line)
            command = line.split(" #")[0].strip()
            if command and not command.startswith(SET_UP):
                found.append((re.sub(r"\s+", " ", command), int(match[1]) if match else 0))
    return found


def scripts(text):
    """(name, text) of each ```python block that begins with its file's name: `# NAME.py`."""
    return re.findall(r"^```python\n(?=# ([\w-]+\.py)\b)(.*?)^```", text, re.M | re.S)


def outputs(command):
    words = shlex.split(command)
    return [after for word, after in zip(words, words[1:]) if word in OUTPUTS]


@contextlib.contextmanager
def kept(folder):
    """An empty folder that stays."""
    shutil.rmtree(folder, ignore_errors=True)
    os.makedirs(folder)
    yield folder


def shell(command, folder, environment):
    return subprocess.run(["sh", "-c", command], cwd=folder, capture_output=True, text=True,
                          env=environment, timeout=600)


NOISE = ("halves.", "variance.", "display.halves.")


def empty_layers(command, folder):
    """Channels of noise without a number in frames whose layers were asked for; those of
    displays are where one is seen."""
    words, empty = shlex.split(command), []
    for file in outputs(command) if "--layers" in words else []:
        path = os.path.join(folder, file)
        if not file.endswith(".exr") or not os.path.exists(path):
            continue
        channels = Frame(path).channels
        seen = any(value > 0 for value in channels.get("display.coverage", [1]))
        empty += [f"{file}: {name}" for name, values in channels.items()
                  if name.startswith(NOISE) and (seen or not name.startswith("display."))
                  and not any(map(math.isfinite, values))]
    return empty


def compare_figures(name, printed, folder, environment):
    """The figures of a page that its commands print, and those of commands beside them."""
    told = []
    for place in figures.read_list(name):
        text = None
        if place.kind == "~":
            holding = [command for command in printed if place.source in command]
            text = printed.get(place.source, printed[holding[0]] if len(holding) == 1 else None)
            if text is None:
                told.append((False, f"{place.at}: {len(holding)} commands hold "
                                    f"\"{place.source}\"", None))
        if place.kind == "$":
            if place.source not in printed:
                done = shell(place.source, folder, environment)
                printed[place.source] = done.stdout + done.stderr
            text = printed[place.source]
        if text is not None:
            told += figures.compare(figures.Page(name), place, text)
    return told


REVIEW, FEW = os.path.join("scenes", "glance.review.json"), ("a quarter brighter",)


def write_few_variants(folder):
    """Scenes and assets of the folder's own; a request reads nothing behind a link."""
    for shared in ("scenes", "assets"):
        os.remove(os.path.join(folder, shared))
        shutil.copytree(os.path.join(ROOT, shared), os.path.join(folder, shared))
    with open(os.path.join(folder, REVIEW), "r+", encoding="utf-8") as file:
        request = json.load(file)
        request["variants"] = {name: request["variants"][name] for name in FEW}
        file.seek(0)
        file.truncate()
        json.dump(request, file)


def run_page(program, name, text, keep=None, few=False):
    """(claim, message) of every command of a page, in order; it ends at the first failure. And
    what figures.compare says of the page's figures."""
    claims, printed, begun = [], {}, time.monotonic()
    with kept(keep) if keep else tempfile.TemporaryDirectory(prefix="guide-") as folder:
        os.mkdir(os.path.join(folder, "bin"))
        os.symlink(os.path.abspath(program), os.path.join(folder, "bin", "parhelion"))
        for shared in ("scenes", "assets"):
            os.symlink(os.path.join(ROOT, shared), os.path.join(folder, shared))
        if few:
            write_few_variants(folder)
        path = os.path.join(folder, "bin") + os.pathsep + os.environ["PATH"]
        environment = {**os.environ, **WHO, "PATH": path, "ROOT": ROOT}
        for script, body in scripts(text):
            with open(os.path.join(folder, script), "w", encoding="utf-8") as file:
                file.write(body)
        for command, status in commands(text):
            done = shell(command, folder, environment)
            printed[command] = done.stdout + done.stderr
            claims.append((done.returncode == status,
                           f"{name}: status {done.returncode} instead of {status}: {command}\n"
                           f"{done.stderr.strip()[-500:]}"))
            if done.returncode != status:
                break
            claims += [(os.path.exists(os.path.join(folder, file)) == (status in DONE),
                        f"{name}: {file}, status {status}: {command}")
                       for file in outputs(command) if status in DONE + REFUSED]
            empty = empty_layers(command, folder)
            claims.append((not empty, f"{name}: no number in {', '.join(empty)}: {command}"))
        told = compare_figures(name, printed, folder, environment)
    print(f"{name}: {time.monotonic() - begun:.0f} s", flush=True)
    return claims, told


def check_pages(report, program, pages, how):
    keep, few, renew = how
    rest = [None] * len(pages)
    with ThreadPoolExecutor(2) as pool:
        for page, (claims, told) in zip(pages, pool.map(
                lambda page, *how: run_page(program, page, read(page), *how),
                pages, [keep] + rest, [few] + rest)):
            for holds, message in claims:
                report.claim(holds, message)
            figures.compare_all(report, figures.Page(page), told, renew)
    for page in pages:
        for path in named_paths(read(page)):
            report.claim(exists(path), f"{page} names {path}, which is not there")


def run(program, *arguments):
    return subprocess.run([program, *arguments], capture_output=True, text=True, timeout=60)


def listed_commands(program):
    """Every command that `help` lists, and those that `panel --help` does."""
    rows = json.loads(run(program, "help", "--json").stdout)["commands"]
    of_panel = run(program, "panel", "--help").stdout.partition("commands:\n")[2]
    of_panel = of_panel.partition("\n\n")[0].splitlines()
    return [row["name"] for row in rows] + ["panel " + row.split()[0] for row in of_panel]


def check_help(report, program, guides):
    """`help` shows each page as is, and every command's help ends with the page that fits."""
    listed = run(program, "help")
    report.claim(listed.returncode == 0 and listed.stdout == run(program, "--help").stdout,
                 "`help` and `--help` differ")
    for page in guides:
        name = os.path.basename(page)[:-len(".md")]
        text = read(page)
        long_lines = [line for line in text.splitlines() if len(line) > COLUMNS]
        report.claim(not long_lines, f"{page}: too long: {long_lines}")
        report.claim(text.startswith("# "), f"{page} begins with no title")
        shown = run(program, "help", name)
        report.claim(shown.stdout == text and shown.returncode == 0,
                     f"`help {name}` is not {page}, or ends with {shown.returncode}")
        report.claim(f"  {name} " in listed.stdout, f"`help` does not list {name}")
    names = listed_commands(program)
    report.claim({"render", "help", "panel fit"} <= set(names), f"`help` lists only {names}")
    for command in names:
        done = run(program, *command.split(), "--help")
        last = done.stdout.splitlines()[-1]
        named = re.fullmatch(r"guide: parhelion help ([\w-]+)", last)
        report.claim(named and f"assets/guides/{named[1]}.md" in guides,
                     f"{command} --help ends with no guide: {last}")
        report.claim(run(program, "help", *command.split()).stdout == done.stdout,
                     f"`help {command}` is not its --help")
    wrong = run(program, "help", "comparin")
    report.claim(wrong.returncode == 2 and "did you mean comparing?" in wrong.stderr
                 and len(wrong.stderr.splitlines()) == 1, "an unknown guide: " + wrong.stderr)


def check_can_fail(report, program):
    page = "```sh\nparhelion develop missing.exr -o a.png\n```\n"
    report.claim(not all(holds for holds, _ in run_page(program, "made up.md", page)[0]),
                 "a command that fails passes for one that works")
    report.claim(commands("```sh\na \\\n  b   # status 1\n```\n") == [("a b", 1)],
                 "lines are not joined, or statuses not read")
    report.claim(scripts("```python\n# a.py\nb\n```\n```python\nc\n```\n") ==
                 [("a.py", "# a.py\nb\n")], "scripts are not found")


def main():
    report = Report()
    words, keep, few = sys.argv[1:], None, False
    renew = "--renew" in words
    words = [word for word in words if word != "--renew"]
    if words[0] == "--keep":
        keep, words = os.path.abspath(words[1]), words[2:]
    if words[0] == "--few":
        few, words = True, words[1:]
    program = os.path.abspath(words[0])
    guides = [os.path.relpath(path, ROOT)
              for path in sorted(glob.glob(os.path.join(ROOT, "assets/guides/*.md")))]
    report.claim(len(guides) >= 5, "assets/guides holds too few pages")
    check_can_fail(report, program)
    check_help(report, program, guides)
    pages = words[1:] or [*figures.PAGES, *guides]
    check_pages(report, program, pages, (keep, few, renew))
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
