# SPDX-License-Identifier: Apache-2.0
"""module.py BUILD_DIR -- parhelion_panel.py: shapes and broadcasting, what is refused and in
which words, copies, forks and pickles, where it finds the library, threads, draws of the
reflection and of the emission against their densities, what is measured, and the example that
draws a viewing cone. Ends with what a question costs, which nothing is claimed of.
"""
import copy
import multiprocessing
import multiprocessing.pool
import os
import pathlib
import pickle
import shutil
import subprocess
import sys
import tempfile
import time
from concurrent.futures import ThreadPoolExecutor

HERE = os.path.dirname(os.path.abspath(__file__))
sys.path[:0] = [os.path.join(os.path.dirname(HERE), "structure"), HERE]
import panels  # noqa: E402
panels.use_numpy()

import numpy  # noqa: E402
from agreement import Questions  # noqa: E402
from layout import lines_of  # noqa: E402
from report import ROOT, Report  # noqa: E402

LIBRARY = os.path.join(ROOT, "src", "library")
sys.path.insert(0, LIBRARY)
PANEL = panels.shipped("ips_cluster")
NM = [450, 550, 650]


def refusal(call):
    from parhelion_panel import PanelError
    try:
        call()
    except PanelError as fault:
        return str(fault)
    return ""


def check_shapes(report, panel):
    z, white = [0, 0, 1], [255, 255, 255]
    many = Questions(12, 1).viewer.reshape(3, 4, 3)
    for what, array, shape in (
            ("one XYZ", panel.emission_xyz(z, white), (3,)),
            ("codes", panel.emission_xyz(z, [white] * 5), (5, 3)),
            ("both", panel.emission_xyz(many, [[white]] * 3), (3, 4, 3)),
            ("spectra", panel.emission_spectrum(many, white, NM), (3, 4, 3)),
            ("one wavelength", panel.brdf(many, z, 550), (3, 4, 1)),
            ("twenty", panel.brdf(z, z, range(400, 600, 10)), (20,)),
            ("mirror", panel.mirror(many, NM), (3, 4, 3)), ("pdf", panel.pdf(many, z), (3, 4)),
            ("albedo", panel.albedo(many), (3, 4)), ("none", panel.emission_xyz(
                numpy.zeros((0, 3)), white), (0, 3))):
        report.claim(array.shape == shape and array.dtype == numpy.float32,
                     f"{what}: shape {array.shape} of {array.dtype}")
    light, density = panel.sample(many, [0.5, 0.5, 0.5])
    report.claim(light.shape == (3, 4, 3) and density.shape == (3, 4), "shapes of draws")
    alone = numpy.array([[panel.emission_xyz(d, white) for d in row] for row in many])
    report.claim(numpy.array_equal(alone, panel.emission_xyz(many, white)),
                 "an array's answers are not those of its questions alone")
    wide = panel.brdf(z, z, range(400, 600, 10))
    report.claim(numpy.array_equal(wide[5:6], panel.brdf(z, z, [450])),
                 "an answer depends on the wavelengths beside it")


def check_info(report, panel):
    info = panel.info()
    report.claim(info["emits"] and info["reflects"] and info["has_mirror"]
                 and info["is_polarised"] and not info["varies"], f"info: {info}")
    report.claim(info["emission_nm"] == (360, 830) and info["reflection_nm"] == (400, 700)
                 and not info["has_zones"], f"info: {info}")


