# SPDX-License-Identifier: Apache-2.0
"""regression.py PARHELION -- the workflow that ships (assets/ci) does what its page says: its
steps run as they stand in the file, in a repository of their own with a small scene, by
stand-ins for what only a CI service has. The same pictures pass, other ones fail with a report,
`accept` takes them over, and what cannot be done is one line.
"""
import json
import os
import shutil
import subprocess
import sys
import tarfile
import tempfile
import xml.etree.ElementTree as xml

import yaml

from exr import Frame
from gltf import Scene

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import Report, read  # noqa: E402

WORKFLOW = "assets/ci/regression.yml"
OPTIONS = "--size 48x32 --spp 16 --no-guiding"
ARTEFACTS = ("report.html", "compare.txt", "compare.json", "junit.xml")
ADDRESS = "https://packages.invalid/parhelion.tar"
# Stand-ins: each notes its words, and curl brings the tar file that lies beside it.
NOTE = '#!/bin/sh\necho "${0##*/} $*" >>"$NOTES"\n'
CURL = NOTE + 'while [ $# -gt 1 ]; do [ "$1" = -o ] && cp "$TAR" "$2"; shift; done\n'


def write_scene(path, lux):
    """A box with a lamp in it and a ball of metal."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.6), [-1, 0, -1], [1, 2, 1])
    scene.facing_quad(scene.emitter(lux), [0, 1.99, 0], [0, -1, 0], 0.8)
    scene.sphere(scene.metal(0.8, 0.3), [0.3, 0.4, -0.4], 0.4, rings=8)
    scene.view("eye", [0, 1, 0.95], [0, -0.1, -1], 70)
    scene.write(path)


class Project:
    """A repository that has the workflow, as its page says to copy it, and a runner for it."""

    def __init__(self, report, program, folder):
        self.report, self.folder = report, os.path.join(folder, "project")
        self.away = os.path.join(folder, "runner")
        self.steps = list(steps_of(yaml.safe_load(read(WORKFLOW))))
        os.makedirs(self.away)
        os.makedirs(os.path.join(self.folder, "ci"))
        os.makedirs(self.path("scenes"))
        tools = os.path.join(folder, "tools")
        os.makedirs(tools)
        os.symlink(os.path.abspath(program), os.path.join(tools, "parhelion"))
        for name, text in (("apt-get", NOTE), ("curl", CURL)):
            self.write(os.path.join(tools, name), text)
            os.chmod(os.path.join(tools, name), 0o755)
        with tarfile.open(os.path.join(folder, "packages.tar"), "w") as tar:
            for name in ("parhelion_1_amd64.deb", "parhelion-scenes_1_all.deb"):
                self.write(os.path.join(folder, name), "")
                tar.add(os.path.join(folder, name), name)
        self.environment = {
            **os.environ, "PATH": tools + os.pathsep + os.environ["PATH"], "HOME": self.away,
            "NOTES": os.path.join(self.away, "notes"),
            "TAR": os.path.join(folder, "packages.tar"),
            "GITHUB_WORKSPACE": self.folder, "RUNNER_TEMP": self.away,
            "GITHUB_STEP_SUMMARY": os.path.join(self.away, "summary"),
            "PARHELION_PACKAGES": ADDRESS, "PARHELION_OPTIONS": OPTIONS,
            **{f"GIT_{who}_{what}": "a@b.invalid" for who in ("AUTHOR", "COMMITTER")
               for what in ("NAME", "EMAIL")}}

    def path(self, *names):
        return os.path.join(self.folder, *names)

    def write(self, path, text):
        with open(self.path(path), "w", encoding="utf-8") as file:
            file.write(text)

    def run(self, *words, **environment):
        return subprocess.run(words, cwd=self.folder, capture_output=True, text=True,
                              timeout=600, env={**self.environment, **environment})

    def script(self, *words, **environment):
        return self.run("sh", "ci/regression.sh", *words, **environment)

    def commit(self, why):
        done = [self.run("git", "add", "-A"), self.run("git", "commit", "-qm", why)]
        self.report.claim(not any(d.returncode for d in done), f"git: {done}")

    def workflow(self):
        """(name, result) of the steps that ran, by the rules of a job: after a failure only
        those run that ask for it."""
        results, failed = [], False
        for step in self.steps:
            if "run" not in step or failed and "cancelled" not in str(step.get("if", "")):
                continue
            done = self.run("sh", "-e", "-c", step["run"])
            failed = failed or done.returncode != 0
            results.append((step["name"], done))
        return results

    def claim_workflow(self, what, ended_by=None, status=0, words=()):
        """All steps pass, or the one named ended_by ends with a status."""
        results = self.workflow()
        told = "".join(done.stdout + done.stderr for _, done in results)
        failed = [(name, done.returncode) for name, done in results if done.returncode]
        self.report.claim(failed == ([(ended_by, status)] if ended_by else []),
                          f"{what}: failed {failed}: {told}")
        self.report.claim(all(word in told for word in words), f"{what}: no {words}: {told}")


def steps_of(workflow):
    for job in workflow["jobs"].values():
        yield from job["steps"]


def check_file(report, project):
    """What a service reads of it: the keys, and that artefacts are what the script writes."""
    workflow = yaml.safe_load(read(WORKFLOW))
    report.claim(set(workflow) == {"name", True, "permissions", "defaults", "jobs"},
                 f"keys: {set(workflow)}")  # `on` is a boolean in YAML 1.1
    report.claim(workflow[True]["schedule"][0]["cron"].count(" ") == 4, "no five fields")
    report.claim(workflow["defaults"]["run"]["shell"] == "sh -e {0}", "another shell")
    job = workflow["jobs"]["frames"]
    report.claim(set(job) == {"runs-on", "container", "timeout-minutes", "env", "steps"},
                 f"a job's keys: {set(job)}")
    for step in project.steps:
        report.claim(("run" in step) != ("uses" in step) and set(step) <= {
            "name", "run", "uses", "with", "if"}, f"a step: {step}")
        report.claim("${{" not in step.get("run", "") and "@v" in step.get("uses", "@v"),
                     f"a step: {step}")
    kept = project.steps[-1]["with"]["path"].split()
    report.claim(set(kept) == {f"ci/out/{name}" for name in ARTEFACTS}
                 | {"ci/out/reference/", "ci/out/today/"}, f"kept: {kept}")
    words = {key: value for key, value in job["env"].items() if "${{" not in value}
    report.claim(words["PARHELION_OPTIONS"] in read("assets/ci/regression.sh"),
                 "options of the workflow and of the script differ")


STEP = "Render the frames that are missing, and compare"


def check_first(report, project):
    """Before anything was accepted, and then the first time."""
    project.claim_workflow("nothing accepted", STEP, 3,
                           ["no commit has ci/accepted", "accept WHY"])
    done = project.script("accept")
    report.claim(done.returncode == 3 and "a word on why is required" in done.stderr, str(done))
    report.claim(project.script("accept", "the first").returncode == 0, "accept fails")
    project.commit("accepted")
    project.claim_workflow("first", words=["equal in every pixel", "same: 2 of 2"])
    for name in ARTEFACTS:
        report.claim(os.path.getsize(project.path("ci", "out", name)) > 0, f"no {name}")
    with open(project.path("ci/out/compare.json"), encoding="utf-8") as file:
        answer = json.load(file)
    report.claim(answer["same"] and len(answer["pairs"]) == 2, f"answer: {answer}")
    with open(os.path.join(project.away, "notes"), encoding="utf-8") as file:
        notes = file.read()
    report.claim(ADDRESS in notes and "parhelion_1_amd64.deb" in notes
                 and "parhelion-scenes_1_all.deb" in notes, f"installed: {notes}")
    report.claim(not project.run("git", "status", "--porcelain").stdout, "git sees the frames")


def check_change(report, project):
    """A lamp of 3 % more light is found, and taken over by `accept` alone."""
    write_scene(project.path("scenes", "box.gltf"), 515)
    project.commit("more light")
    project.claim_workflow("more light", STEP, 1, ["different", "wide.exr", "near.exr"])
    failures = xml.parse(project.path("ci/out/junit.xml")).getroot().iter("failure")
    report.claim(len(list(failures)) == 2, "junit.xml tells other failures")
    with open(os.path.join(project.away, "summary"), encoding="utf-8") as file:
        report.claim("different" in file.read(), "the summary does not tell it")
    project.script("accept", "a brighter lamp")
    project.commit("brighter lamp accepted")
    project.claim_workflow("accepted", words=["same"])


def check_views(report, project):
    """A new view passes until it is accepted, one that is gone does not."""
    with open(project.path("ci", "views"), "a", encoding="utf-8") as file:
        file.write("# dimmer\n\nhigh scenes/box.gltf --eye 0,1.8,0.9 --look-at '0,0,0'\n")
    project.commit("a view")
    project.claim_workflow("a new view")
    report.claim(os.path.exists(project.path("ci/out/today/high.exr")), "no new frame")
    project.write("ci/views", "wide scenes/box.gltf\n")
    project.commit("a view less")
    project.claim_workflow("a view less", STEP, 1, ["near.exr"])


def layers_of(path):
    """Names of the frame's channels without their last part."""
    return {name.rpartition(".")[0] for name in Frame(path).channels} - {""}


