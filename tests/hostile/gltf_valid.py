# SPDX-License-Identifier: Apache-2.0
"""gltf_valid.py -- valid models of unusual kinds: each is taken, and what is said of it (""
where nothing is): part of gltf_codes.py.
"""
import struct

from gltf_edits import chunks, drop, glb, image, poke, put, view_of
from gltf_model import COLOR, POSITION, TURNS, WEIGHTS

MATERIAL = "materials/0/"


def unknown_accessor(**members):
    """An accessor as an extension may define one; something unknown refers to it."""
    item = {"componentType": 5126, "count": 2, "type": "SCALAR", "bufferView": 0, **members}
    return put("accessors/15", item)


VALID = [
    ("a later version whose minimum is 2.0", "read as 2.0", put("asset/version", "2.3")),
    ("a later minimum", "may need what 2.0 does not have", put("asset/version", "2.1"),
     put("asset/minVersion", "2.1")),
    ("an early minimum", "", put("asset/minVersion", "1.0")),
    ("an accessor of an extension's type", "one of SCALAR", unknown_accessor(type="TENSOR")),
    ("an accessor of an extension's component", "one of BYTE (5120)",
     unknown_accessor(componentType=5131)),
    ("an accessor of 32-bit integers", "one of BYTE (5120)",
     unknown_accessor(componentType=5124)),
    ("the same of a sparse index", "one of UNSIGNED_BYTE (5121)", put(
        "accessors/14/sparse/indices/componentType", 5120)),
    ("a drawing mode of an extension", "one of 0", put("meshes/1/primitives/0/mode", 7)),
    ("a camera of an extension", "one of perspective",
     put("cameras/1", {"type": "cylinder", "extensions": {}})),
    ("a filter of an extension", "one of 9728", put("samplers/0/minFilter", 5)),
    ("a target of an extension", "one of 34962", view_of(TURNS, "target", 34965)),
    ("a path of an extension", "one of translation",
     put("animations/0/channels/0/target/path", "colour")),
    ("an image type of an extension", "one of image/jpeg",
     put("images/1/mimeType", "image/avif")),
    ("a picture in the network that nothing shows", "scheme is \"https:\"",
     drop(MATERIAL + "normalTexture"), image("https://example.com/a.png")),
    ("a picture on another machine's disk", "an absolute path",
     drop(MATERIAL + "normalTexture"), image("/pictures/a.png")),
    ("a picture of a material that nothing wears", "scheme is \"ftp:\"",
     drop(MATERIAL + "normalTexture"), image("ftp://example.com/a.png"),
     put("materials/4", {"normalTexture": {"index": 1}})),
    ("a buffer in the network that nothing needs", "scheme is \"http:\"",
     put("buffers", [{"byteLength": 4, "uri": "http://example.com/a.bin"}]),
     put("bufferViews/18", {"buffer": 1, "byteLength": 4})),
    ("a buffer without bytes that nothing needs", "", put("buffers", [{"byteLength": 4}])),
    ("an unknown extension, wherever it stands", "is not supported",
     put("extensionsUsed/18", "ACME_x"), put("nodes/8/extensions", {"ACME_x": {"a": [1]}})),
    ("whole numbers with a point", "", put("accessors/0/count", 4.0)),
    ("names that are empty or the same", "", put("nodes/2/name", ""),
     put("nodes/3/name", "root")),
    ("a quaternion of eight bits", "", put("nodes/8/rotation", [
        0, 0.70866, 0, 0.70866])),
    ("a mirroring matrix", "", put("nodes/5/matrix/0", -2)),
    ("extreme colours", "", poke(COLOR, 0, "f", 0, 0, 0, 0), drop(MATERIAL + "doubleSided")),
    ("weights of one joint", "", poke(WEIGHTS, 0, "f", 1, 0)),
    ("a stride", "", view_of(POSITION, "byteStride", 12)),
    ("a material without anything", "", put("materials/1", {})),
    ("a scene without nodes", "", put("scenes/1", {})),
    ("a .glb", "", glb(lambda data: data)),
    ("a .glb with chunks of others", "unknown type",
     chunks(lambda found: found + [(b"ACME", b"")])),
    ("a .glb with an empty BIN chunk", "", glb(lambda data: empty_bin())),
]


def empty_bin():
    """A .glb that refers to no bytes and has an empty chunk for them."""
    text = b"{\"asset\":{\"version\":\"2.0\"}} "
    return struct.pack("<4sIIII", b"glTF", 2, 28 + len(text), len(text), 0x4E4F534A) + text \
        + struct.pack("<II", 0, 0x004E4942)