def check_refused(report, folder):
    from parhelion_panel import Panel
    panel = Panel(PANEL)
    for call, words in (
            (lambda: Panel("gone.panel"), "gone.panel"),
            (lambda: Panel(os.path.join(ROOT, "README.md")), "is no panel file"),
            (lambda: Panel(b"PHPANEL\n"), "is no panel file"),
            (lambda: panel.emission_xyz([0, 1], [255] * 3), "viewer has shape (2,)"),
            (lambda: panel.emission_xyz(1, [255] * 3), "required: 3 numbers"),
            (lambda: panel.pdf([0, 0, 1], [0, 0, 1], place=[1, 2, 3]), "place has shape")):
        said = refusal(call)
        report.claim(words in said and "\n" not in said, f"{words!r} is not in {said!r}")
    with open(PANEL, "rb") as file:
        same = Panel(file.read())
    ask = ([0, 0.6, 0.8], [10, 20, 30])
    report.claim(numpy.array_equal(same.emission_xyz(*ask), panel.emission_xyz(*ask)),
                 "the bytes of a file give other answers than the file")
    panel.close()
    report.claim("closed" in refusal(lambda: panel.emission_xyz([0, 0, 1], [255] * 3)),
                 "a closed panel is asked")
    told = dict(line.split()[1:3] for line in lines_of(
        os.path.join(LIBRARY, "parhelion_panel.h"), LIBRARY, folder).splitlines())
    import ctypes
    import parhelion_panel
    for name, struct in (("Info", parhelion_panel._Info),
                         ("Questions", parhelion_panel._Questions)):
        here = {f"ParhelionPanel{name}.{field}": str(getattr(struct, field).offset)
                for field, _ in struct._fields_}
        here[f"ParhelionPanel{name}"] = str(ctypes.sizeof(struct))
        report.claim(all(told.get(key) == value for key, value in here.items())
                     and sum(key.startswith(f"ParhelionPanel{name}") for key in told)
                     == len(here), f"the module's {name} is not the header's: {here}")


def in_fork(call):
    """What a forked process says, and how it ended."""
    read, write = os.pipe()
    child = os.fork()
    if not child:
        try:
            said = repr(call())
        except Exception as fault:  # pylint: disable=broad-except
            said = f"{type(fault).__name__}: {fault}"
        os.write(write, said.encode())
        sys.stdout.flush()
        sys.exit(0)  # with what __del__ frees
    os.close(write)
    with os.fdopen(read) as file:
        said = file.read()
    return said, os.waitpid(child, 0)[1]


def check_copies(report):
    """Copied, pickled, forked, closed: the same answers, or one exception; never a crash."""
    from parhelion_panel import Panel, PanelError
    ask = ([0, 0.6, 0.8], [10, 20, 30])
    wanted = Panel(PANEL).emission_xyz(*ask).tolist()

    class Derived(Panel):
        pass
    for make in (copy.copy, copy.deepcopy, lambda p: copy.deepcopy({"a": [p, p]})["a"][1],
                 lambda p: copy.copy(copy.copy(p)), lambda p: copy.deepcopy(copy.copy(p))):
        for kind in (Panel, Derived):
            for closes_first in (True, False):
                one = kind(PANEL)
                two = make(one)
                (one if closes_first else two).close()
                left = two if closes_first else one
                closed = one if closes_first else two
                del one, two
                report.claim(left.emission_xyz(*ask).tolist() == wanted
                             and type(left) is kind, "a copy answers otherwise")
                report.claim("closed" in refusal(closed.info), "a closed copy is asked")
                left.close()
                left.close()
                report.claim("closed" in refusal(left.info), "closed twice, asked")
    panel = Panel(PANEL)
    for thing in (panel, [panel], {"p": panel}, copy.copy(panel), panel.info):
        for protocol in range(pickle.HIGHEST_PROTOCOL + 1):
            said = refusal(lambda thing=thing, p=protocol: pickle.dumps(thing, p))
            report.claim("cannot be pickled: open its file in each process" in said,
                         f"pickled, {protocol}: {said!r}")
    for method in ("spawn", "forkserver"):
        worker = multiprocessing.get_context(method).Process(target=print, args=(panel,))
        report.claim("cannot be pickled" in refusal(worker.start), f"a process by {method}")
    with multiprocessing.get_context("fork").Pool(2) as pool:
        said = refusal(lambda: pool.map(Panel.info, [panel] * 4))
        report.claim("cannot be pickled" in said, f"a pool: {said!r}")
        try:
            pool.apply(Panel, (PANEL,))
            said = "done"
        except multiprocessing.pool.MaybeEncodingError as fault:
            said = str(fault)
        report.claim("cannot be pickled" in said, f"a pool's answer: {said!r}")
    for call, says in ((lambda: panel.emission_xyz(*ask).tolist(), repr(wanted)),
                       (lambda: panel.close() or panel.info(), "PanelError: the panel is closed"),
                       (panel.close, "None"),
                       (lambda: copy.deepcopy(panel).emission_xyz(*ask).tolist(), repr(wanted))):
        report.claim(in_fork(call) == (says, 0), f"forked: {in_fork(call)}, not {says}")
    report.claim(panel.emission_xyz(*ask).tolist() == wanted, "after forks")
    for source in ("a\0b", PANEL + "\0", "\0", pathlib.Path("a\0b")):
        said = refusal(lambda source=source: Panel(source))
        report.claim("has a zero byte" in said and "\n" not in said, f"{source!r}: {said!r}")
    empty = Panel.__new__(Panel)
    report.claim("closed" in refusal(empty.info) and empty.close() is None, "never opened")
    questions = Questions(4000, 3)
    for _ in range(20):  # what is asked while another thread closes is answered, or refused
        shared = Panel(PANEL)

        def use(i, shared=shared):
            if i == 3:
                return shared.close()
            try:
                return shared.emission_xyz(questions.viewer, questions.code)
            except PanelError as fault:
                return str(fault)
        with ThreadPoolExecutor(4) as pool:
            answers = list(pool.map(use, range(12)))
        report.claim(all(a is None or isinstance(a, numpy.ndarray) or "closed" in a
                         for a in answers), "closed while it is asked")


