# SPDX-License-Identifier: Apache-2.0
"""live_view.py PARHELION -- a render that is watched: what a viewer gets is held byte for byte
to the packets as they are defined, its last picture to the frame; viewers that are absent, die,
or stop to read, and files that nobody may see half-written. Nothing of it changes the frame.
"""
import json
import os
import re
import signal
import socket
import struct
import subprocess
import sys
import tempfile
import threading
import time

ROOT = os.path.join(os.path.dirname(os.path.abspath(__file__)), "..", "..")
sys.path.insert(0, os.path.join(ROOT, "tests", "structure"))
sys.path.insert(0, os.path.join(ROOT, "tests", "image"))
from exr import Frame  # noqa: E402
from gltf import Scene  # noqa: E402
from report import Report  # noqa: E402
from words import unless_given  # noqa: E402
from resume import PATIENCE_S, Work, contents  # noqa: E402

PANEL = os.path.join(ROOT, "assets", "panels", "ips_cluster.panel")
DEFAULT_PORT = 14158
CREATE, UPDATE, DRAW = 4, 6, 8
STROKE_COLOR, STROKE, BEGIN, RECTANGLE = 4, 5, 6, 18
FILTERED = "denoised preview, not for figures."
PICTURE = ["R", "G", "B", "error.Y"]  # what is shown more often than all layers
LUMINANCE = {"R": 0.2126, "G": 0.7152, "B": 0.0722}
SCREENS = ((-1.0, -0.1), (0.0, 0.9))  # from where to where, m
EYE, HALF_HEIGHT = [0.3, 1.0, 1.5], 0.577350269  # the tangent of 30 degrees


def write_scene(path):
    """A room with two screens of one display, and one that shows its back."""
    scene = Scene()
    scene.box_inside(scene.lambert(0.7), [-2, 0, -2], [2, 2.5, 2])
    scene.facing_quad(scene.emitter(500), [0, 2.49, 0], [0, -1, 0], 0.8)
    screen = scene.material("screen", pbrMetallicRoughness={"metallicFactor": 0})
    for x, _ in SCREENS:
        scene.quad(screen, [x, 0.5, -1.9], [0.9, 0, 0], [0, 1.5, 0])
    scene.quad(scene.material("away", pbrMetallicRoughness={"metallicFactor": 0}),
               [-1.2, 0.5, -1.5], [-0.4, 0, 0], [0, 0.4, 0])
    scene.view("eye", EYE, [0, 0, -1], 60)
    scene.write(path)


def screen_boxes(width, height):
    """By similar triangles from the eye, and cut by the frame: x, y, width, height."""
    scale = height / 2 / (HALF_HEIGHT * (EYE[2] + 1.9))
    for left, right in SCREENS:
        x0, x1 = (min(max(width / 2 + scale * (x - EYE[0]), 0), width) for x in (left, right))
        yield x0, height / 2 - scale * (2 - EYE[1]), x1 - x0, 1.5 * scale


# ---- the packets, from their definition ----------------------------------------------------

def text(name):
    return name.encode() + b"\0"


def packet(kind, focus, image, body):
    body = struct.pack("<BB", kind, focus) + text(image) + body
    return struct.pack("<I", 4 + len(body)) + body


def names(channels):
    return struct.pack("<i", len(channels)) + b"".join(map(text, channels))


def create(image, size, channels):
    return packet(CREATE, 1, image, struct.pack("<2i", *size) + names(channels))


def update(image, channels, box, planes):
    """box: x, y, width, height; planes: the bytes of each channel's floats, in turn."""
    pixels, count = box[2] * box[3], len(channels)
    offsets = struct.pack(f"<{count}q", *(i * pixels for i in range(count)))
    strides = struct.pack(f"<{count}q", *[1] * count)
    return packet(UPDATE, 0, image, names(channels) + struct.pack("<4i", *box) + offsets +
                  strides + planes)


def draw(image, color, boxes):
    commands = [struct.pack("<B4f", STROKE_COLOR, *color), struct.pack("<B", BEGIN)]
    commands += [struct.pack("<B4f", RECTANGLE, *box) for box in boxes]
    commands.append(struct.pack("<B", STROKE))
    return packet(DRAW, 0, image,
                  struct.pack("<Bi", 0, len(commands)) + b"".join(commands))


def channel_count(one):
    """Of an update."""
    return struct.unpack_from("<i", one, one.index(b"\0", 6) + 1)[0]


