# SPDX-License-Identifier: Apache-2.0
"""pictures.py -- writes small pictures without the product's own code: OpenEXR (float, no
compression), PNG (8 and 16 bits), Radiance HDR. Standard library only."""
import math
import struct
import zlib

from exr import Frame


def text(value):
    return "string", value.encode()


def number(value):
    return "double", struct.pack("<d", value)


def whole(value):
    return "int", struct.pack("<i", value)


def write_exr(path, width, height, channels, attributes=None, data=None):
    """channels: name -> list of floats, or of ints for whole numbers, over the data window (x0,
    y0, x1, y1 half-open; the whole picture when not given)."""
    x0, y0, x1, y1 = data or (0, 0, width, height)
    names = sorted(channels)
    kinds = {name: 0 if isinstance(channels[name][0], int) else 2 for name in names}
    listed = b"".join(name.encode() + b"\0" + struct.pack("<iB3xii", kinds[name], 0, 1, 1)
                      for name in names) + b"\0"
    header = {"channels": ("chlist", listed), "compression": ("compression", b"\0"),
              "dataWindow": ("box2i", struct.pack("<4i", x0, y0, x1 - 1, y1 - 1)),
              "displayWindow": ("box2i", struct.pack("<4i", 0, 0, width - 1, height - 1)),
              "lineOrder": ("lineOrder", b"\0"),
              "pixelAspectRatio": ("float", struct.pack("<f", 1)),
              "screenWindowCenter": ("v2f", struct.pack("<2f", 0, 0)),
              "screenWindowWidth": ("float", struct.pack("<f", 1)), **(attributes or {})}
    head = struct.pack("<II", 20000630, 2)
    for name, (kind, value) in header.items():
        head += name.encode() + b"\0" + kind.encode() + b"\0" + struct.pack("<i", len(value))
        head += value
    head += b"\0"
    row = x1 - x0
    lines = []
    for line in range(y1 - y0):
        values = b"".join(struct.pack(f"<{row}{'I' if kinds[name] == 0 else 'f'}",
                                      *channels[name][line * row:(line + 1) * row])
                          for name in names)
        lines.append(struct.pack("<ii", y0 + line, len(values)) + values)
    offset = len(head) + 8 * len(lines)
    with open(path, "wb") as out:
        out.write(head)
        for line in lines:
            out.write(struct.pack("<Q", offset))
            offset += len(line)
        out.write(b"".join(lines))


def write_png(path, width, height, codes, bits=8, channels=3):
    """codes: whole numbers, row by row, `channels` of each pixel (3 RGB, 4 with alpha)."""
    def part(kind, body):
        return struct.pack(">I", len(body)) + kind + body \
            + struct.pack(">I", zlib.crc32(kind + body))
    row = width * channels
    code = "B" if bits == 8 else "H"
    raw = b"".join(b"\0" + struct.pack(f">{row}{code}", *codes[y * row:(y + 1) * row])
                   for y in range(height))
    head = struct.pack(">IIBBBBB", width, height, bits, {3: 2, 4: 6}[channels], 0, 0, 0)
    with open(path, "wb") as out:
        out.write(b"\x89PNG\r\n\x1a\n" + part(b"IHDR", head)
                  + part(b"IDAT", zlib.compress(raw)) + part(b"IEND", b""))


def write_hdr(path, width, height, values):
    """values: three floats a pixel."""
    body = b""
    for i in range(width * height):
        rgb = values[3 * i:3 * i + 3]
        mantissa, exponent = math.frexp(max(rgb))
        scale = 0 if max(rgb) <= 0 else mantissa * 256 / max(rgb)
        body += bytes([*(int(v * scale) for v in rgb), 0 if not scale else exponent + 128])
    with open(path, "wb") as out:
        out.write(b"#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n"
                  + f"-Y {height} +X {width}\n".encode() + body)


def read_exr(path):
    """What write_exr takes, of a file that it or the product wrote."""
    frame = Frame(path)
    with open(path, "rb") as file:
        data = file.read()
    attributes, at = {}, 8
    while data[at]:
        name, kind = (data[at:].split(b"\0", 2))[:2]
        at += len(name) + len(kind) + 2
        size, = struct.unpack_from("<i", data, at)
        attributes[name.decode()] = kind.decode(), data[at + 4:at + 4 + size]
        at += 4 + size
    for own in ("channels", "compression", "dataWindow", "displayWindow", "lineOrder"):
        attributes.pop(own, None)
    channels = {name: [int(v) for v in values] if values.typecode == "I" else list(values)
                for name, values in frame.channels.items()}
    return {"width": frame.width, "height": frame.height, "channels": channels,
            "attributes": attributes}
