# SPDX-License-Identifier: Apache-2.0
"""fault_scenes.py -- scenes at the edge of sense: part of faults.py.

What is no scene is refused with its place; what is one, however strange, gives a frame whose
every value is finite, and a warning where the user would wonder (scenes/README.md).
"""
import json
import math
import os
import struct

from exr import Frame
from fault_files import make_inputs
from fault_limits import problems
from gltf import Scene, png

LIGHT = 100  # cd/m2 of the panels below


def lit_scene(scale=1.0, centre=(0, 0, 0)):
    """A grey floor under a glowing panel, seen from the side; every length times scale."""
    scene = Scene()

    def at(x, y, z):
        return [c + scale * v for c, v in zip(centre, (x, y, z))]
    grey = scene.lambert(0.5)
    scene.quad(grey, at(-2, 0, 2), [4 * scale, 0, 0], [0, 0, -4 * scale])
    scene.quad(grey, at(-2, 0, -2), [4 * scale, 0, 0], [0, 3 * scale, 0])
    scene.facing_quad(scene.emitter(LIGHT), at(0, 2, 0), [0, -1, 0], scale)
    scene.view("eye", at(0, 1, 3), [0, -0.1, -1], 50)
    return scene


def frame_of(bench, scene, *words, size="32x24", spp=4, options=(), what=""):
    """Writes and renders a scene that is taken; its frame, all of it finite."""
    path = bench.file("strange.gltf")
    scene.write(path)
    done = bench.render(path, *options, out="strange.exr", size=size, spp=spp)
    if not bench.works(done, *words, what=what):
        return None
    frame = Frame(bench.file("strange.exr"))
    bench.claim(all(math.isfinite(v) for c in "RGB" for v in frame.channels[c]),
                f"{what}: the frame holds values that are not finite")
    return frame


def luminance(frame):
    """The frame's mean, cd/m2."""
    return sum(weight * sum(frame.channels[name]) / len(frame.channels[name])
               for name, weight in (("R", 0.2126), ("G", 0.7152), ("B", 0.0722)))


def mean_of(bench, scene, *words, **more):
    frame = frame_of(bench, scene, *words, **more)
    return luminance(frame) if frame else math.nan


def refusal(bench, scene, words, what):
    path = bench.file("strange.gltf")
    scene.write(path)
    status, said = problems(bench, path)
    bench.claim(status == 3 and words in said, f"{what}: {status} {said!r}, {words!r} is "
                "required")
    bench.fails(bench.render(path, out="no.exr"), 3, what=what, warnings=True)
    bench.claim(not os.path.exists(bench.file("no.exr")), f"{what}: a frame was written")


# ---- what is no scene ----------------------------------------------------------------------


def with_number(attribute, number):
    """A triangle one of whose numbers is not finite."""
    scene = Scene()
    values = {"POSITION": [[0.0, 0, 0], [1, 0, 0], [0, 1, 0]],
              "NORMAL": [[0.0, 0, 1]] * 3, "TEXCOORD_0": [[0.0, 0], [1, 0], [0, 1]],
              "TANGENT": [[1.0, 0, 0, 1]] * 3}
    values[attribute] = [list(v) for v in values[attribute]]
    values[attribute][1][1] = number
    scene.mesh(scene.lambert(0.5), [[0, 0, 0], [1, 0, 0], [0, 1, 0]], [[0, 1, 2]])
    primitive = scene.document["meshes"][0]["primitives"][0]
    limits = {"min": [0, 0, 0], "max": [1, 1, 0]}
    for name, rows in values.items():
        kind = {2: "VEC2", 3: "VEC3", 4: "VEC4"}[len(rows[0])]
        primitive["attributes"][name] = scene._accessor(
            rows, kind, 5126, "f", limits if name == "POSITION" else None)
    return scene