def packets_of(data):
    """By their lengths; what is cut off at the end comes as it is."""
    position = 0
    while position < len(data):
        length = struct.unpack_from("<I", data.ljust(position + 4, b"\0"), position)[0]
        yield data[position:position + max(length, 5)]
        position += max(length, 5)


class Canvas:
    """What a viewer has of an image that it calls `image`, with these channels."""

    def __init__(self, report, image, size, channels):
        self.report, self.image, self.size, self.channels = report, image, size, channels
        self.values = [bytearray(4 * size[0] * size[1]) for _ in channels]
        self.counts = [0] * (size[0] * size[1])
        self.boxes, self.kinds, self.shown = None, [], []

    def take(self, data):
        for one in packets_of(data):
            kind = one[4]
            self.kinds.append(kind)
            if kind == UPDATE:
                self.take_update(one)
            elif kind == DRAW:
                self.take_boxes(one)
            else:
                wanted = create(self.image, self.size, self.channels)
                self.report.claim(one == wanted, f"create: {one[:200]}, required: "
                                                 f"{wanted[:200]}")

    def take_update(self, one):
        """Of all channels, of the picture's, of the filtered one's or of all besides."""
        begin = 6 + len(text(self.image))
        filtered = [name for name in self.channels if name.startswith(FILTERED)]
        besides = [name for name in self.channels if name not in filtered]
        channels = next((some for some in (besides, PICTURE, filtered)
                         if one[begin:].startswith(names(some))), [])
        place = begin + len(names(channels))
        if not channels or len(one) < place + 16:
            self.report.claim(False, f"an update of {len(one)} bytes: {one[:200]}")
            return
        box = struct.unpack_from("<4i", one, place)
        planes = one[place + 16 + 16 * len(channels):]
        same = one == update(self.image, channels, box, planes)
        whole = len(planes) == 4 * len(channels) * box[2] * box[3]
        inside = box[0] >= 0 and box[1] >= 0 and box[0] + box[2] <= self.size[0] and \
            box[1] + box[3] <= self.size[1]
        self.shown.append(len(channels))
        if self.report.claim(same and whole and inside, f"update of {box}: {one[:place + 40]}"):
            self.store(channels, box, planes)

    def store(self, channels, box, planes):
        x, y, width, height = box
        for row in range(height):
            begin = (y + row) * self.size[0] + x
            for i in range(begin, begin + width):
                self.counts[i] += 1
            for c, channel in enumerate(channels):
                at = 4 * ((c * height + row) * width)
                plane = self.values[self.channels.index(channel)]
                plane[4 * begin:4 * (begin + width)] = planes[at:at + 4 * width]

    def take_boxes(self, one):
        place = 6 + len(text(self.image))
        color = struct.unpack_from("<4f", one, place + 6)
        count = struct.unpack_from("<i", one, place + 1)[0] - 3
        self.boxes = [struct.unpack_from("<4f", one, place + 24 + 17 * i) for i in range(count)]
        self.report.claim(one == draw(self.image, color, self.boxes), f"boxes: {one}")

    def pixels(self, channel):
        return struct.unpack(f"<{len(self.counts)}f",
                             self.values[self.channels.index(channel)])


class Viewer:
    """Listens, and has the bytes of one connection: all of them, those of a first piece before
    it resets the connection (dies_after), or none while it stays open (reads=False)."""

    def __init__(self, host="127.0.0.1", port=0, reads=True, dies_after=None):
        self.socket = socket.socket(socket.AF_INET6 if ":" in host else socket.AF_INET)
        self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        if not reads or dies_after:  # else a frame may wait in the buffer when it dies
            self.socket.setsockopt(socket.SOL_SOCKET, socket.SO_RCVBUF, 4096)
        self.socket.bind((host, port))
        self.socket.listen(1)
        self.socket.settimeout(PATIENCE_S)
        self.port = self.socket.getsockname()[1]
        self.reads, self.dies_after, self.data = reads, dies_after, bytearray()
        self.is_over = threading.Event()
        self.thread = threading.Thread(target=self.run)
        self.thread.start()

    def run(self):
        try:
            connection = self.socket.accept()[0]
        except OSError:
            return
        with connection:
            if not self.reads:
                self.is_over.wait(PATIENCE_S)
            while self.reads and (self.dies_after is None or len(self.data) < self.dies_after):
                piece = connection.recv(1 << 20)
                if not piece:
                    return
                self.data += piece
            connection.setsockopt(socket.SOL_SOCKET, socket.SO_LINGER, struct.pack("ii", 1, 0))

    def end(self):
        self.is_over.set()
        self.thread.join(PATIENCE_S)
        self.socket.close()
        return bytes(self.data)


