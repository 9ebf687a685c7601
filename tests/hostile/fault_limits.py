# SPDX-License-Identifier: Apache-2.0
"""fault_limits.py -- what files may name, how large and deep they may be: part of faults.py.

Documented in src/base/reference.h (--root), src/scene/gltf/loader.h and the readers' headers.
"""
import json
import os
import struct
import zlib

from fault_files import make_inputs, table_text
from gltf import png
from mutate import sound_scene

MAX_VALUES, MAX_DEPTH = 1 << 25, 256


def picture_scene(bench, path, uri, kind="images"):
    """A scene that names one file; the material that shows it is on no surface."""
    document = {"asset": {"version": "2.0"}}
    if kind == "images":
        document["images"] = [{"uri": uri}]
        document["textures"] = [{"source": 0}]
        document["materials"] = [{"emissiveTexture": {"index": 0}}]
    elif kind == "buffers":
        document["buffers"] = [{"uri": uri, "byteLength": 4}]
    elif kind == "panel":
        document["extensionsUsed"] = ["PARHELION_display"]
        document["materials"] = [{"extensions": {"PARHELION_display": {"panel": uri}}}]
    elif kind == "spectrum":
        document["extensionsUsed"] = ["PARHELION_spectrum"]
        document["materials"] = [{"extensions": {"PARHELION_spectrum": {"baseColor": uri}}}]
    else:
        document["extensionsUsed"] = ["PARHELION_environment"]
        document["scenes"] = [{"extensions": {"PARHELION_environment": {
            "type": "hdri", "uri": uri}}}]
    with open(path, "w") as file:
        json.dump(document, file)
    return path


def problems(bench, *arguments, severity="error"):
    done = bench.run("check", "--json", *arguments)
    bench.claim_sound(done)
    told = [p for p in json.loads(done.stdout or "{}").get("problems", [])
            if p["severity"] == severity]
    return done.returncode, " | ".join(p["message"] for p in told)


def refused(bench, uri, words, kind="images", *options):
    path = picture_scene(bench, bench.file("tree", "a", "scenes", "s.gltf"), uri, kind)
    status, said = problems(bench, path, *options)
    bench.claim(status == 3 and words in said, f"{kind} {uri!r}: {status} {said!r}, "
                f"{words!r} is required")


def elsewhere(bench, uri, words, kind="images"):
    """An absolute URI is valid where nothing shown needs it (else: gltf_faults.py); it is told
    and not read."""
    path = picture_scene(bench, bench.file("tree", "a", "scenes", "s.gltf"), uri, kind)
    status, said = problems(bench, path, severity="warning")
    bench.claim(status == 0 and words in said, f"{kind} {uri!r}: {status} {said!r}, "
                f"{words!r} is required")


def taken(bench, uri, kind="images", *options):
    path = picture_scene(bench, bench.file("tree", "a", "scenes", "s.gltf"), uri, kind)
    status, said = problems(bench, path, *options)
    bench.claim(status == 0, f"{kind} {uri!r} {options}: {status} {said!r}")


def make_tree(bench):
    """tree/a/scenes has the scene; tree/a is as far as it may look; tree/secret is not."""
    if os.path.exists(bench.file("tree")):
        return
    picture = png(1, 1, [[1, 2, 3]])
    for names in (("a", "scenes"), ("a", "beside"), ("secret",)):
        os.makedirs(bench.file("tree", *names))
        with open(bench.file("tree", *names, "p.png"), "wb") as file:
            file.write(picture)
    scenes = bench.file("tree", "a", "scenes")
    os.symlink(bench.file("tree", "secret", "p.png"), os.path.join(scenes, "out.png"))
    os.symlink("../../secret", os.path.join(scenes, "folder"))
    os.symlink("../beside/p.png", os.path.join(scenes, "near.png"))


def check_uris(bench):
    make_tree(bench)
    refused(bench, "../../secret/p.png", "leaves the parent")
    refused(bench, "%2e%2e/%2E./secret/p.png", "leaves the parent")
    refused(bench, "folder/p.png", "by a symbolic link")
    elsewhere(bench, bench.file("tree", "secret", "p.png"), "an absolute path")
    elsewhere(bench, "file:" + "//" + bench.file("tree", "secret", "p.png"),
              'scheme is "file:"')
    elsewhere(bench, "https:" + "//host/p.png", 'scheme is "https:"')
    refused(bench, "..\\..\\secret\\p.png", "backslash")
    refused(bench, "p.png%00.txt", "zero byte")
    refused(bench, "p.png\0.txt", "zero character")
    taken(bench, "near.png")
    taken(bench, "out.png", "images", "--root", bench.file("tree", "secret"))