def check_broken(report, project):
    """A broken view hides no other: each is tried, the broken one is an error by its name, and
    the status is 3. Then limits, a mask and regions of one view alone."""
    project.environment["PARHELION_OPTIONS"] = "--size 24x16 --spp 8 --no-guiding"
    shutil.rmtree(project.path("ci/out/reference"))
    views = ("broken scenes/no_such.gltf\nquote scenes/box.gltf --camera 'eye\n"
             "deep/wide scenes/box.gltf --layers variance --isa=sse2\n"
             "wide scenes/box.gltf\n"
             "last scenes/box.gltf --eye 0,1,0.5 --look-at 0,0.8,-1")
    project.write("ci/views", views)
    project.commit("broken views, and a last line without its end")
    project.claim_workflow("broken views", STEP, 3, ["view broken: parhelion: ",
                                                     "no_such.gltf", "view quote: "])
    cases = xml.parse(project.path("ci/out/junit.xml")).getroot().iter("testcase")
    found = {case.get("name"): [part.tag for part in case if part.tag in ("error", "failure")]
             for case in cases}
    report.claim(found == {"broken.exr": ["error"], "quote.exr": ["error"], "wide.exr": [],
                           "near.exr": ["failure"]}, f"junit.xml of broken views: {found}")
    report.claim(sorted(os.listdir(project.path("ci/out/today"))) == [
        "broken.exr.failed", "deep", "last.exr", "quote.exr.failed", "wide.exr"],
        f"frames: {os.listdir(project.path('ci/out/today'))}")
    report.claim(layers_of(project.path("ci/out/today/deep/wide.exr")) == {"variance"}
                 and layers_of(project.path("ci/out/today/last.exr")) == {
                     "variance", "display.emitted", "display.reflected", "display.white",
                     "display.black", "display.variance", "samples", "id", "display"},
                 f"layers: {layers_of(project.path('ci/out/today/last.exr'))}")
    write_scene(project.path("scenes", "box.gltf"), 515)
    project.write("ci/views", views.replace("last", "near", 1))
    project.script("accept", "what is broken")
    project.commit("what is broken is accepted")
    project.claim_workflow("a broken reference", STEP, 3, ["2 failed"])
    write_scene(project.path("scenes", "box.gltf"), 530)
    project.write("ci/views", views.replace("last", "near", 1).partition("'eye\n")[2])
    project.write("ci/limits", "wide --max mean_shift=0.05\nnear --region 0,0,4,4 --region "
                  "8,8,12,12 --max mean_shift=0.1")
    project.commit("more light, within limits of two views")
    done = project.script()
    report.claim(done.returncode == 3 and "within limits near.exr: " in done.stdout
                 and "within limits wide.exr: " in done.stdout
                 and "different     deep/wide.exr" in done.stdout, f"limits of views: {done}")
    project.write("ci/views", "wide scenes/box.gltf\nwide scenes/box.gltf")
    done = project.script("today")
    report.claim(done.returncode == 3 and "wide twice" in done.stderr, f"twice: {done}")
    os.remove(project.path("ci", "limits"))
    project.write("ci/views", "wide scenes/box.gltf\n")
    project.environment["PARHELION_OPTIONS"] = OPTIONS
    project.script("accept", "one view")
    project.commit("one view accepted")
    project.claim_workflow("mended", words=["same: 1 of 1"])