# ---- a viewer that is there ----------------------------------------------------------------

def channels_of(frame):
    """In the order in which they are shown: R, G, B first; the names are the frame's."""
    return ["R", "G", "B"], set(frame.channels) | {"error.Y"}


def shown_channels(data):
    """The channels that the first packet names."""
    first = next(packets_of(data), b"")
    if len(first) < 20 or first[4] != CREATE:
        return []
    words = first[first.index(b"\0", 6) + 13:].split(b"\0")
    return [word.decode() for word in words[:-1]]


def as_shown(frame, name):
    """A channel's floats, bit for bit; whole numbers are stored as such, none as the last."""
    values = frame.channels[name]
    if values.typecode == "I":
        return [-1.0 if value == 0xffffffff else float(value) for value in values]
    return list(values)


def bits(values):
    return struct.pack(f"<{len(values)}f", *values)


def claim_picture(report, canvas, frame, what):
    """The canvas inside the frame's data window is the frame; outside nothing was shown."""
    x0, y0, x1, y1 = frame.box
    width = canvas.size[0]
    inside = [y * width + x for y in range(y0, y1) for x in range(x0, x1)]
    for name in frame.channels:
        shown = canvas.pixels(name)
        report.claim(bits([shown[i] for i in inside]) == bits(as_shown(frame, name)),
                     f"{what}: {name} is not the frame's")
    counts = {canvas.counts[i] for i in inside}
    report.claim(len(counts) == 1 and sum(canvas.counts) == len(inside) * max(counts),
                 f"{what}: pixels were shown {sorted(counts)} times, "
                 f"{sum(canvas.counts)} in all")
    return max(counts)


def claim_error(report, canvas, frame, of_halves, what):
    """error.Y, cd/m2, from the frame's own layers: film.h has the formulas."""
    layer = "halves" if of_halves else "variance"
    worst = 0
    for i, shown in enumerate(canvas.pixels("error.Y")):
        parts = [weight * frame.channels[f"{layer}.{c}"][i] if of_halves else
                 weight * max(0.0, frame.channels[f"{layer}.{c}"][i]) ** 0.5
                 for c, weight in LUMINANCE.items()]
        wanted = 1.2533141 * abs(sum(parts)) if of_halves else sum(parts)
        size = 1.2533141 * sum(map(abs, parts)) + 1e-9
        worst = max(worst, abs(shown - wanted) / size)
    most = 1e-3 if of_halves else 2e-6  # of halves the film has XYZ: no rounded weights
    report.claim(worst < most, f"{what}: error.Y is wrong by {worst}")


def watched(work, viewer, *options, host="127.0.0.1"):
    return work.run(*options, "--tev", f"{host}:{viewer.port}")


def check_packets(work, frame, size, *options, of_halves=False, host="127.0.0.1"):
    """frame: the bytes without a viewer."""
    what = " ".join(options[:4])
    viewer = Viewer(host.strip("[]"))
    done = watched(work, viewer, *options, host=host)
    data = viewer.end()
    picture = Frame(work.path("frame.exr"))
    channels = shown_channels(data)
    first, every = channels_of(picture)
    work.report.claim(channels[:3] == first and sorted(channels) == sorted(every),
                      f"{what}: channels {channels}, required: {sorted(every)}")
    canvas = Canvas(work.report, "frame.exr", size, channels)
    canvas.take(data)
    claim_picture(work.report, canvas, picture, what)
    work.report.claim(canvas.kinds[0] == CREATE and canvas.kinds.count(CREATE) == 1 and
                      canvas.kinds.count(DRAW) == 1, f"{what}: packets {canvas.kinds}")
    work.report.claim(canvas.shown[0] == len(PICTURE) and canvas.shown[-1] == len(channels),
                      f"{what}: channels shown {canvas.shown}")
    wanted = list(screen_boxes(*size))
    work.report.claim(len(canvas.boxes) == len(wanted) and
                      max(abs(a - b) for shown, box in zip(canvas.boxes, wanted)
                          for a, b in zip(shown, box)) < 1e-3,
                      f"{what}: boxes {canvas.boxes}, required: {wanted}")
    if "variance.R" in picture.channels and picture.box == (0, 0, *size):
        claim_error(work.report, canvas, picture, of_halves, what)
    work.report.claim("--tev" not in done.stderr, f"{what}: says {done.stderr[-300:]}")
    work.claim_finished(done, frame, f"watched, {what}")