def check_more_uris(bench):
    """Every kind of file that a scene names, and what --root does not add."""
    make_tree(bench)
    for kind in ("buffers", "panel", "spectrum", "environment"):
        refused(bench, "folder/p.png", "by a symbolic link", kind)
        (elsewhere if kind == "buffers" else refused)(
            bench, "http:" + "//host/p.png", 'scheme is "http:"', kind)
        refused(bench, "../../secret/p.png", "leaves the parent", kind)
    refused(bench, "%5c%5chost%5cp.png", "an absolute path")
    refused(bench, "", "empty")
    elsewhere(bench, "//host/p.png", "an absolute path")
    refused(bench, "p.png/../../../secret/p.png", "leaves the parent")
    refused(bench, "out.png", "by a symbolic link", "images", "--root",
            bench.file("tree", "a", "beside"))
    taken(bench, "../beside/p.png")
    taken(bench, "../../secret/p.png", "images", "--root", bench.file("tree"))
    taken(bench, "../../secret/p.png", "images", "--root", "/")
    scene = bench.file("tree", "a", "scenes", "s.gltf")
    for command in (("render", scene, "-o", bench.file("x.exr")), ("check", scene),
                    ("sky", scene), ("measure", scene, "--illuminance", "0,0,0,0,1,0"),
                    ("panel", "fit", "x.csv", "-o", bench.file("x.panel")),
                    ("panel", "plot", "x.panel", "-o", bench.file("x.svg"))):
        bench.fails(bench.run(*command, "--root", bench.file("nowhere")), 3, "nowhere",
                    "--root wants a folder")


def check_manifests(bench):
    """The same rule for tables that a measurement set names."""
    make_tree(bench)
    make_inputs(bench)
    folder = bench.file("tree", "a", "scenes")
    with open(bench.file("tree", "secret", "white.csv"), "w") as file:
        file.write(table_text())
    manifest, panel = os.path.join(folder, "MANIFEST.json"), bench.file("y.panel")
    secret = bench.file("tree", "secret", "white.csv")

    def fit(table, *options):
        with open(manifest, "w") as file:
            json.dump({"panel": "x", "emission": {"white": table}}, file)
        return bench.run("panel", "fit", manifest, "-o", panel, "--quiet", *options)
    bench.fails(fit(secret), 3, "/emission/white", "an absolute path")
    bench.fails(fit("../../secret/white.csv"), 3, "leaves the parent", "--root")
    bench.fails(fit("folder/white.csv"), 3, "by a symbolic link")
    bench.works(fit("folder/white.csv", "--root", bench.file("tree")))
    declaration = os.path.join(folder, "declaration.json")
    with open(declaration, "w") as file:
        json.dump({"primaries": "../../secret/white.csv"}, file)
    bench.fails(bench.run("panel", "import", bench.file("in", "white.csv"), "--layout",
                          declaration, "-o", bench.file("set", "MANIFEST.json")), 3,
                "/primaries", "leaves the parent")


# ---- sizes and depths ----------------------------------------------------------------------


def chunk(kind, data):
    return (struct.pack(">I", len(data)) + kind + data
            + struct.pack(">I", zlib.crc32(kind + data)))


def huge_png(path, width, height, is_whole):
    """A picture of one grey; not whole: its header and a row."""
    with open(path, "wb") as file:
        head = struct.pack(">IIBBBBB", width, height, 8, 0, 0, 0, 0)
        file.write(b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head))
        packer, row = zlib.compressobj(1), bytes(1 + width)
        data = b"".join(packer.compress(row) for _ in range(height if is_whole else 1))
        file.write(chunk(b"IDAT", data + packer.flush()) + chunk(b"IEND", b""))
    return path


def shown_picture_scene(path, uri):
    """A scene whose first picture, which a surface shows, is this file."""
    sound_scene().write(path)
    with open(path) as file:
        document = json.load(file)
    document["images"][0] = {"uri": uri}
    with open(path, "w") as file:
        json.dump(document, file)
    return path


