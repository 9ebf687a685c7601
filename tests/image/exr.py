# SPDX-License-Identifier: Apache-2.0
"""exr.py -- reads OpenEXR frames without the product's own code: flat, scanlines, uncompressed
or ZIP; of several parts the first, and the names of all. Standard library only."""
import array
import struct
import sys
import zlib

LINES_PER_CHUNK = {0: 1, 2: 1, 3: 16}  # none, ZIPS, ZIP
HALF, FLOAT = 1, 2
MULTI_PART = 0x1000


class Frame:
    """attributes: name -> bytes; box: x0, y0, x1, y1 half-open; channels: name -> array of
    32-bit values, row by row from the top; parts: the attributes of every part."""

    def __init__(self, path):
        with open(path, "rb") as file:
            self.data = file.read()
        magic, version = struct.unpack_from("<II", self.data)
        if magic != 20000630 or version & 0x0a00:
            raise ValueError(f"{path}: not a flat OpenEXR file in scanlines")
        self.parts, position = read_headers(self.data, bool(version & MULTI_PART))
        self.attributes = self.parts[0]
        self.chunk_head = 4 if version & MULTI_PART else 0  # the part's number
        x0, y0, x1, y1 = struct.unpack("<4i", self.attributes["dataWindow"])
        self.box = x0, y0, x1 + 1, y1 + 1
        self.width, self.height = x1 + 1 - x0, y1 + 1 - y0
        self.channels = {name: array.array("f", bytes(4 * self.width * self.height))
                         if kind != 0 else array.array("I", bytes(4 * self.width * self.height))
                         for name, kind in channel_list(self.attributes["channels"])}
        self._read_pixels(position)
        del self.data

    def _read_pixels(self, position):
        compression = self.attributes["compression"][0]
        per_chunk = LINES_PER_CHUNK[compression]
        for i in range((self.height + per_chunk - 1) // per_chunk):
            offset, = struct.unpack_from("<Q", self.data, position + 8 * i)
            offset += self.chunk_head
            y, size = struct.unpack_from("<iI", self.data, offset)
            first = y - self.box[1]
            lines = min(per_chunk, self.height - first)
            self._store(first, lines, self.data[offset + 8:offset + 8 + size], compression)

    def _store(self, first, lines, packed, compression):
        kinds = channel_list(self.attributes["channels"])
        wanted = lines * self.width * sum(2 if kind == HALF else 4 for _, kind in kinds)
        raw = packed if compression == 0 or len(packed) == wanted else unfilter(packed)
        position = 0
        for line in range(first, first + lines):
            for name, kind in kinds:
                size = self.width * (2 if kind == HALF else 4)
                code = {0: "I", HALF: "e", FLOAT: "f"}[kind]
                values = struct.unpack_from(f"<{self.width}{code}", raw, position)
                start = line * self.width
                channel = self.channels[name]
                channel[start:start + self.width] = array.array(channel.typecode, values)
                position += size

    def mean_of(self, layer):
        """Mean luminance of a layer R, G, B over the whole frame, cd/m2."""
        weights = {"R": 0.2126, "G": 0.7152, "B": 0.0722}
        return sum(weight * sum(self.channels[f"{layer}.{name}"])
                   for name, weight in weights.items()) / len(self.channels["R"])

    def mean_luminance(self, region=None):
        """Mean of 0.2126 R + 0.7152 G + 0.0722 B in a region, cd/m2, and the standard
        deviation of that mean by the layer `variance`, its channels taken as moving together
        (which can only make it larger) and the pixels as independent."""
        weights = {"R": 0.2126, "G": 0.7152, "B": 0.0722}
        pixels = self.pixels(region)
        total = sum(weight * self.channels[name][i]
                    for name, weight in weights.items() for i in pixels)
        variance = 0.0
        for i in pixels:
            deviation = sum(weight * max(0.0, self.channels[f"variance.{name}"][i]) ** 0.5
                            for name, weight in weights.items())
            variance += deviation * deviation
        return total / len(pixels), variance ** 0.5 / len(pixels)

    def mean(self, name, region=None):
        pixels = self.pixels(region)
        return sum(self.channels[name][i] for i in pixels) / len(pixels)

    def pixels(self, region=None):
        x0, y0, x1, y1 = region or self.box
        return [(y - self.box[1]) * self.width + x - self.box[0]
                for y in range(y0, y1) for x in range(x0, x1)]


def read_text(data, position):
    end = data.index(b"\0", position)
    return data[position:end].decode(), end + 1


def read_header(data, position):
    attributes = {}
    while data[position]:
        name, position = read_text(data, position)
        _, position = read_text(data, position)
        size, = struct.unpack_from("<I", data, position)
        attributes[name] = data[position + 4:position + 4 + size]
        position += 4 + size
    return attributes, position + 1


def read_headers(data, is_multi_part):
    """Of every part; where there are several an empty header ends them."""
    header, position = read_header(data, 8)
    headers = [header]
    while is_multi_part and data[position]:
        header, position = read_header(data, position)
        headers.append(header)
    return headers, position + is_multi_part


def channel_list(data):
    channels, position = [], 0
    while data[position]:
        name, position = read_text(data, position)
        channels.append((name, struct.unpack_from("<i", data, position)[0]))
        position += 16
    return channels


def unfilter(packed):
    """ZIP of OpenEXR: deflate, differences of bytes, even and odd bytes apart."""
    data = bytearray(zlib.decompress(packed))
    for i in range(1, len(data)):
        data[i] = (data[i - 1] + data[i] - 128) & 255
    half = (len(data) + 1) // 2
    result = bytearray(len(data))
    result[0::2] = data[:half]
    result[1::2] = data[half:]
    return bytes(result)


if __name__ == "__main__":
    frame = Frame(sys.argv[1])
    print(frame.box, *frame.channels)