def check_numbers(bench):
    """NaN and infinity in what stands at a vertex."""
    for attribute, number in (("POSITION", math.nan), ("NORMAL", math.inf),
                              ("TEXCOORD_0", -math.nan), ("TANGENT", math.nan)):
        refusal(bench, with_number(attribute, number), "finite numbers are required",
                f"{attribute} holds {number}")


def check_lights_and_cameras(bench):
    """Angles and intensities that mean nothing."""
    for yfov in (0, -1, 4):
        scene = lit_scene()
        scene.document["cameras"][0]["perspective"]["yfov"] = yfov
        refusal(bench, scene, "radians" if yfov > math.pi else "a number above 0",
                f"yfov {yfov}")
    scene = lit_scene()
    scene.light("point", -1, [0, 1, 0])
    refusal(bench, scene, "at least 0", "a light of negative intensity")
    scene = lit_scene()
    scene.write(bench.file("strange.gltf"))
    with open(bench.file("strange.gltf")) as file:
        text = file.read()
    with open(bench.file("strange.gltf"), "w") as file:
        file.write(text.replace('"yfov": ', '"yfov": 1e999, "was": '))
    bench.fails(bench.render(bench.file("strange.gltf")), 3, "strange.gltf")
    scene = lit_scene()
    scene.document["nodes"][0]["scale"] = [1e30, 1e30, 1e30]
    scene.document["nodes"].append({"scale": [1e30] * 3, "children": [0]})
    scene.document["scenes"][0]["nodes"][0] = len(scene.document["nodes"]) - 1
    refusal(bench, scene, "within 1e+09 m", "a mesh beyond all numbers")


def check_far(bench):
    """What stands where numbers are too coarse for its light, or for any ray."""
    for what, node in (("floor", 0), ("emitter", 2), ("camera", 3), ("lamp", 4), ("copies", 0)):
        for far in (1.1e9, -2e18, -2.0 ** 63, 3.4e38):
            scene = lit_scene()
            scene.light("point", 1, [0, 1, 0])
            place = scene.document["nodes"][node]
            if what == "copies":
                moves = scene._accessor([[0.0, 0, 0], [0, far, 0]], "VEC3", 5126, "f")
                copies = "EXT_mesh_gpu_instancing"
                place["extensions"] = {copies: {"attributes": {"TRANSLATION": moves}}}
                scene.document.setdefault("extensionsUsed", []).append(copies)
            else:
                place["translation"] = [0, far, 0]
            refusal(bench, scene, "within 1e+09 m are required", f"a {what} {far:g} m away")
    scene = lit_scene()
    scene.light("directional", 1, [0, 2e18, 0], [0, -1, 0])
    frame_of(bench, scene, what="a light of which glTF ignores the place")


def check_missing_texture(bench):
    scene = lit_scene()
    scene.document["images"] = [{"uri": "lost.png"}]
    scene.document["textures"] = [{"source": 0}]
    scene.document["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"] = {"index": 0}
    refusal(bench, scene, "lost.png: cannot be opened", "a texture that is not there")


# ---- what is a scene, if a strange one -----------------------------------------------------


def check_darkness(bench):
    """Nothing at all; surfaces without light; lights of nothing: black, and said so."""
    mean = mean_of(bench, Scene(), "nothing gives light", "neither a camera nor triangles",
                   what="an empty scene")
    bench.claim(mean == 0, f"an empty scene shows {mean}")
    scene = Scene()
    scene.quad(scene.lambert(0.5), [-1, 0, -2], [2, 0, 0], [0, 2, 0])
    scene.view("eye", [0, 1, 0], [0, 0, -1], 60)
    scene.light("point", 0, [0, 1, 0])
    mean = mean_of(bench, scene, "nothing gives light, the frame is black — add",
                   what="a scene without light")
    bench.claim(mean == 0, f"a scene without light shows {mean}")


