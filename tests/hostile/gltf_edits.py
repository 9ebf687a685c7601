# SPDX-License-Identifier: Apache-2.0
"""gltf_edits.py -- edits of a model (gltf_model.py), as functions of it: part of gltf_codes.py.
"""
import struct

from gltf_model import glb_of


def put(path, value):
    return lambda model: model.put(path, value)


def drop(path):
    return lambda model: model.drop(path)


def poke(accessor, element, code, *values):
    return lambda model: model.poke(accessor, element, code, *values)


def text(change):
    """Other bytes of the .gltf: change(bytes) -> bytes."""
    return lambda model: setattr(model, "change_text", change)


def glb(change):
    """As a .glb whose bytes are changed."""
    return lambda model: setattr(model, "change_glb", change)


def chunks(change):
    """As a .glb of other chunks: change([(kind, bytes)])."""
    def rebuild(data):
        found, at = [], 12
        while at < len(data):
            size, kind = struct.unpack_from("<I4s", data, at)
            found.append((kind, data[at + 8:at + 8 + size]))
            at += 8 + size
        return glb_of(change(found))
    return glb(rebuild)


def header(at, value):
    return glb(lambda data: data[:at] + struct.pack("<I", value) + data[at + 4:])


def image(uri, mime=None):
    """The second picture is another one."""
    def edit(model):
        model.document["images"][1] = {"uri": uri, **({"mimeType": mime} if mime else {})}
    return edit


def shift_view(accessor, start, shift=0):
    """The accessor's bytes begin elsewhere: `start` in the view, which is moved by `shift`."""
    def edit(model):
        item = model.document["accessors"][accessor]
        view = model.document["bufferViews"][item["bufferView"]]
        data = bytes(model.binary[view["byteOffset"]:][:view["byteLength"]])
        while len(model.binary) % 4:
            model.binary.append(0)
        view["byteOffset"] = len(model.binary) + shift
        view["byteLength"] = start + len(data)
        item["byteOffset"] = start
        model.binary += bytes(shift + start) + data + bytes(4)
    return edit


def view_of(accessor, member, value):
    def edit(model):
        view = model.document["accessors"][accessor]["bufferView"]
        model.document["bufferViews"][view][member] = value
    return edit


def poke_view(view, data):
    """Other bytes at the start of a buffer view."""
    def edit(model):
        at = model.document["bufferViews"][view]["byteOffset"]
        model.binary[at:at + len(data)] = data
    return edit