def check_noise(report, project):
    """Frames from elsewhere, and of other noise, are told by their statistics."""
    kept = os.path.join(project.away, "kept")
    shutil.copytree(project.path("ci/out/today"), kept)
    elsewhere = {"PARHELION_REFERENCE": kept, "PARHELION_OPTIONS": OPTIONS + " --seed 7"}
    done = project.script(**elsewhere)
    report.claim(done.returncode == 0 and "noise" in done.stdout, f"another seed: {done}")
    write_scene(project.path("scenes", "box.gltf"), 900)
    done = project.script(**elsewhere)
    report.claim(done.returncode == 1, f"another seed, much more light: {done}")


def check_refused(report, project):
    """What cannot be done: never status 0 or 1, and a line that says what."""
    project.write("scenes/box.gltf", "{}")
    done = project.script("today")
    report.claim(done.returncode == 3 and "box.gltf" in done.stderr, f"broken scene: {done}")
    report.claim(not os.path.exists(project.path("ci/out/today/wide.exr")),
                 "a frame of a broken scene")
    done = project.script("yesterday")
    report.claim(done.returncode == 3 and "required: reference" in done.stderr, f"a word: "
                                                                                f"{done}")
    shallow = os.path.join(project.away, "shallow")
    project.run("git", "clone", "-q", "--depth", "1", "file://" + project.folder, shallow)
    project.folder = shallow
    done = project.script("reference")
    report.claim(done.returncode == 3 and "without history" in done.stderr, f"shallow: {done}")


def main():
    report = Report()
    with tempfile.TemporaryDirectory(prefix="regression-") as folder:
        project = Project(report, sys.argv[1], folder)
        check_file(report, project)
        shutil.copy(os.path.join(ROOT, "assets/ci/regression.sh"), project.path("ci"))
        project.write("ci/views", "wide scenes/box.gltf\n"
                      "near  scenes/box.gltf --eye 0,1,0.5 --look-at 0,0.8,-1\n")
        write_scene(project.path("scenes", "box.gltf"), 500)
        project.run("git", "init", "-q")
        project.commit("scenes")
        for check in (check_first, check_change, check_views, check_broken, check_noise,
                      check_refused):
            check(report, project)
    report.finish()


if __name__ == "__main__":
    main()
