# SPDX-License-Identifier: Apache-2.0
"""gltf.py -- writes small glTF scenes for tests: one file, buffers and pictures as data URIs.

Metres, +Y up. Standard library only.
"""
import base64
import json
import math
import os
import struct
import zlib


def sub(a, b):
    return [x - y for x, y in zip(a, b)]


def cross(a, b):
    return [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]


def dot(a, b):
    return sum(x * y for x, y in zip(a, b))


def along(a, b, t):
    """a + t b"""
    return [x + t * y for x, y in zip(a, b)]


def unit(a):
    length = math.sqrt(dot(a, a))
    return [x / length for x in a]


def quaternion_looking(direction, up):
    """The rotation that turns a node's -Z to `direction` and its +Y towards `up`."""
    z = [-x for x in unit(direction)]
    x = unit(cross(up, z))
    y = cross(z, x)
    m = [[x[i], y[i], z[i]] for i in range(3)]
    candidates = [1 + m[0][0] + m[1][1] + m[2][2], 1 + m[0][0] - m[1][1] - m[2][2],
                  1 - m[0][0] + m[1][1] - m[2][2], 1 - m[0][0] - m[1][1] + m[2][2]]
    largest = candidates.index(max(candidates))
    s = 2 * math.sqrt(candidates[largest])
    a, b, c = m[2][1] - m[1][2], m[0][2] - m[2][0], m[1][0] - m[0][1]
    d, e, f = m[0][1] + m[1][0], m[0][2] + m[2][0], m[1][2] + m[2][1]
    rows = [[a / s, b / s, c / s, s / 4], [s / 4, d / s, e / s, a / s],
            [d / s, s / 4, f / s, b / s], [e / s, f / s, s / 4, c / s]]
    return rows[largest]


def upright(direction):
    """Some direction across `direction`, for cameras and lights that do not mind."""
    return [0, 0, -1] if abs(unit(direction)[1]) > 0.9 else [0, 1, 0]


def png(width, height, rows):
    """A PNG, 8 bits, RGB; rows: `height` lists of 3*width codes."""
    def chunk(kind, data):
        return (struct.pack(">I", len(data)) + kind + data
                + struct.pack(">I", zlib.crc32(kind + data)))
    raw = b"".join(b"\0" + bytes(row) for row in rows)
    head = struct.pack(">IIBBBBB", width, height, 8, 2, 0, 0, 0)
    return (b"\x89PNG\r\n\x1a\n" + chunk(b"IHDR", head) + chunk(b"IDAT", zlib.compress(raw))
            + chunk(b"IEND", b""))


def radiance_picture(width, height, value):
    """A Radiance HDR of grey pixels; value(u, v), u and v in [0, 1] from the top left, is shown
    with an error of at most 1/256."""
    data = f"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y {height} +X {width}\n".encode()
    for j in range(height):
        for i in range(width):
            mantissa, exponent = math.frexp(value((i + 0.5) / width, (j + 0.5) / height))
            data += bytes([int(mantissa * 256)] * 3 + [exponent + 128])
    return data


def data_uri(kind, data):
    return f"data:{kind};base64," + base64.b64encode(data).decode()