def check_found(report, build, folder):
    """By name, beside the module, in an installation; and what is said where it is not."""
    place = os.path.join(folder, "prefix", "lib", "python3", "dist-packages")
    os.makedirs(place)
    shutil.copy(os.path.join(LIBRARY, "parhelion_panel.py"), place)
    plain = {key: value for key, value in os.environ.items()
             if key not in ("PARHELION_PANEL_LIBRARY", "LD_LIBRARY_PATH")}

    def says(**more):
        done = subprocess.run(
            [sys.executable, "-B", "-c", "import parhelion_panel; "
             "print(parhelion_panel._library()._name)"],
            capture_output=True, text=True, cwd=place, env={**plain, **more})
        return done.stdout + done.stderr
    gone = says(PARHELION_PANEL_LIBRARY="gone.so")
    report.claim("PanelError" in gone and "gone.so" in gone, f"a library that is gone: {gone}")
    for where in (os.path.join(folder, "prefix", "lib", "x86_64-linux-gnu"), place):
        os.makedirs(where, exist_ok=True)
        shutil.copy(os.path.join(build, "libparhelion-panel.so.2"), where)
        said = says()
        report.claim(os.path.join(where, "libparhelion-panel.so.2") in os.path.normpath(
            said.split()[-1]), f"not found in {where}: {said}")


def check_threads(report, panel):
    q = Questions(4000, 3)

    def ask(_):
        return (panel.emission_xyz(q.viewer, q.code), panel.brdf(q.viewer, q.light, NM))
    alone = ask(0)
    with ThreadPoolExecutor(4) as pool:
        answers = list(pool.map(ask, range(8)))
    report.claim(all(numpy.array_equal(a, b) for answer in answers
                     for a, b in zip(answer, alone)), "threads get other answers")


def rings_about(axis, steps=900, turns=360):
    """Directions above the surface in rings about an axis, dense near it, and their sizes."""
    edge = numpy.pi * (numpy.arange(steps + 1) / steps) ** 3
    theta = 0.5 * (edge[1:] + edge[:-1])
    phi = 2 * numpy.pi * (numpy.arange(turns) + 0.5) / turns
    size = numpy.repeat((numpy.cos(edge[:-1]) - numpy.cos(edge[1:])) * 2 * numpy.pi / turns,
                        turns)
    theta, phi = numpy.repeat(theta, turns), numpy.tile(phi, steps)
    axis = numpy.array(axis, float)
    x = numpy.cross([0, 1, 0], axis)
    x /= numpy.linalg.norm(x)
    local = numpy.stack([numpy.sin(theta) * numpy.cos(phi), numpy.sin(theta) * numpy.sin(phi),
                         numpy.cos(theta)], 1)
    all_ = local @ numpy.stack([x, numpy.cross(axis, x), axis])
    return all_[all_[:, 2] > 0], size[all_[:, 2] > 0]


