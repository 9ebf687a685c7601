# SPDX-License-Identifier: Apache-2.0
"""install.py BUILD_FOLDER -- `cmake --install` gives a tree that works wherever it is moved to.

It renders with no view of the sources, names no folder of the build, tells in one line what is
missing; every command and guide has a manual page without a warning, and bash completes every
command, option, value of a list, and file.
"""
import glob
import os
import re
import shutil
import sys
import tempfile

from tree import ROOT, Report, commands, help_json, options, pages, run, version

HIDDEN = 'mount -t tmpfs none "$0" && cd / && exec "$@"'


def install(report, build, folder):
    """The prefix, in another place than it was installed to."""
    first, then = os.path.join(folder, "first"), os.path.join(folder, "moved", "here")
    done = run("cmake", "--install", build, "--prefix", first)
    report.claim(done.returncode == 0, f"cmake --install: {done.stderr}")
    os.makedirs(os.path.dirname(then))
    os.rename(first, then)
    return then


def files_of(folder):
    return [os.path.join(at, name) for at, _, names in os.walk(folder) for name in names]


def check_paths(report, prefix, build):
    """What was built is stripped in packages; here lines' tables stay, which name sources."""
    for path in files_of(prefix):
        with open(path, "rb") as file:
            data = file.read()
        for place in (ROOT, os.path.abspath(build)):
            report.claim(place.encode() not in data, f"{path} names {place}")


def without_sources(words):
    """The words of a command that sees nothing of the checkout, where we may hide it."""
    hidden = ["unshare", "--mount", "sh", "-c", HIDDEN, ROOT]
    can_hide = run(*hidden, "test", "!", "-e", os.path.join(ROOT, "src")).returncode == 0
    return [*hidden, *words] if can_hide else words


def check_render(report, prefix, folder):
    program = os.path.join(prefix, "bin", "parhelion")
    scenes = os.path.join(prefix, "share", "parhelion", "scenes")
    frame, picture = os.path.join(folder, "a.exr"), os.path.join(folder, "a.png")
    done = run(*without_sources([
        program, "render", f"{scenes}/car_dashboard.gltf", f"{scenes}/noon.gltf", "--size",
        "32x18", "--preview", "-o", frame, "--png", picture, "--quiet"]))
    report.claim(done.returncode == 0 and not done.stderr, f"render: {done.stderr}")
    report.claim(os.path.exists(frame) and os.path.exists(picture), "no frame or picture")
    report.claim("denoised" in done.stdout, f"a preview that is not denoised: {done.stdout}")
    for scene in sorted(glob.glob(f"{scenes}/*.gltf")):
        done = run(program, "check", scene)
        report.claim("no such file" not in done.stdout + done.stderr, f"{scene}: {done.stdout}")
    report.claim(help_json(program)["scenes"] == os.path.realpath(scenes),
                 "`help` names another folder of scenes")


def check_missing(report, prefix, folder):
    """Without the part for pictures there is one line that names it, and no frame."""
    program = os.path.join(prefix, "bin", "parhelion")
    part = [path for path in files_of(prefix) if path.endswith("parhelion_pictures.so")]
    report.claim(len(part) == 1, f"parts for pictures: {part}")
    os.rename(part[0], part[0] + ".away")
    done = run(program, "develop", os.path.join(folder, "a.exr"), "-o",
               os.path.join(folder, "b.jpg"))
    os.rename(part[0] + ".away", part[0])
    report.claim(done.returncode == 3 and len(done.stderr.splitlines()) == 1
                 and "parhelion_pictures.so" in done.stderr and "missing" in done.stderr
                 and not os.path.exists(os.path.join(folder, "b.jpg")),
                 f"without its part for pictures: {done.returncode}, {done.stderr}")
    scenes = os.path.join(prefix, "share", "parhelion", "scenes")
    shutil.move(scenes, scenes + ".away")
    text = run(program, "help").stdout
    shutil.move(scenes + ".away", scenes)
    report.claim("scenes/ of the examples: not installed" in text, "scenes seem to be there")


# ---- manual pages ------------------------------------------------------------------------


def rendered(page):
    """A page as man shows it, and what it has to complain of."""
    done = run("man", "--warnings", "-E", "UTF-8", "-l", page,
               env={**os.environ, "MANWIDTH": "80", "LC_ALL": "C.UTF-8"})
    return re.sub(r".\x08", "", done.stdout), done.stderr


def flat(text):
    return re.sub(r"\s+", "", text)


def check_page(report, program, path, words):
    text, complaints = rendered(path)
    report.claim(not complaints and text, f"{path}: {complaints.strip()[:300]}")
    report.claim(run("lexgrog", path).returncode == 0, f"{path}: whatis finds no name in it")
    report.claim(f"Parhelion {version()}" in text, f"{path} tells another version")
    shown = flat(text)
    if "/man1/" in path and words:
        for name, value in options(program, words):
            report.claim(flat(f"{name} {value}") in shown, f"{path} has no {name} {value}")
    if "/man7/" in path:
        guide = run(program, "help", *words).stdout
        for line in re.findall(r"^parhelion .*", guide, re.M):
            report.claim(flat(line) in shown, f"{path} has no line {line}")


