# SPDX-License-Identifier: Apache-2.0
"""exercise.py -- a surface model more, in a copy of the project, as CONTRIBUTING.md lists it:
no other file changes, the copy builds, and the new model obeys all laws that the others do.
"""
import os
import re
import shutil
import subprocess
import sys
import tempfile

from models import listed_files
from report import ROOT, Report, project_files

EXERCISE = os.path.join(ROOT, "tests", "structure", "exercise")
# File, text that is there once, what stands before it from now on.
EDITS = [
    ("shaders/bsdf.h", '#include "shaders/glazing.h"\n', '#include "shaders/dust.h"\n'),
    ("shaders/bsdf.h", "    MODEL(DISPLAY, display,",
     "    MODEL(DUST, dust, Dust)" + " " * 68 + "\\\n"),
    ("CMakeLists.txt", "glazing.c metallic_roughness.c", "dust.c "),
    ("src/path/surface.c", "    } else {\n        set_metallic_roughness(site, surface);",
     "    } else if (m->specular <= 0 && site->metallic <= 0 && site->alpha >= 1)"
     " {\n"
     "        bsdf_be_dust(&surface->bsdf)->grain = spectrum_all(0.3f) * site->base_color;\n"),
    ("tests/unit/test_shaders.c", "static int make_models(void **state)",
     "static void add_dust(void)\n{\n    Model *model = &models[model_count++];\n"
     '    *model = (Model){.name = "dust", .width = 1};\n'
     "    bsdf_be_dust(&model->bsdf)->grain = ramp(0.05f, 0.3f);\n}\n\n"),
    ("tests/unit/test_shaders.c", "    add_plastics();\n    add_metals();",
     "    add_dust();\n"),
]


def git(folder, *words):
    own = {name: value for name, value in os.environ.items() if not name.startswith("GIT_")}
    return subprocess.run(["git", "-c", "user.name=a", "-c", "user.email=a@b", *words], env=own,
                          cwd=folder, capture_output=True, text=True, check=True).stdout


def copy_project(folder):
    for name in project_files():
        path = os.path.join(folder, name)
        os.makedirs(os.path.dirname(path), exist_ok=True)
        shutil.copy(os.path.join(ROOT, name), path)
    git(folder, "init", "-q")
    git(folder, "add", "-A")
    git(folder, "commit", "-q", "-m", "as it is")


def add_model(report, folder):
    for name in ("dust.h", "dust.c"):
        shutil.copy(os.path.join(EXERCISE, name), os.path.join(folder, "shaders"))
    for name, there, before in EDITS:
        path = os.path.join(folder, name)
        with open(path, encoding="utf-8") as file:
            text = file.read()
        report.claim(text.count(there) == 1, f"{name}: {text.count(there)} times {there!r}")
        with open(path, "w", encoding="utf-8") as file:
            file.write(text.replace(there, before + there))


def run(report, folder, *words):
    done = subprocess.run(words, cwd=folder, capture_output=True, text=True, check=False)
    said = done.stdout + done.stderr
    return report.claim(done.returncode == 0, f"{' '.join(words)}: {said[-800:]}") and said


def main():
    report = Report()
    with tempfile.TemporaryDirectory() as folder:
        copy_project(folder)
        add_model(report, folder)
        changed = {line[3:] for line in git(folder, "status", "--porcelain").splitlines()}
        wanted = {name.replace("NAME", "dust") for name in listed_files()}
        report.claim(changed == wanted,
                     f"changed are {sorted(changed)}, listed {sorted(wanted)}")
        report.claim(len(changed) <= 6, f"{len(changed)} files")
        run(report, folder, sys.executable, "tests/structure/models.py")
        said = (run(report, folder, "cmake", "--preset", "release") and
                run(report, folder, "cmake", "--build", ".build/release", "-j2", "--target",
                    "test_shaders", "path") and
                run(report, folder, ".build/release/test_shaders"))
        report.claim(said and re.search(r"\[  PASSED  \] \d+ test", said), "no law was asked")
    report.finish()


if __name__ == "__main__":
    main()
