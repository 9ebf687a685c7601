# SPDX-License-Identifier: Apache-2.0
"""packed.py -- parts of a scene (tests/image/gltf.py) that are packed, or move: for models that
are broken afterwards.
"""
import os
import re

ROOT = os.path.realpath(os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", ".."))
FIXTURES = os.path.join(ROOT, "tests", "unit")


def fixture(file, name):
    """The bytes of an array of a C file."""
    with open(os.path.join(FIXTURES, file), encoding="utf-8") as source:
        body = re.search(name + r"\[\w*\] = \{(.*?)\}", source.read(), re.S)[1]
    return bytes(int(number, 0) for number in re.findall(r"\w+", body))


def add_bytes(scene, data):
    """The buffer view that holds them."""
    while len(scene.binary) % 4:
        scene.binary.append(0)
    view = scene._append("bufferViews", {"buffer": 0, "byteOffset": len(scene.binary),
                                         "byteLength": len(data)})
    scene.binary += data
    return view


def index_sequence(indices):
    """EXT_meshopt_compression's mode INDICES: steps from the last index, zigzag and shifted by
    a bit that says from which of two; bytes of seven bits; four bytes behind."""
    data, last = bytearray([0xd1]), 0
    for index in indices:
        step, last = index - last, index
        code = (step << 1 ^ step >> 31) << 1
        while code > 127:
            data.append(code & 127 | 128)
            code >>= 7
        data.append(code)
    return bytes(data) + bytes(4)


def add_packed_view(scene, indices):
    """An accessor of indices whose view is packed."""
    data = index_sequence(indices)
    view = add_bytes(scene, data)
    place = scene.document["bufferViews"][view]
    packed = {"buffer": 0, "byteOffset": place["byteOffset"], "byteLength": len(data),
              "byteStride": 4, "count": len(indices), "mode": "INDICES"}
    scene.document["bufferViews"][view] = {
        "buffer": 0, "byteLength": 4 * len(indices),
        "extensions": {"EXT_meshopt_compression": packed}}
    scene.used.add("EXT_meshopt_compression")
    return scene._append("accessors", {"bufferView": view, "componentType": 5125,
                                       "count": len(indices), "type": "SCALAR"})


def add_packed_mesh(scene, material):
    """A sheet packed by Draco (tests/unit/draco_fixture.h), as a node."""
    view = add_bytes(scene, fixture("draco_fixture.h", "EDGEBREAKER"))
    position, normal = (scene._append("accessors", {
        "componentType": 5126, "count": 25, "type": "VEC3"}) for _ in range(2))
    indices = scene._append("accessors", {"componentType": 5123, "count": 96,
                                          "type": "SCALAR"})
    mesh = scene._append("meshes", {"primitives": [{
        "attributes": {"POSITION": position, "NORMAL": normal}, "indices": indices,
        "material": material, "extensions": {"KHR_draco_mesh_compression": {
            "bufferView": view, "attributes": {"POSITION": 0, "NORMAL": 1}}}}]})
    scene.used.add("KHR_draco_mesh_compression")
    scene._node({"mesh": mesh})


def add_webp(scene):
    """A texture that is a WebP picture."""
    view = add_bytes(scene, fixture("test_scene_packed.c", "WEBP"))
    image = scene._append("images", {"bufferView": view, "mimeType": "image/webp"})
    scene.used.add("EXT_texture_webp")
    return scene._append("textures", {"extensions": {"EXT_texture_webp": {"source": image}}})


def add_moving_sheet(scene, material, other):
    """A bent and morphed triangle of packed indices, moved in every way, with variants."""
    corners = [[0, 0, 0], [1, 0, 0], [0, 1, 0]]
    position, moved = (scene._accessor(values, "VEC3", 5126, "f", {
        "min": [0, 0, 0], "max": [1, 1, 0]}) for values in (corners, corners))
    joints = scene._accessor([[0, 1, 0, 0]] * 3, "VEC4", 5121, "B")
    weights = scene._accessor([[0.5, 0.5, 0, 0]] * 3, "VEC4", 5126, "f")
    mesh = scene._append("meshes", {"weights": [0.5], "primitives": [{
        "attributes": {"POSITION": position, "JOINTS_0": joints, "WEIGHTS_0": weights},
        "indices": add_packed_view(scene, [0, 1, 2]), "material": material,
        "targets": [{"POSITION": moved}], "extensions": {"KHR_materials_variants": {
            "mappings": [{"variants": [1], "material": other}]}}}]})
    scene.used.update(("KHR_materials_variants", "KHR_animation_pointer"))
    scene.document.setdefault("extensions", {})["KHR_materials_variants"] = {
        "variants": [{"name": "a"}, {"name": "b"}]}
    first = len(scene.document["nodes"])
    scene._node({"mesh": mesh, "skin": 0})
    scene._node({"children": [first + 2]})
    scene._append("nodes", {"translation": [0, 1, 0]})
    identity = [float(i % 5 == 0) for i in range(16)]
    scene._append("skins", {"joints": [first + 1, first + 2], "inverseBindMatrices":
                            scene._accessor([identity] * 2, "MAT4", 5126, "f")})
    add_motions(scene, first)


def add_motions(scene, first):
    times = scene._accessor([0.0, 1.0], "SCALAR", 5126, "f", {"min": [0], "max": [1]})
    ways = (("rotation", "LINEAR", "VEC4", [[0, 0, 0, 1], [0, 1, 0, 0]], first + 1),
            ("translation", "CUBICSPLINE", "VEC3", [[0, 0, 0]] * 6, first + 2),
            ("weights", "STEP", "SCALAR", [0.0, 1.0], first),
            ("pointer", "LINEAR", "VEC3", [[1, 1, 1], [2, 2, 2]], first + 1))
    samplers, channels = [], []
    for path, how, kind, values, node in ways:
        samplers.append({"input": times, "interpolation": how,
                         "output": scene._accessor(values, kind, 5126, "f")})
        target = {"path": path, "node": node}
        if path == "pointer":
            target = {"path": path, "extensions": {"KHR_animation_pointer": {
                "pointer": f"/nodes/{node}/scale"}}}
        channels.append({"sampler": len(samplers) - 1, "target": target})
    scene._append("animations", {"name": "all", "samplers": samplers, "channels": channels})