def check_pages(report, prefix):
    program = os.path.join(prefix, "bin", "parhelion")
    man = os.path.join(prefix, "share", "man")
    wanted = dict(pages(program))
    found = {os.path.relpath(path, man) for path in files_of(man)}
    report.claim(found == set(wanted), f"pages more or less: {sorted(found ^ set(wanted))}")
    for name, words in sorted(wanted.items()):
        if name in found:
            check_page(report, program, os.path.join(man, name), words)
    made_up = os.path.join(prefix, "made_up.1")
    with open(made_up, "w", encoding="utf-8") as file:
        file.write(".TH A 1\n.SH NAME\na \\- b\n.nonsense\n")
    report.claim(rendered(made_up)[1], "a wrong page passes for a clean one")
    os.remove(made_up)


# ---- completion --------------------------------------------------------------------------

# The words as bash cuts them, at = and : too, and what the function answers.
ASK = r"""
source "$1"; shift; cd "$1"; shift
COMP_WORDS=("$@") COMP_CWORD=$(($# - 1)) COMP_LINE="$*" COMP_POINT=${#COMP_LINE}
$(complete -p parhelion | sed 's/.*-F \([^ ]*\) .*/\1/')
printf '%s\n' "${COMPREPLY[@]}"
"""


class Completion:
    def __init__(self, script, folder):
        self.script, self.folder = script, folder

    def ask(self, line):
        words = [word for word in re.split(r"([=:])|\s", line) if word]
        if line.endswith(" "):
            words.append("")
        done = run("bash", "--norc", "-c", ASK, "bash", self.script, self.folder, *words)
        return set(done.stdout.split()) if not done.stderr else {done.stderr}


def check_values(report, completion, words, option, value):
    """What `--option ` and `--option=` offer: every name of a list."""
    names = {name for name in value.split("|") if re.fullmatch(r"[a-z0-9-]+", name)}
    if "." in value or "FILE" in value or not names:
        return
    for gap in " =":
        line = f"parhelion {' '.join(words)} {option}{gap}"
        report.claim(names <= completion.ask(line), f"`{line}`: {completion.ask(line)}")


def check_completion(report, prefix, folder):
    program = os.path.join(prefix, "bin", "parhelion")
    script = os.path.join(prefix, "share", "bash-completion", "completions", "parhelion")
    told = help_json(program)
    place = os.path.join(folder, "place")
    os.makedirs(os.path.join(place, "deep"))
    for name in ("some.exr", "other.gltf"):
        open(os.path.join(place, name), "w").close()
    completion = Completion(script, place)
    top = {row["name"] for row in told["commands"]}
    report.claim(completion.ask("parhelion ") == top, "not every command is offered")
    report.claim(completion.ask("parhelion ren") == {"render"}, "`ren` is not render")
    with open(os.path.join(prefix, "share/parhelion/assets/schemas/json_answers.md")) as file:
        report.claim("`panel fit`, `panel info`\n\n| key |" in file.read(),
                     "the page of answers has no columns")
    guides = {row["name"] for row in told["guides"]}
    report.claim(completion.ask("parhelion help ") == top | guides, "help offers not all pages")
    for words in commands(told["commands"]):
        listed = options(program, words)
        offered = completion.ask(f"parhelion {' '.join(words)} --")
        wanted = {name for name, _ in listed if name.startswith("--")}
        if words == ("panel",):
            wanted = set()
            report.claim("fit" in completion.ask("parhelion panel "), "panel offers no fit")
        report.claim(wanted <= offered, f"{words}: not offered: {sorted(wanted - offered)}")
        for name, value in listed:
            check_values(report, completion, words, name, value)
    for line, wanted in (("render so", {"some.exr"}), ("render -o so", {"some.exr"}),
                         ("render --checkpoint=so", {"some.exr"}), ("render --size ", set()),
                         ("render --panel a=oth", {"other.gltf"}), ("render --seed ", set()),
                         ("panel info d", {"deep"}), ("render --progress=pl", {"plain"}),
                         ("panel fit --basis ", {"vertex", "haar"})):
        found = completion.ask("parhelion " + line) - {""}
        report.claim(found == wanted, f"`parhelion {line}`: {found} instead of {wanted}")


def main():
    report = Report()
    build = sys.argv[1]
    with tempfile.TemporaryDirectory(prefix="install-") as folder:
        prefix = install(report, build, folder)
        program = os.path.join(prefix, "bin", "parhelion")
        report.claim(run(program, "-V").stdout.startswith(f"parhelion {version()}\n"),
                     "--version tells another version than CMakeLists.txt")
        check_paths(report, prefix, build)
        check_render(report, prefix, folder)
        check_missing(report, prefix, folder)
        check_pages(report, prefix)
        check_completion(report, prefix, folder)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