def check_draws(report, panel):
    """The mean of f cos / density over draws is the integral over rings."""
    for viewer in ([0, 0, 1], [0.6, 0, 0.8]):
        random = numpy.random.default_rng(5).random((60000, 3))
        light, density = panel.sample(viewer, random)
        f = panel.brdf(viewer, light, [550])[:, 0] * light[:, 2]
        told = panel.pdf(viewer, light)
        report.claim(numpy.quantile(numpy.abs(told / density - 1), 0.999) < 1e-3,
                     "densities of draws are not those of pdf")
        drawn = f / density
        grid, size = rings_about([-viewer[0], -viewer[1], viewer[2]])
        integral = float(panel.brdf(viewer, grid, [550])[:, 0] @ (grid[:, 2] * size))
        sigma = drawn.std() / len(drawn) ** 0.5
        report.claim(abs(drawn.mean() - integral) < 4 * sigma + 1e-3 * integral,
                     f"drawn {drawn.mean()} +- {sigma}, integral {integral}")
        whole = float(panel.pdf(viewer, grid) @ size)
        report.claim(abs(whole - 1) < 2e-3, f"the density's integral is {whole}")


def fine_grid(rows, columns, inside):
    """Directions in equal cells of z and phi, inside^2 each."""
    z = (numpy.arange(rows * inside) + 0.5) / (rows * inside)
    phi = (numpy.arange(columns * inside) + 0.5) / (columns * inside) * 2 * numpy.pi
    z, phi = (a.reshape(rows, inside, columns, inside).swapaxes(1, 2).reshape(
        rows * columns, inside ** 2) for a in numpy.meshgrid(z, phi, indexing="ij"))
    s = numpy.sqrt(1 - z * z)
    return numpy.stack([s * numpy.cos(phi), s * numpy.sin(phi), z], -1)


def check_emission_draws(report, name, code, count=40000):
    """Density and draws agree (chi-square), its integral is 1, the light over it is even."""
    from parhelion_panel import Panel
    what, rows, columns = f"{name} {code}", 16, 24
    with Panel(panels.shipped(name)) as panel:
        random = numpy.random.default_rng(7).random((count, 3))
        viewer, density = panel.sample_emission(code, random)
        if not panel.emission_xyz([0, 0, 1], code)[1] > 0:
            report.claim(not density.any() and not panel.pdf_emission([0, 0, 1], code),
                         f"{what}: directions of no light")
            return
        report.claim(numpy.array_equal(density, panel.pdf_emission(viewer, code)),
                     f"{what}: densities of draws are not those of pdf")
        grid = fine_grid(rows, columns, 24)
        share = panel.pdf_emission(grid, code).mean(-1) * 2 * numpy.pi / (rows * columns)
        report.claim(abs(share.sum() - 1) < 1e-3, f"{what}: the integral is {share.sum()}")
        phi = numpy.arctan2(viewer[:, 1], viewer[:, 0]) / (2 * numpy.pi) % 1
        cell = (numpy.minimum((viewer[:, 2] * rows).astype(int), rows - 1) * columns
                + numpy.minimum((phi * columns).astype(int), columns - 1))
        wanted = count * share / share.sum()
        found = numpy.bincount(cell, minlength=rows * columns)
        thin = wanted < 5  # counted together
        wanted = numpy.append(wanted[~thin], max(wanted[thin].sum(), 1e-9))
        found = numpy.append(found[~thin], found[thin].sum())
        square = float(((found - wanted) ** 2 / wanted)[wanted > 1e-3].sum())
        report.claim(square < len(wanted) + 5 * (2 * len(wanted)) ** 0.5,
                     f"{what}: chi-square {square:.0f} of {len(wanted)} cells")
        light = panel.emission_xyz(viewer, code)[:, 1] * viewer[:, 2] / density
        exact = float((panel.emission_xyz(grid, code)[..., 1] * grid[..., 2]).mean()
                      * 2 * numpy.pi)
        sigma = float(light.std()) / count ** 0.5
        report.claim(abs(light.mean() - exact) < 4 * sigma + 1e-3 * exact and
                     light.std() < 0.2 * light.mean(),
                     f"{what}: drawn {light.mean()} +- {sigma}, {exact} in the mean")