def check_display_level(bench):
    """A display switched off emits nothing, and says nothing of it."""
    make_inputs(bench)
    for level in (0, 100):
        scene = Scene()
        scene.used.add("PARHELION_display")
        picture = scene.image("image/png", png(1, 1, [[255, 255, 255]]))
        shown = scene.material("shown", extensions={"PARHELION_display": {
            "panel": "in/x.panel", "content": {"index": picture}}})
        scene.quad(shown, [-0.5, 0.5, -2], [1, 0, 0], [0, 1, 0])
        scene.view("eye", [0, 1, 0], [0, 0, -1], 30)
        mean = mean_of(bench, scene, what=f"a display at {level} %",
                       options=("--display-level", f"shown={level}"))
        bench.claim(mean == 0 if level == 0 else mean > 100,
                    f"a display at {level} % shows {mean} cd/m2")


PLAIN = ("--no-guiding",)  # what is learnt decides the paths; plain ones are the same


def check_bright_light(bench):
    """10^12 cd/m2 on a surface: ten orders brighter, and as it should be. By a power of two all
    paths are the same."""
    times = 2.0 ** 34
    one = mean_of(bench, lit_scene(), options=PLAIN, what="a light")
    scene = lit_scene()
    for material in scene.document["materials"]:
        strength = material["extensions"].get("KHR_materials_emissive_strength")
        if strength:
            strength["emissiveStrength"] = LIGHT * times
    bright = mean_of(bench, scene, options=PLAIN, what="a light of 10^12 cd/m2")
    mean_of(bench, scene, what="what is learnt of 10^12 cd/m2")
    bench.claim(abs(bright / one / times - 1) < 1e-4,
                f"{LIGHT * times} cd/m2: {bright} against {one} at {LIGHT} cd/m2")


def check_flat_triangles(bench):
    """Triangles without area are left out and counted; a surface that nodes press flat too."""
    scene = lit_scene()
    grey = scene.lambert(0.5)
    scene.mesh(grey, [[0, 1, 0], [1, 1, 0], [0.5, 1, 0], [0, 1, 0]], [[0, 1, 2], [0, 0, 3]],
               [[0, 1, 0]] * 4, [[0, 0]] * 4)
    frame_of(bench, scene, "2 triangles without area", what="triangles without area")
    for scale in ([0, 0, 0], [1, 0, 1], [1e-30, 1, 1]):
        scene = lit_scene()
        scene.quad(scene.lambert(0.5), [-1, 0.5, 1], [2, 0, 0], [0, 0.1, -2])
        scene.document["nodes"][-1]["scale"] = scale
        path = bench.file("strange.gltf")
        scene.write(path)
        done = bench.render(path, out="strange.exr", size="32x24", spp=4)
        frame = Frame(bench.file("strange.exr")) if bench.claim_sound(done) else None
        bench.claim(done.returncode == 0 and all(
            math.isfinite(v) for v in frame.channels["G"]), f"a node of scale {scale}: "
            f"{done.returncode} {done.stderr.strip()[:300]}")


def check_degenerate_frames(bench):
    """Normals of no length, tangents along the normal, coordinates that span nothing."""
    picture = png(1, 1, [[128, 128, 255]])
    for normal, tangent, uv in (([0, 0, 0], [1, 0, 0, 1], [0, 0]),
                                ([0, 0, 1], [0, 0, 0, 1], [0, 0]),
                                ([0, 0, 1], [0, 0, 1, -1], [0.5, 0.5]),
                                ([1e-30, 0, 0], [0, 0, 1, 1], [1e30, 1e30])):
        scene = lit_scene()
        texture = scene.image("image/png", picture)
        bumpy = scene.material(normalTexture={"index": texture})
        scene.mesh(bumpy, [[-1, 0.2, 1], [1, 0.2, 1], [0, 1, 0]], [[0, 1, 2]], [normal] * 3,
                   [uv] * 3)
        attributes = scene.document["meshes"][-1]["primitives"][0]["attributes"]
        attributes["TANGENT"] = scene._accessor([[float(v) for v in tangent]] * 3, "VEC4",
                                                5126, "f")
        path = bench.file("strange.gltf")
        scene.write(path)
        done = bench.render(path, out="strange.exr", size="32x24", spp=4)
        what = f"normal {normal}, tangent {tangent}, coordinates {uv}"
        if bench.claim_sound(done, what) and done.returncode == 0:
            values = Frame(bench.file("strange.exr")).channels["G"]
            bench.claim(all(math.isfinite(v) for v in values), f"{what}: not finite")


