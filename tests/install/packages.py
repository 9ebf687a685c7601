# SPDX-License-Identifier: Apache-2.0
"""packages.py FOLDER -- the same sources in two folders make the same packages, bit for bit,
with nothing set by whoever builds them; lintian finds no error in them.

FOLDER is made anew and holds both builds; the packages stay in FOLDER/first/.build/release/
packages, for bare_root.py.
"""
import glob
import hashlib
import os
import re
import shutil
import subprocess
import sys

from tree import ROOT, Report, read, run, version

sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
from report import project_files  # noqa: E402

LINES = ("cmake --preset release", "cmake --build .build/release --target product",
         "cpack --config .build/release/CPackConfig.cmake")
OURS = ("parhelion", "parhelion-scenes")


def copy_sources(folder):
    """What is committed, and .git, by which the time of the last commit is known."""
    for name in project_files():
        os.makedirs(os.path.join(folder, os.path.dirname(name)), exist_ok=True)
        shutil.copy(os.path.join(ROOT, name), os.path.join(folder, name))
    if os.path.isdir(os.path.join(ROOT, ".git")):
        shutil.copytree(os.path.join(ROOT, ".git"), os.path.join(folder, ".git"))


def pack(report, folder, umask):
    """{name: SHA-256} of the packages that the documented lines make."""
    bare = {name: os.environ[name] for name in ("PATH", "HOME", "LANG") if name in os.environ}
    for line in LINES:
        done = subprocess.run(["sh", "-c", f"umask {umask}; {line}"], cwd=folder, env=bare,
                              capture_output=True, text=True)
        if not report.claim(done.returncode == 0,
                            f"{line}: {done.stdout[-1500:]}{done.stderr}"):
            return {}
    found = {}
    for path in glob.glob(os.path.join(folder, ".build/release/packages/*.deb")):
        with open(path, "rb") as file:
            found[os.path.basename(path)] = hashlib.sha256(file.read()).hexdigest()
    return found


def field(path, name):
    return run("dpkg-deb", "-f", path, name).stdout.strip()


def check_fields(report, packages):
    names = {field(path, "Package"): path for path in packages}
    report.claim(set(OURS) <= set(names), f"packages: {sorted(names)}")
    for name, path in names.items():
        report.claim(field(path, "Version") == version() + "-1", f"{name}: wrong version")
        for key in ("Maintainer", "Section", "Description", "Source"):
            report.claim(field(path, key), f"{name} has no {key}")
        listed = run("dpkg-deb", "-c", path).stdout
        for file in ("copyright", "changelog.Debian.gz"):
            report.claim(f"./usr/share/doc/{name}/{file}\n" in listed, f"{name} has no {file}")
        places = re.findall(r" (\./\S+)$", listed, re.M)
        report.claim(all(place.startswith("./usr") for place in places), f"{name}: {places}")
    needs = field(names["parhelion"], "Depends")
    for library in ("libc6", "libembree", "libopenimageio", "libopencolorio", "libjansson"):
        report.claim(library in needs, f"parhelion does not depend on {library}: {needs}")
    report.claim(field(names["parhelion-scenes"], "Architecture") == "all", "scenes have a CPU")
    pages = run("dpkg-deb", "-c", names["parhelion"]).stdout.count("/usr/share/man/man")
    report.claim(pages > 25, f"{pages} manual pages only")


def main():
    report = Report()
    folder = os.path.abspath(sys.argv[1])
    shutil.rmtree(folder, ignore_errors=True)
    first, second = (os.path.join(folder, name) for name in ("first", "second/in/a/deeper/one"))
    copy_sources(first)
    shutil.copytree(first, second)
    found = [pack(report, first, "022"), pack(report, second, "077")]
    for line in LINES:
        report.claim(line in read("README.md"), f"README.md does not tell `{line}`")
    report.claim(found[0] and set(found[0]) == set(found[1]), f"packages: {found}")
    for name, digest in found[0].items():
        print(f"{digest}  {name}")
        report.claim(found[1].get(name) == digest, f"{name} differs between the folders")
    packages = glob.glob(os.path.join(first, ".build/release/packages/*.deb"))
    if packages:
        check_fields(report, packages)
        done = run("lintian", "--allow-root", "--fail-on", "error", *packages)
        print(done.stdout)
        report.claim(done.returncode == 0, f"lintian: {done.stdout}{done.stderr}")
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
