# SPDX-License-Identifier: Apache-2.0
"""bare_root.py PACKAGES_FOLDER -- the packages in a bare Debian: installed, used, purged.

A root of the release that this machine runs is made by mmdebstrap, which wants to be root and a
mirror. In it the shipped dashboard is rendered, a panel measured and fitted, manual pages are
read. What appears belongs to a package or to Debian's own records, and nothing is left when
ours are purged.
"""
import glob
import os
import re
import shlex
import shutil
import subprocess
import sys
import tempfile

from tree import Report, run, version

# Where Debian's own programs write while packages come and go.
RECORDS = re.compile(r"/(var/(lib/(dpkg|apt|fontconfig|man-db)|cache|log)|tmp/|opt/desk|"
                     r"etc/ld\.so\.cache)")


def release():
    with open("/etc/os-release", encoding="utf-8") as file:
        return re.search(r"^VERSION_CODENAME=(\w+)", file.read(), re.M)[1]


def files_of(root):
    """Every path below, as it is called inside, but for what the kernel shows there."""
    found = set()
    for at, folders, names in os.walk(root):
        if at == root:
            folders[:] = [name for name in folders if name not in ("proc", "sys", "dev", "run")]
        found.update(os.path.join(at, name)[len(root):] for name in (*names, *folders))
    return found


class Root:
    def __init__(self, folder):
        self.folder = folder

    def run(self, line, patience_s=1800, binds=None):
        """binds: {a folder here: where it is seen there}."""
        mounts = ""
        for here, there in (binds or {}).items():
            os.makedirs(self.folder + there, exist_ok=True)
            mounts += f"mount --bind {shlex.quote(here)} {shlex.quote(self.folder + there)} && "
        return subprocess.run(
            ["unshare", "--mount", "--pid", "--fork", "--kill-child", "sh", "-c",
             f'{mounts}mount -t proc proc "$0/proc" && mount -t devpts devpts "$0/dev/pts" && '
             'exec chroot "$0" env -i '
             'PATH=/usr/sbin:/usr/bin:/sbin:/bin HOME=/opt/desk LC_ALL=C.UTF-8 '
             'DEBIAN_FRONTEND=noninteractive sh -c "$1"', self.folder, line],
            capture_output=True, text=True, timeout=patience_s)

    def packages(self):
        listed = self.run("dpkg-query -W -f '${Package} ${db:Status-Status}\\n'").stdout
        return {line.split()[0] for line in listed.splitlines() if line.endswith(" installed")}

    def files_of_packages(self, names):
        """As dpkg lists them, and where the links of merged folders (/lib) lead."""
        listed = self.run("dpkg -L " + " ".join(sorted(names))).stdout.splitlines()
        return {re.sub(r"^/(bin|sbin|lib\w*)/", r"/usr/\1/", name) for name in listed}


def make(report, folder):
    """A root as `apt` alone wants it; None: there is no mirror, or no right to make one."""
    if os.geteuid():
        return report.skip("a bare root wants root")
    root = os.path.join(folder, "root")
    done = run("mmdebstrap", "--variant=apt", "--include=man-db", release(), root)
    if done.returncode:
        return report.skip("no bare root: " + " ".join(done.stderr.split())[-300:])
    shutil.copy("/etc/resolv.conf", os.path.join(root, "etc"))
    return Root(root)


def step(report, root, line, wanted=""):
    done = root.run(line)
    report.claim(done.returncode == 0 and wanted in done.stdout,
                 f"{line}: {done.returncode}: {done.stdout[-500:]} {done.stderr[-800:]}")
    return done


def use(report, root):
    """What a user does first, in a folder of their own."""
    share = "/usr/share/parhelion"
    root.run("mkdir -p /opt/desk")
    for line, wanted in (
            ("parhelion -V", f"parhelion {version()}"),
            ("parhelion help", f"{share}/scenes"),
            (f"parhelion render {share}/scenes/car_dashboard.gltf {share}/scenes/noon.gltf "
             "--size 64x36 --spp 2 --quiet --layers all -o noon.exr --png noon.png && "
             "test -s noon.png", ""),
            ("parhelion measure noon.exr --display cluster", "cd/m2"),
            (f"parhelion panel simulate {share}/assets/panels/ips_cluster.recipe.json -o set",
             ""),
            ("parhelion panel fit set/MANIFEST.json --level 4 --force -o x.panel --quiet", ""),
            ("parhelion panel eval x.panel --theta 30 --phi 0 --rgb 255,255,255", "cd/m2"),
            ("man parhelion | cat", "EXIT STATUS"),
            ("man 1 parhelion-panel-fit | cat", "--max-error"),
            ("man 7 parhelion-rendering | cat", "first frame"),
            ("whatis parhelion-render", "linear, photometric")):
        step(report, root, "cd /opt/desk && " + line, wanted)
    told = root.run("cd /opt/desk && parhelion help --json > help.json").returncode
    report.claim(told == 0, "help --json fails")


def depends(path):
    return [need for need in run("dpkg-deb", "-f", path, "Depends").stdout.strip().split(", ")
            if need]


def check(report, root, debs):
    ours = {run("dpkg-deb", "-f", path, "Package").stdout.strip() for path in debs}
    for path in debs:
        shutil.copy(path, os.path.join(root.folder, "tmp"))
    names = " ".join("/tmp/" + os.path.basename(path) for path in debs)
    if not report.claim(root.run("apt-get update").returncode == 0, "apt-get update fails"):
        return
    # what the libraries bring, and what their scripts make, is not ours
    needs = ", ".join(need for path in debs for need in depends(path)
                      if need.split()[0] not in ours)
    step(report, root, f"apt-get satisfy -y --no-install-recommends '{needs}'")
    before, had = files_of(root.folder), root.packages()
    step(report, root, f"apt-get install -y --no-install-recommends {names}")
    came = root.packages() - had
    report.claim(came == ours, f"installed: {sorted(came)}")
    installed = files_of(root.folder)
    foreign = installed - before - root.files_of_packages(came)
    report.claim_none("files of no package", sorted(
        name for name in foreign if not RECORDS.match(name)))
    use(report, root)
    report.claim_none("files that use leaves behind", sorted(
        name for name in files_of(root.folder) - installed
        if not RECORDS.match(name)))
    own = root.files_of_packages(ours)
    step(report, root, "apt-get purge -y " + " ".join(sorted(ours)))
    report.claim(not ours & root.packages(), "packages are left after purge")
    left = files_of(root.folder)
    kept = root.files_of_packages(root.packages())
    report.claim_none("files of ours after purge", sorted(
        name for name in (own - kept) & left) + sorted(
        name for name in left if "parhelion" in name.lower() and not RECORDS.match(name)))


def main():
    report = Report()
    debs = sorted(glob.glob(os.path.join(sys.argv[1], "*.deb")))
    report.claim(len(debs) >= 2, f"packages: {debs}")
    with tempfile.TemporaryDirectory(prefix="root-") as folder:
        os.chmod(folder, 0o755)
        root = make(report, folder)
        if root:
            check(report, root, debs)
    report.finish()


if __name__ == "__main__":
    sys.exit(main())