def check_camera_inside(bench):
    """An eye inside a closed box sees its walls from behind; inside a lamp, the lamp."""
    scene = lit_scene()
    scene.box_outside(scene.lambert(0.5), [-0.5, 0.5, 2.5], [0.5, 1.5, 3.5])
    mean = mean_of(bench, scene, what="a camera inside a closed box")
    bench.claim(mean == 0, f"a closed box is lit inside: {mean}")
    scene = lit_scene()
    scene.quad(scene.lambert(0.5), [-1, 1, 2], [2, 0, 0], [0, 0, 2])  # through the eye
    frame_of(bench, scene, what="a camera in a surface")


def check_scale(bench):
    """A scene of glowing surfaces looks the same at any size: by a power of two, to the bit
    or nearly so; by 10^6 and 10^-6, and as large as it may be, up to noise."""
    whole = frame_of(bench, lit_scene(), spp=64, options=PLAIN, what="scale 1")
    for scale, tolerance in ((2.0 ** 20, 1e-3), (2.0 ** -20, 1e-3), (1e6, 0.03), (1e-6, 0.03),
                             (2e8, 0.03)):
        frame_of(bench, lit_scene(scale), what=f"what is learnt at scale {scale:g}")
        other = frame_of(bench, lit_scene(scale), spp=64, options=PLAIN,
                         what=f"scale {scale:g}")
        if whole and other:
            a, b = luminance(whole), luminance(other)
            bench.claim(abs(b / a - 1) < tolerance, f"scale {scale:g}: {b} instead of {a}")
            most = max(abs(x - y) for x, y in zip(whole.channels["G"], other.channels["G"]))
            print(f"  scale {scale:g}: mean off by {b / a - 1:.1e}, a pixel by at most "
                  f"{most:.2g} of {max(whole.channels['G']):.3g} cd/m2")


def check_distance(bench):
    """A kilometre from the origin nothing changes; where numbers get coarse, it is said."""
    near = mean_of(bench, lit_scene(), spp=64, what="at the origin")
    far = mean_of(bench, lit_scene(1, (1024, 512, -1024)), spp=64, what="a kilometre away")
    bench.claim(abs(far / near - 1) < 0.03, f"a kilometre away: {far} instead of {near}")
    frame_of(bench, lit_scene(1, (1e6, 0, 0)), "vertices 1e+06 m or more",
             "lost in the file itself",
             what="a thousand kilometres away")
    for scale in (1e-7, 1e-9, 1e-15, 1e-20):
        frame_of(bench, lit_scene(scale), "make it larger", what=f"at scale {scale:g}")


def check_mirrored_nodes(bench):
    """Negative scales: the same picture, mirrored."""
    plain, mirrored = lit_scene(), lit_scene()
    for node in mirrored.document["nodes"][:3]:
        node["scale"] = [-1, 1, 1]
    a = mean_of(bench, plain, spp=64, what="not mirrored")
    b = mean_of(bench, mirrored, spp=64, what="mirrored")
    bench.claim(abs(b / a - 1) < 0.03, f"mirrored: {b} instead of {a}")


def check_frame_sizes(bench):
    make_inputs(bench)
    scene = lit_scene()
    for size in ("1x1", "65536x1", "1x65536", "4096x2"):
        frame = frame_of(bench, scene, size=size, spp=1, what=size)
        bench.claim(frame and f"{frame.width}x{frame.height}" == size, f"{size}: other size")


# ---- many ----------------------------------------------------------------------------------