def check_measured(report, panel):
    q, cone = Questions(400, 6), panel.info()["emission_cone"]
    told = panel.emission_xyz(q.viewer, q.code, measured=True)[1]
    report.claim(0 < told.mean() < 1 and told[q.viewer[:, 2] > numpy.cos(cone) + 1e-4].all()
                 and not told[q.viewer[:, 2] < numpy.cos(cone) - 1e-4].any(),
                 "emission: measured or not")


def check_example(report, folder):
    script = os.path.join(LIBRARY, "viewing_cone.py")
    for name, start in (("cone.png", b"\x89PNG"), ("cone.svg", b"<svg")):
        out = os.path.join(folder, name)
        done = subprocess.run([sys.executable, "-B", script, PANEL, "-o", out],
                              capture_output=True, text=True)
        if name.endswith("png") and "Pillow" in done.stderr:
            report.skip("the example's PNG: Pillow is not there")
            continue
        report.claim(done.returncode == 0 and "905.8 cd/m2" in done.stdout,
                     f"the example says {done.stdout}{done.stderr}")
        with open(out, "rb") as file:
            report.claim(file.read().startswith(start), f"{name} is something else")
    done = subprocess.run([sys.executable, "-B", script, "gone.panel"], capture_output=True,
                          text=True)
    report.claim(done.returncode == 1 and "gone.panel" in done.stderr
                 and "Traceback" not in done.stderr, f"a panel that is gone: {done.stderr}")


def tell_costs(panel):
    q = Questions(100000, 2)
    q.light = numpy.ascontiguousarray(q.light, numpy.float32)
    sixteen = numpy.linspace(400, 700, 16, dtype=numpy.float32)
    for name, ask in (
            ("XYZ", lambda n: panel.emission_xyz(q.viewer[:n], q.code[:n])),
            ("spectrum, 16 wavelengths", lambda n: panel.emission_spectrum(
                q.viewer[:n], q.code[:n], sixteen)),
            ("BRDF, 16 wavelengths", lambda n: panel.brdf(q.viewer[:n], q.light[:n], sixteen)),
            ("draw", lambda n: panel.sample(q.viewer[:n], q.code[:n] / 256)),
            ("pdf", lambda n: panel.pdf(q.viewer[:n], q.light[:n]))):
        times = []
        for count, repeats in ((1, 300), (len(q.viewer), 1)):
            start = time.process_time()
            for _ in range(repeats):
                ask(count)
            times.append((time.process_time() - start) / repeats / count)
        print(f"{name}: {1e6 * times[0]:.1f} microseconds alone, {1e9 * times[1]:.0f} "
              "nanoseconds in an array")


def main():
    build, report = os.path.abspath(sys.argv[1]), Report()
    os.environ["PARHELION_PANEL_LIBRARY"] = os.path.join(build, "libparhelion-panel.so.2")
    from parhelion_panel import Panel
    with tempfile.TemporaryDirectory(prefix="module-") as folder, Panel(PANEL) as panel:
        check_shapes(report, panel)
        check_info(report, panel)
        check_refused(report, folder)
        check_copies(report)
        check_found(report, build, folder)
        check_threads(report, panel)
        check_draws(report, panel)
        for name, code in (("ips_cluster", [255] * 3), ("ips_cluster", [0, 0, 40]),
                           ("ips_cluster", [0] * 3), ("hud_pgu", [255, 90.5, 0]),
                           ("oled_centre", [20, 200, 10]), ("oled_centre", [0] * 3)):
            check_emission_draws(report, name, code)
        check_measured(report, panel)
        check_example(report, folder)
        tell_costs(panel)
    report.finish()


if __name__ == "__main__":
    main()