def check_denoised(work, size, *options):
    """The filtered picture is a layer of its own, whose name says what it is not for, and the
    last that is shown: nearer to a frame of many samples. The frame is the one of a render that
    nobody watches."""
    few = (*options, "--spp", "4", "--denoise", "--png", "p.png")
    work.run(*options, "--spp", "400", "--quiet")
    truth = Frame(work.path("frame.exr"))
    frame = work.reference(*few)[0]
    viewer = Viewer()
    done = watched(work, viewer, *few)
    data = viewer.end()
    os.remove(work.path("p.png"))
    picture = Frame(work.path("frame.exr"))
    channels = shown_channels(data)
    wanted = [FILTERED + letter for letter in "RGB"]
    work.report.claim(channels[-3:] == wanted and
                      sorted(channels[:-3]) == sorted(channels_of(picture)[1]),
                      f"denoised: channels {channels}")
    canvas = Canvas(work.report, "frame.exr", size, channels)
    canvas.take(data)
    work.report.claim(canvas.shown[-2:] == [len(channels) - 3, 3],
                      f"denoised: channels shown {canvas.shown}")
    for letter in "RGB":
        before, after = canvas.pixels(letter), canvas.pixels(FILTERED + letter)
        work.report.claim(bits(before) == bits(as_shown(picture, letter)),
                          f"denoised: {letter} is not the frame's")
        far = [sum(abs(a - b) for a, b in zip(shown, truth.channels[letter]))
               for shown in (before, after)]
        work.report.claim(abs(sum(after) / sum(before) - 1) < 0.05 and far[1] < 0.8 * far[0],
                          f"denoised: {letter} has {sum(after) / sum(before)} of the light, "
                          f"is {far[1]} from the truth, {far[0]} before")
    work.claim_finished(done, frame, "watched, denoised")


def check_layers_meanwhile(work, *options):
    """Every layer is shown before the end too, once there was time for it."""
    viewer = Viewer()
    running = work.start(*options, "--tev", f"127.0.0.1:{viewer.port}")
    end_s, shown = time.monotonic() + PATIENCE_S, set()
    while time.monotonic() < end_s and len(shown) < 2:
        time.sleep(0.05)
        shown = {channel_count(one) for one in packets_of(bytes(viewer.data))
                 if one[4:5] == bytes([UPDATE]) and len(one) > 100}
    is_running = running.poll() is None
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=PATIENCE_S)
    viewer.end()
    work.report.claim(is_running and shown == {len(PICTURE), len(PICTURE) + 1},
                      f"shown before the end: updates of {shown} channels")
    work.clear()


def check_hosts(work, frame, size, *options):
    """A name, IPv6 in brackets, and the port that stands for none."""
    check_packets(work, frame, size, *options, host="localhost")
    try:
        check_packets(work, frame, size, *options, host="[::1]")
    except OSError as error:
        work.report.skip(f"a viewer at [::1]: {error}")
    try:
        viewer = Viewer(port=DEFAULT_PORT)
    except OSError as error:
        work.report.skip(f"a viewer at port {DEFAULT_PORT}: {error}")
        return
    done = work.run(*options, "--tev", "127.0.0.1")
    work.report.claim(viewer.end()[4:5] == bytes([CREATE]), "the default port is another")
    work.claim_finished(done, frame, "watched at the default port")


def check_resumed(work, frame, size, *options):
    """What is shown after a pause is the whole frame."""
    running = work.start(*options, "--checkpoint-interval", "0", "--threads", "1")
    work.wait_for("frame.exr.checkpoint")
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=PATIENCE_S)
    check_packets(work, frame, size, *options, "--resume", "--noise", "1e-9", "--quiet",
                  of_halves=True)


# ---- one that is not, or no longer ---------------------------------------------------------

def claim_told(work, done, frame, line, what):
    """One line, among the answer's warnings too, and the frame as if nobody watched."""
    told = [one for one in done.stderr.splitlines() if "--tev" in one]
    work.report.claim(len(told) == 1 and re.search(line, told[0]) and
                      told[0].startswith("parhelion: warning: --tev "),
                      f"{what}: {done.stderr[-400:]!r}")
    warnings = [one["message"] for one in json.loads(done.stdout)["warnings"]]
    work.report.claim(len([one for one in warnings if "--tev" in one]) == 1,
                      f"{what}: warnings {warnings}")
    work.claim_finished(done, frame, what)