def many_nodes(path, count, is_deep):
    """Nodes side by side, or each the child of the one before."""
    scene = lit_scene()
    first, nodes = len(scene.document["nodes"]), scene.document["nodes"]
    for i in range(count):
        node = {"translation": [1e-6, 0, 0]}
        if is_deep and i + 1 < count:
            node["children"] = [first + i + 1]
        nodes.append(node)
    nodes[-1]["mesh"] = 0
    scene.document["scenes"][0]["nodes"] += [first] if is_deep else range(first, first + count)
    scene.write(path)


def check_many_nodes(bench):
    for is_deep in (False, True):
        path = bench.file("nodes.gltf")
        many_nodes(path, 100000, is_deep)
        done = bench.render(path, "--json")
        bench.works(done, what=f"100,000 nodes, {'deep' if is_deep else 'wide'}")


def large_mesh(folder, side):
    """A wavy floor of 2 side^2 triangles, in a file of its own."""
    path, data = os.path.join(folder, "large.gltf"), os.path.join(folder, "large.bin")
    with open(data, "wb") as file:
        for i in range(side + 1):
            file.write(b"".join(struct.pack("<3f", j / side - 0.5, 0.01 * math.sin(
                0.1 * i) * math.cos(0.1 * j), i / side - 0.5) for j in range(side + 1)))
        for i in range(side):
            row = []
            for j in range(side):
                a, b = i * (side + 1) + j, (i + 1) * (side + 1) + j
                row += [a, b, a + 1, a + 1, b, b + 1]
            file.write(struct.pack(f"<{len(row)}I", *row))
    vertices, triangles = (side + 1) ** 2, 2 * side * side
    scene = lit_scene()
    document = scene.document
    document["buffers"] = [{"uri": "large.bin", "byteLength": 12 * vertices + 12 * triangles}]
    document["bufferViews"] = [{"buffer": 0, "byteLength": 12 * vertices},
                               {"buffer": 0, "byteOffset": 12 * vertices,
                                "byteLength": 12 * triangles}]
    document["accessors"] = [
        {"bufferView": 0, "componentType": 5126, "count": vertices, "type": "VEC3",
         "min": [-0.5, -0.011, -0.5], "max": [0.5, 0.011, 0.5]},
        {"bufferView": 1, "componentType": 5125, "count": 3 * triangles, "type": "SCALAR"}]
    document["meshes"] = [{"primitives": [{"attributes": {"POSITION": 0}, "indices": 1}]}]
    document["nodes"] = [{"mesh": 0}, document["nodes"][-1]]
    document["scenes"][0]["nodes"] = [0, 1]
    document["extensionsUsed"] = sorted(scene.used)
    with open(path, "w") as file:
        json.dump(document, file)
    return path


def check_ten_million_triangles(bench):
    """Memory (260 bytes a triangle at most) and time of what a large vehicle has; a quarter of
    it under the sanitizer."""
    side = 1118 if bench.is_sanitized else 2237
    path = large_mesh(bench.folder, side)
    before = os.times()
    done = bench.render(path, "--environment", "constant:100", "--json", size="64x48",
                        timeout=900)
    after = os.times()
    seconds = sum(after[2:4]) - sum(before[2:4])
    peak = json.loads(done.stdout or "{}").get("peak_memory_bytes", 0) / 1e9
    bench.claim_sound(done)
    bench.claim(done.returncode == 0 and (bench.is_sanitized or peak < 2.6),
                f"{2 * side * side} triangles: {done.returncode}, {peak:.1f} GB "
                f"{done.stderr.strip()[:300]}")
    print(f"  {2 * side * side} triangles: {seconds:.1f} s of processor time, peak memory "
          f"{peak:.2f} GB")
    os.remove(os.path.join(bench.folder, "large.bin"))


CHECKS = (check_darkness, check_numbers, check_bright_light, check_camera_inside, check_scale,
          check_far, check_missing_texture)
MORE = (check_lights_and_cameras, check_display_level, check_flat_triangles,
        check_degenerate_frames, check_distance, check_mirrored_nodes, check_frame_sizes,
        check_many_nodes, check_ten_million_triangles)
