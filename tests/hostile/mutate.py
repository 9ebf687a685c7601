# SPDX-License-Identifier: Apache-2.0
"""mutate.py -- broken models made from a sound one, the same ones every time."""
import json
import os
import random
import struct
import sys

sys.path.insert(0, os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "image"))
import packed  # noqa: E402
from gltf import Scene, png  # noqa: E402


def sound_scene():
    """A document with every kind of object that is read."""
    scene = Scene()
    picture = scene.image("image/png", png(2, 2, [[255, 0, 0, 0, 255, 0],
                                                  [0, 0, 255, 255, 255, 255]]))
    material = scene.material(
        "all", pbrMetallicRoughness={"baseColorTexture": {"index": picture},
                                     "roughnessFactor": 0.5},
        alphaMode="MASK", normalTexture={"index": picture}, extensions={
            "KHR_materials_clearcoat": {"clearcoatFactor": 1},
            "KHR_materials_ior": {"ior": 1.5}, "KHR_materials_specular": {"specularFactor": 1}})
    scene.quad(material, [-1, 0, -2], [2, 0, 0], [0, 2, 0])
    scene.quad(scene.window(1.5), [-1, 0, -1], [2, 0, 0], [0, 2, 0])
    scene.facing_quad(scene.emitter(100), [0, 3, 0], [0, -1, 0], 1)
    scene.light("spot", 10, [0, 2, 0], [0, -1, 0.5], color=[1, 0.5, 0.5])
    scene.environment(type="constant", luminance=10, sun={
        "azimuth_deg": 180, "elevation_deg": 35, "illuminance_lx": 9000})
    scene.view("eye", [0, 1, 2], [0, 0, -1], 60)
    return scene


def full_scene():
    """The same, and what is packed, what moves and what has variants."""
    scene = sound_scene()
    grey = scene.lambert(0.5)
    packed.add_packed_mesh(scene, grey)
    packed.add_moving_sheet(scene, grey, scene.material("webp", emissiveFactor=[1, 1, 1],
                            emissiveTexture={"index": packed.add_webp(scene)}))
    return scene


SOUND = "sound.gltf"
STRANGE = [-1, 0, 1, 2, 7, 255, 65536, 2 ** 31 - 1, 2 ** 31, 2 ** 32 - 1, 2 ** 53, -2 ** 63,
           1e300, -0.5, 1e-40, "", "x", "\u0000", None, True, [], {}, [[[]]], "NaN",
           "data:;base64,!!!!", "../" * 20 + "etc/passwd", "http:" + "//host/x.bin"]


def places(node, found, parent=None, key=None):
    """Every (container, key) of a document."""
    if parent is not None:
        found.append((parent, key))
    children = node.items() if isinstance(node, dict) else \
        enumerate(node) if isinstance(node, list) else ()
    for name, child in children:
        places(child, found, node, name)
    return found


def twisted(text, chance):
    """One or two values of the document replaced, removed or doubled."""
    document = json.loads(text)
    for _ in range(chance.randint(1, 2)):
        container, key = chance.choice(places(document, []))
        kind = chance.random()
        try:
            if kind < 0.7:
                container[key] = chance.choice(STRANGE)
            elif kind < 0.85:
                del container[key]
            elif isinstance(container, list):
                container.append(container[key])
        except (KeyError, IndexError):
            continue
    return json.dumps(document).encode()


def scratched(text, chance):
    """A few bytes changed, or the end cut off."""
    data = bytearray(text)
    if chance.random() < 0.3:
        return bytes(data[:chance.randrange(len(data))])
    for _ in range(chance.randint(1, 4)):
        data[chance.randrange(len(data))] = chance.randrange(256)
    return bytes(data)


def glb(text):
    text += b" " * (-len(text) % 4)
    return struct.pack("<4sIIII", b"glTF", 2, 20 + len(text), len(text), 0x4E4F534A) + text


def absurd():
    """Files that no mutation finds."""
    return {
        "empty.gltf": b"", "empty.glb": b"", "null.gltf": b"null", "number.gltf": b"1e999",
        "deep.gltf": b"[" * 200000, "deep_object.gltf": b'{"a":' * 100000,
        "deep_extras.gltf": b'{"asset":{"version":"2.0"},"extras":' + b'{"a":' * 5000 + b"1"
                            + b"}" * 5001,
        "bytes.glb": bytes(range(256)) * 64, "huge_length.glb": b"glTF" + b"\2\0\0\0"
                     + b"\xff" * 64,
        "version_one.gltf": b'{"asset":{"version":"1.0"}}',
        "needs.gltf": b'{"asset":{"version":"2.0"},"extensionsUsed":["X_y"],'
                      b'"extensionsRequired":["X_y"]}',
        "cycle.gltf": b'{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],'
                      b'"nodes":[{"children":[1]},{"children":[0]}]}',
        "huge_count.gltf": b'{"asset":{"version":"2.0"},"accessors":[{"componentType":5126,'
                           b'"count":4000000000,"type":"VEC3"}],"meshes":[{"primitives":'
                           b'[{"attributes":{"POSITION":0}}]}],"nodes":[{"mesh":0}],'
                           b'"scenes":[{"nodes":[0]}]}',
        "not_utf8.gltf": b'{"asset":{"version":"2.0"},"nodes":[{"name":"\xff\xfe"}]}',
    }


def write_all(folder, count):
    """Writes the absurd files and `count` mutations; returns the paths, the sound one first."""
    sound = os.path.join(folder, SOUND)
    full_scene().write(sound)
    with open(sound, "rb") as file:
        text = file.read()
    files = absurd()
    for i in range(count):
        chance = random.Random(i)
        kind = i % 4
        if kind < 2:
            files[f"twisted_{i}.gltf"] = twisted(text, chance)
        elif kind == 2:
            files[f"scratched_{i}.gltf"] = scratched(text, chance)
        else:
            files[f"scratched_{i}.glb"] = scratched(glb(text), chance)
    for name, data in files.items():
        with open(os.path.join(folder, name), "wb") as file:
            file.write(data)
    return [sound] + [os.path.join(folder, name) for name in files]


if __name__ == "__main__":
    print(*write_all(sys.argv[1], int(sys.argv[2])), sep="\n")