def check_absent(work, frame, *options):
    with socket.socket() as closed:  # has a port, and does not listen
        closed.bind(("127.0.0.1", 0))
        address = f"127.0.0.1:{closed.getsockname()[1]}"
        done = work.run(*options, "--json", "--quiet", "--tev", address)
    claim_told(work, done, frame, "no viewer is there.*: Connection refused$", "absent")
    done = work.run(*options, "--json", "--tev", "no-such-host.invalid")
    claim_told(work, done, frame, "no viewer is there, the render goes on", "an unknown name")


def check_killed(work, *options):
    frame, _ = work.reference(*options)
    for bytes_ in (0, 30000):
        viewer = Viewer(dies_after=bytes_)
        done = watched(work, viewer, *options, "--json")
        data = viewer.end()
        work.report.claim(len(data) >= bytes_, f"killed after {bytes_}: has {len(data)}")
        line = "the viewer is lost, the render goes on without it: "
        if bytes_ == 0:  # so soon that it may not be met at all
            line = f"({line}|no viewer is there, the render goes on without one: )"
        claim_told(work, done, frame, line + "(Connection reset by peer|Broken pipe)$",
                   f"killed after {bytes_}")


def check_hung(work, *options):
    frame, _ = work.reference(*options)
    viewer = Viewer(reads=False)
    done = watched(work, viewer, *options, "--json", "--progress", "none")
    viewer.end()
    claim_told(work, done, frame, "the viewer is lost.*: it (took nothing for 3 s|did not take "
               "the last frame within 3 s)$", "hung")


# ---- words that are none -------------------------------------------------------------------

def check_words(work):
    port, ip4 = "is no port, required: 1 to 65535", "is no IPv4 address"
    ip6, brackets = "is no IPv6 address", "an IPv6 address stands in brackets"
    name, length = "is no host's name", "letters, required: 1 to 253"
    for words, status, part in (
            (["--tev", ""], 2, "required: a text"), (["--tev", ":5"], 2, length),
            (["--tev", "a" * 254], 2, length), (["--tev", "[]:5"], 2, length),
            (["--tev", "a:"], 2, port), (["--tev", "a:0"], 2, port),
            (["--tev", "a:65536"], 2, port), (["--tev", "a:+5"], 2, port),
            (["--tev", "a:5 "], 2, port), (["--tev", "a:0x50"], 2, port),
            (["--tev", "a:99999999999999999999"], 2, port), (["--tev", "[::1]:"], 2, port),
            (["--tev", "::1"], 2, brackets), (["--tev", "a:b:c"], 2, brackets),
            (["--tev", "[::1"], 2, "never closed"), (["--tev", "[zz]:5"], 2, ip6),
            (["--tev", "[127.0.0.1]:5"], 2, ip6), (["--tev", "[::1]5"], 2, "required: :PORT"),
            (["--tev", "999.0.0.1"], 2, ip4), (["--tev", "1.2.3:5"], 2, ip4),
            (["--tev", "a b"], 2, name), (["--tev", "a/b:5"], 2, name),
            (["--tev", "[::1]:\n"], 2, port), (["--tev", "h\u00f6st"], 2, name),
            (["--live", "frame.png"], 2, "required: a name that ends in .exr"),
            (["--live", "frame.exr"], 2, "the result is to stand there"),
            (["--live", "x.exr", "--png", "x.exr"], 2, "the picture is to stand there"),
            (["--live", "none/x.exr"], 4, "none/x.exr: cannot be written")):
        done = work.run(*words)
        left = set(os.listdir(work.folder)) - work.names
        work.report.claim(done.returncode == status and part in done.stderr and not left and
                          done.stderr.count("\n") == 1 and
                          (status == 4 or words[0] in done.stderr),
                          f"{words}: status {done.returncode}, {done.stderr[:300]!r}, {left}")


# ---- the file ------------------------------------------------------------------------------

def attribute(frame, name):
    data = frame.attributes[f"parhelion:{name}"]
    return struct.unpack("<i", data)[0] if name == "complete" else data.decode()


def picture_of(frame):
    return {name: values.tobytes() for name, values in frame.channels.items()}