class Scene:
    """One glTF document; add things, then write(path)."""

    def __init__(self):
        self.document = {"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": []}],
                         "nodes": []}
        self.used = set()
        self.binary = bytearray()
        self.files = {}  # name -> bytes: written beside the document

    def _append(self, key, item):
        self.document.setdefault(key, []).append(item)
        return len(self.document[key]) - 1

    def _node(self, node):
        self.document["scenes"][0]["nodes"].append(self._append("nodes", node))

    def _accessor(self, values, kind, component, code, extra=None):
        while len(self.binary) % 4:
            self.binary.append(0)
        flat = [x for value in values for x in (value if isinstance(value, list) else [value])]
        data = struct.pack(f"<{len(flat)}{code}", *flat)
        view = self._append("bufferViews", {"buffer": 0, "byteOffset": len(self.binary),
                                            "byteLength": len(data)})
        self.binary += data
        return self._append("accessors", {"bufferView": view, "componentType": component,
                                          "count": len(values), "type": kind, **(extra or {})})

    def mesh(self, material, positions, triangles, normals=None, uvs=None, node=None):
        """positions, normals: [x, y, z] each; triangles: [i, j, k] each."""
        rounded = [list(struct.unpack("<3f", struct.pack("<3f", *p))) for p in positions]
        limits = {"min": [min(c) for c in zip(*rounded)],
                  "max": [max(c) for c in zip(*rounded)]}
        attributes = {"POSITION": self._accessor(rounded, "VEC3", 5126, "f", limits)}
        if normals:
            attributes["NORMAL"] = self._accessor(normals, "VEC3", 5126, "f")
        if uvs:
            attributes["TEXCOORD_0"] = self._accessor(uvs, "VEC2", 5126, "f")
        indices = self._accessor([i for t in triangles for i in t], "SCALAR", 5125, "I")
        mesh = self._append("meshes", {"primitives": [{
            "attributes": attributes, "indices": indices, "material": material}]})
        self._node({"mesh": mesh, **(node or {})})

    def quad(self, material, corner, right, up):
        """Front towards right x up; uv 0,1 at the corner (glTF's v runs down)."""
        normal = unit(cross(right, up))
        corners = [corner, along(corner, right, 1), along(along(corner, right, 1), up, 1),
                   along(corner, up, 1)]
        self.mesh(material, corners, [[0, 1, 2], [0, 2, 3]], [normal] * 4,
                  [[0, 1], [1, 1], [1, 0], [0, 0]])

    def facing_quad(self, material, centre, normal, width, height=None, up=None):
        """A rectangle about `centre` whose front looks along `normal`."""
        up = up or upright(normal)
        right = unit(cross(up, normal))
        up = cross(unit(normal), right)
        height = height or width
        corner = along(along(centre, right, -width / 2), up, -height / 2)
        self.quad(material, corner, [width * x for x in right], [height * x for x in up])

    def box_inside(self, material, low, high):
        """The six walls of a room, fronts inwards."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        w, h, d = x1 - x0, y1 - y0, z1 - z0
        self.quad(material, [x0, y0, z1], [w, 0, 0], [0, 0, -d])
        self.quad(material, [x0, y1, z0], [w, 0, 0], [0, 0, d])
        self.quad(material, [x0, y0, z0], [w, 0, 0], [0, h, 0])
        self.quad(material, [x1, y0, z1], [-w, 0, 0], [0, h, 0])
        self.quad(material, [x0, y0, z1], [0, 0, -d], [0, h, 0])
        self.quad(material, [x1, y0, z0], [0, 0, d], [0, h, 0])

    def box_outside(self, material, low, high):
        """A closed box, fronts outwards."""
        (x0, y0, z0), (x1, y1, z1) = low, high
        w, h, d = x1 - x0, y1 - y0, z1 - z0
        self.quad(material, [x0, y0, z0], [w, 0, 0], [0, 0, d])
        self.quad(material, [x0, y1, z1], [w, 0, 0], [0, 0, -d])
        self.quad(material, [x1, y0, z0], [-w, 0, 0], [0, h, 0])
        self.quad(material, [x0, y0, z1], [w, 0, 0], [0, h, 0])
        self.quad(material, [x0, y0, z0], [0, 0, d], [0, h, 0])
        self.quad(material, [x1, y0, z1], [0, 0, -d], [0, h, 0])

    def sphere(self, material, centre, radius, inside=False, rings=24):
        """A closed sphere of flat triangles; `inside`: its front is the inner side."""
        points, triangles, side = [], [], 2 * rings
        for i in range(rings + 1):
            theta = math.pi * i / rings
            points += [[math.sin(theta) * math.cos(math.pi * j / rings), math.cos(theta),
                        math.sin(theta) * math.sin(math.pi * j / rings)] for j in range(side)]
        for i in range(rings):
            for j in range(side):
                a, b, k = side * i, side * (i + 1), (j + 1) % side
                triangles += [[a + j, a + k, b + j]] if i > 0 else []
                triangles += [[a + k, b + k, b + j]] if i < rings - 1 else []
        triangles = outward(points, triangles, -1 if inside else 1)
        self.mesh(material, [along(centre, p, radius) for p in points], triangles)

    def material(self, name="", extensions=None, **members):
        for extension in extensions or {}:
            self.used.add(extension)
        if extensions:
            members["extensions"] = extensions
        return self._append("materials", {"name": name, **members})

    def lambert(self, reflectance, emission=0, double_sided=False):
        """No gloss at all: KHR_materials_specular with factor 0. emission: cd/m2."""
        extensions = {"KHR_materials_specular": {"specularFactor": 0}}
        members = {"pbrMetallicRoughness": {"baseColorFactor": [reflectance] * 3 + [1],
                                            "metallicFactor": 0, "roughnessFactor": 1}}
        if emission:
            members["emissiveFactor"] = [1, 1, 1]
            extensions["KHR_materials_emissive_strength"] = {"emissiveStrength": emission}
        return self.material(extensions=extensions, doubleSided=double_sided, **members)

    def emitter(self, luminance, color=(1, 1, 1)):
        """Black but for `color` times `luminance`, cd/m2."""
        return self.material(
            pbrMetallicRoughness={"baseColorFactor": [0, 0, 0, 1], "metallicFactor": 0},
            emissiveFactor=list(color), extensions={
                "KHR_materials_specular": {"specularFactor": 0},
                "KHR_materials_emissive_strength": {"emissiveStrength": luminance}})

    def metal(self, reflectance, roughness=0):
        return self.material(pbrMetallicRoughness={
            "baseColorFactor": [reflectance] * 3 + [1], "metallicFactor": 1,
            "roughnessFactor": roughness})

    def window(self, ior, tint=(1, 1, 1)):
        """A thin pane: transmission without volume."""
        return self.material(
            pbrMetallicRoughness={"baseColorFactor": list(tint) + [1], "metallicFactor": 0,
                                  "roughnessFactor": 0}, doubleSided=True,
            extensions={"KHR_materials_transmission": {"transmissionFactor": 1},
                        "KHR_materials_ior": {"ior": ior}})

    def glass(self, ior, attenuation=None):
        """A solid: KHR_materials_volume. attenuation: ([r, g, b], metres)."""
        volume = {"thicknessFactor": 1}
        if attenuation:
            volume["attenuationColor"], volume["attenuationDistance"] = attenuation
        return self.material(
            pbrMetallicRoughness={"baseColorFactor": [1, 1, 1, 1], "metallicFactor": 0,
                                  "roughnessFactor": 0},
            extensions={"KHR_materials_transmission": {"transmissionFactor": 1},
                        "KHR_materials_ior": {"ior": ior}, "KHR_materials_volume": volume})

    def light(self, kind, intensity, position=(0, 0, 0), direction=(0, -1, 0), **members):
        """kind point or spot: candela; directional: lux."""
        self.used.add("KHR_lights_punctual")
        lights = self.document.setdefault("extensions", {}).setdefault(
            "KHR_lights_punctual", {"lights": []})["lights"]
        if kind == "spot":
            members.setdefault("spot", {})
        lights.append({"type": kind, "intensity": intensity, **members})
        self._node({"translation": list(position),
                    "rotation": quaternion_looking(direction, upright(direction)),
                    "extensions": {"KHR_lights_punctual": {"light": len(lights) - 1}}})

    def environment(self, **members):
        self.used.add("PARHELION_environment")
        self.document["scenes"][0]["extensions"] = {"PARHELION_environment": members}

    def _camera(self, name, camera, position, direction, up):
        index = self._append("cameras", camera)
        self._node({"name": name, "camera": index, "translation": list(position),
                    "rotation": quaternion_looking(direction, up or upright(direction))})

    def probe(self, name, position, direction, half_height, half_width=None, up=None):
        """A parallel camera that sees a rectangle, half_height to either side."""
        self._camera(name, {"type": "orthographic", "orthographic": {
            "ymag": half_height, "xmag": half_width or half_height, "znear": 1e-4,
            "zfar": 1e3}}, position, direction, up)

    def view(self, name, position, direction, yfov_deg, up=None):
        self._camera(name, {"type": "perspective", "perspective": {
            "yfov": math.radians(yfov_deg), "znear": 1e-4}}, position, direction, up)

    def image(self, kind, data):
        """A texture without filtering of an encoded picture."""
        source = self._append("images", {"uri": data_uri(kind, data)})
        sampler = self._append("samplers", {"magFilter": 9728, "minFilter": 9728})
        return self._append("textures", {"source": source, "sampler": sampler})

    def write(self, path):
        if self.binary:
            uri = data_uri("application/octet-stream", bytes(self.binary))
            self.document["buffers"] = [{"byteLength": len(self.binary), "uri": uri}]
        if self.used:
            self.document["extensionsUsed"] = sorted(self.used)
        for name, data in self.files.items():
            with open(os.path.join(os.path.dirname(path), name), "wb") as file:
                file.write(data)
        with open(path, "w", encoding="utf-8") as file:
            json.dump(self.document, file)


def outward(points, triangles, sign):
    """Turns every triangle so that its front looks away from the origin (sign 1) or to it."""
    turned = []
    for i, j, k in triangles:
        normal = cross(sub(points[j], points[i]), sub(points[k], points[i]))
        middle = along(along(points[i], points[j], 1), points[k], 1)
        turned.append([i, j, k] if sign * dot(normal, middle) > 0 else [i, k, j])
    return turned