def check_huge_picture(bench):
    """40,000 x 40,000 texels: refused by the header, before memory is taken; told where no
    surface shows them."""
    make_tree(bench)
    path = huge_png(bench.file("tree", "a", "scenes", "huge.png"), 40000, 40000, False)
    scene = shown_picture_scene(bench.file("tree", "a", "scenes", "s.gltf"), "huge.png")
    bench.fails(bench.render(scene, "--json"), 3, "40000 x 40000 pixels", "at most",
                warnings=True)
    done = bench.render(picture_scene(bench, scene, "huge.png"), "--json")
    bench.claim(done.returncode == 0 and "40000 x 40000 pixels; at most" in done.stderr
                and json.loads(done.stdout)["peak_memory_bytes"] < 3e9, f"huge: {done.stderr}")
    os.remove(path)


def check_whole_huge_picture(bench):
    """The same, whole; and the largest that is taken: 16,384 x 16,384."""
    make_tree(bench)
    folder = bench.file("tree", "a", "scenes")
    scene = shown_picture_scene(os.path.join(folder, "s.gltf"), "huge.png")
    path = huge_png(os.path.join(folder, "huge.png"), 40000, 40000, True)
    bench.fails(bench.render(scene), 3, "40000 x 40000 pixels", warnings=True)
    huge_png(path, 16384, 16384, True)
    done = bench.render(scene, "--json")
    bench.claim_sound(done)
    peak = json.loads(done.stdout)["peak_memory_bytes"] / 1e9
    bench.claim(done.returncode == 0 and (bench.is_sanitized or peak < 3),
                f"16,384 x 16,384: {done.returncode}, {peak:.1f} GB")
    print(f"  a picture of 16,384 x 16,384 texels: peak memory {peak:.2f} GB")
    os.remove(path)


def check_depth(bench):
    """Nesting: one level too many, and the deepest that is taken."""
    for levels in (MAX_DEPTH - 1, MAX_DEPTH):
        path = bench.file("deep.gltf")
        with open(path, "w") as file:
            file.write('{"asset":{"version":"2.0"},"extras":' + "[" * levels + "]" * levels
                       + "}")
        status, said = problems(bench, path)
        bench.claim(status == (0 if levels < MAX_DEPTH else 3), f"{levels} levels: {status} "
                    f"{said}")
    with open(bench.file("deep.json"), "w") as file:
        file.write('{"panel":' + "[" * 100000)
    bench.fails(bench.run("panel", "fit", bench.file("deep.json"), "-o", bench.file("y.panel")),
                3, "deep.json", "not valid JSON")


def check_counts(bench):
    """More values than a document may have; a file that is larger than may be read."""
    path = bench.file("many.gltf")
    with open(path, "w") as file:
        file.write('{"asset":{"version":"2.0"},"extras":[')
        for _ in range(MAX_VALUES // 1024 + 1):
            file.write("0," * 1024)
        file.write("0]}")
    status, said = problems(bench, path)
    bench.claim(status == 3 and "values" in said, f"{MAX_VALUES} values: {status} {said}")
    os.remove(path)
    large = bench.file("large.gltf")
    with open(large, "wb") as file:
        file.truncate((4 << 30) + 1)
    for command, word in ((("render", large, "-o", bench.file("x.exr"), "--quiet"), "at most"),
                          (("panel", "info", large), "at most"),
                          (("panel", "fit", large, "-o", bench.file("x.panel")), "at most"),
                          (("develop", large, "-o", bench.file("x.png")), "at most"),
                          (("panel", "import", large, "-o", bench.file("M.json")), "")):
        bench.fails(bench.run(*command), 3, "large.gltf", word)
    os.remove(large)


def check_plain_lines(bench):
    """Names with line feeds and what terminals obey: one plain line."""
    path = bench.file("a\n\x1b[31mb.gltf")
    bench.fails(bench.run("render", path, "-o", bench.file("x.exr")), 3,
                "a\\u000A\\u001B[31mb.gltf")


CHECKS = (check_uris, check_manifests, check_huge_picture, check_depth, check_plain_lines)
MORE = (check_more_uris, check_whole_huge_picture, check_counts)