def check_file(work, frame, *options):
    """In the end it is the frame; of a part, without the sums."""
    done = work.run(*options, "--live", "live.exr")
    work.report.claim(contents(work.path("live.exr")) == frame, "the last live file is another")
    os.remove(work.path("live.exr"))
    work.claim_finished(done, frame, "with a live file")
    part, _ = work.reference(*options, "--crop", "3,2,30,20")
    done = work.run(*options, "--crop", "3,2,30,20", "--live", "live.exr")
    live, own = Frame(work.path("live.exr")), Frame(work.path("frame.exr"))
    work.report.claim(picture_of(live) == picture_of(own) and
                      len(live.parts) == 1 < len(own.parts),
                      "a part's live file is not its picture alone")
    os.remove(work.path("live.exr"))
    work.claim_finished(done, part, "a part with a live file")


def check_file_meanwhile(work, *options):
    """It is whole at any time, says how far it is, and outlives the render."""
    running = work.start(*options, "--spp", "1000000", "--live", "live.exr")
    work.wait_for("live.exr")
    live = Frame(work.path("live.exr"))
    first, end = map(int, attribute(live, "samples").split(":"))
    work.report.claim(first == 0 < end < 1000000 and attribute(live, "complete") == 0,
                      f"a live file says {attribute(live, 'samples')}")
    running.send_signal(signal.SIGTERM)
    running.communicate(timeout=PATIENCE_S)
    work.report.claim(running.returncode == 143 and
                      contents(work.path("live.exr")) == contents(work.path("frame.exr")),
                      f"stopped: status {running.returncode}, or another live file")
    work.clear()
    running = work.start(*options, "--spp", "1000000", "--live", "live.exr")
    work.wait_for("live.exr")
    running.kill()
    running.communicate(timeout=PATIENCE_S)
    work.report.claim(attribute(Frame(work.path("live.exr")), "complete") == 0,
                      "a killed render's live file is not whole")
    work.clear()


def check_no_room(work, frame, *options):
    """A live file that cannot be written any more is told of once."""
    os.mkdir(work.path("there"))
    running = work.start(*options, "--live", "there/live.exr", "--json",
                         stdin=subprocess.DEVNULL)
    work.wait_for("there/live.exr")
    os.remove(work.path("there/live.exr"))
    os.rmdir(work.path("there"))
    out, err = running.communicate(timeout=PATIENCE_S)
    told = [line for line in err.splitlines() if "--live: the frame is not shown" in line]
    work.report.claim(len(told) == 1 and "there/live.exr: " in told[0],
                      f"no room: {err[-300:]}")
    work.claim_finished(subprocess.CompletedProcess([], running.returncode, out, err), frame,
                        "without room for the live file")


def main():
    report, program = Report(), os.path.abspath(sys.argv[1])
    with tempfile.TemporaryDirectory() as folder:
        work = Work(report, program, folder, "--panel", f"screen={PANEL}", "--panel",
                    f"away={PANEL}", "--max-bounces", "1")
        write_scene(work.path("scene.gltf"))
        size = (48, 36)
        small = ("--size", "48x36", "--layers", "all", "--spp", "20")
        frame, _ = work.reference(*small)
        check_packets(work, frame, size, *small)
        plain = ("--size", "48x36", "--no-guiding", "--spp", "100")
        check_hosts(work, work.reference(*plain)[0], size, *plain)
        halves = (*plain, "--layers", "halves,variance")
        check_packets(work, work.reference(*halves)[0], size, *halves, of_halves=True)
        part = (*plain[:3], "--samples", "3:9", "--crop", "5,4,41,30")
        check_packets(work, work.reference(*part)[0], size, *part)
        check_layers_meanwhile(work, *plain[:3], "--layers", "depth", "--spp", "1000000")
        check_denoised(work, size, *plain[:3])
        check_resumed(work, work.reference(*halves, "--noise", "1e-9")[0], size, *halves)
        check_absent(work, frame, *small)
        large = ("--size", "320x240", "--layers", "all", "--spp", "1", "--no-guiding")
        check_killed(work, *large)
        check_hung(work, *large)
        check_words(work)
        check_file(work, frame, *small)
        check_file_meanwhile(work, *small[:4])
        longer = (*unless_given(halves, ["--spp"]), "--spp", "200")
        check_no_room(work, work.reference(*longer)[0], *longer)
    report.finish()


if __name__ == "__main__":
    main()
