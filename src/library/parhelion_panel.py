# SPDX-License-Identifier: Apache-2.0
"""Measured displays for other renderers: what a .panel file emits and reflects.

    import numpy, parhelion_panel
    with parhelion_panel.Panel("cluster.panel") as panel:
        xyz = panel.emission_xyz(viewer=[0, 0, 1], code=[255, 255, 255])   # cd m^-2
        f = panel.brdf(viewer=[0, 0, 1], light=directions, nm=[450, 550, 650])

Questions are arrays whose last axis is what is asked for: directions and codes have 3 numbers
there, places 2; the axes before it follow numpy's rules of broadcasting and are those of the
answer. All is told in single precision.

Frame: +z is the display's normal, +x right and +y up as someone facing it sees them; directions
leave the display, also those to the light. Places are u from the left, v from the top, 0 to 1.
Units: cd m^-2, W m^-2 sr^-1 nm^-1, sr^-1, nm, radians; codes 0 to 255. parhelion_panel.h, of
the library this module calls, has all of it.

The library is the file that PARHELION_PANEL_LIBRARY names, else one beside this module or in
the folders of libraries of the same installation, else the system's.

A Panel is constant: many threads may ask it at once, also while one closes it; copies share what
was opened, and so do processes after a fork. It cannot be pickled: a process that was not forked
opens the file itself.
"""
import ctypes
import ctypes.util
import glob
import os

import numpy

__all__ = ["Panel", "PanelError"]

FLAGS = ("emits", "reflects", "has_mirror", "is_anisotropic", "varies", "is_polarised",
         "has_zones")
FLOATS = ctypes.POINTER(ctypes.c_float)
BYTES = ctypes.POINTER(ctypes.c_ubyte)
NO_MEMORY = 4


class PanelError(Exception):
    """The library is not there, a file is no panel, or a question is put wrongly."""


class _Info(ctypes.Structure):
    _fields_ = [("size", ctypes.c_uint32), ("flags", ctypes.c_uint32),
                ("emission_cone", ctypes.c_float),
                ("reflection_cone", ctypes.c_float), ("last_incidence", ctypes.c_float),
                ("emission_nm", ctypes.c_float * 2), ("reflection_nm", ctypes.c_float * 2),
                ("polarisation", ctypes.c_float), ("polarisation_azimuth", ctypes.c_float)]


class _Questions(ctypes.Structure):
    _fields_ = [("size", ctypes.c_size_t), ("count", ctypes.c_size_t), ("place", FLOATS),
                ("viewer", FLOATS), ("light", FLOATS), ("code", FLOATS), ("random", FLOATS),
                ("wavelengths", ctypes.c_size_t), ("nm", FLOATS)]


WIDTH = {"place": 2, "viewer": 3, "light": 3, "code": 3, "random": 3}


def _candidates():
    named = os.environ.get("PARHELION_PANEL_LIBRARY")
    if named:
        return [named]
    here = os.path.dirname(os.path.abspath(__file__))
    prefix = os.path.join(here, "..", "..", "..")
    folders = [here, os.path.join(prefix, "lib"), os.path.join(prefix, "lib", "*-linux-gnu"),
               os.path.join(prefix, "lib64")]
    found = [name for folder in folders
             for name in sorted(glob.glob(os.path.join(folder, "libparhelion-panel.so.2")))]
    system = ctypes.util.find_library("parhelion-panel")
    return found + ([system] if system else []) + ["libparhelion-panel.so.2"]


def _load():
    reasons = []
    for name in _candidates():
        try:
            return _declared(ctypes.CDLL(name))
        except (OSError, AttributeError) as fault:
            reasons.append(f"{name}: {fault}")
    raise PanelError("libparhelion-panel cannot be loaded; PARHELION_PANEL_LIBRARY may name "
                     "it: " + "; ".join(reasons))


def _declared(library):
    panel, questions = ctypes.c_void_p, ctypes.POINTER(_Questions)
    into = [ctypes.POINTER(panel), ctypes.c_char_p, ctypes.c_size_t]
    library.parhelion_panel_open.argtypes = [ctypes.c_char_p, *into]
    library.parhelion_panel_open_memory.argtypes = [ctypes.c_char_p, ctypes.c_size_t, *into]
    library.parhelion_panel_close.restype = None
    library.parhelion_panel_close.argtypes = [panel]
    library.parhelion_panel_info.argtypes = [panel, ctypes.POINTER(_Info)]
    for name, outputs in (("emission_xyz", [FLOATS, BYTES]), ("emission_spectrum", [FLOATS]),
                          ("brdf", [FLOATS, FLOATS]), ("mirror", [FLOATS]),
                          ("albedo", [FLOATS]), ("sample", [FLOATS, FLOATS]),
                          ("pdf", [FLOATS]), ("sample_emission", [FLOATS, FLOATS]),
                          ("pdf_emission", [FLOATS])):
        getattr(library, f"parhelion_panel_{name}").argtypes = [panel, questions, *outputs]
    return library


_loaded = []


def _library():
    if not _loaded:
        _loaded.append(_load())
    return _loaded[0]


def _pointer(array, kind=FLOATS):
    return None if array is None else array.ctypes.data_as(kind)


def _array(name, value, width):
    array = numpy.asarray(value, dtype=numpy.float32)
    if array.ndim < 1 or array.shape[-1] != width:
        raise PanelError(f"{name} has shape {array.shape}, required: {width} numbers on its "
                         f"last "
                         "axis")
    return array


class _Opened:
    """What the library opened: freed with the last Panel, copy or question that has it."""

    def __init__(self, panel, close):
        self.panel, self._close = panel, close

    def __del__(self):
        self._close(self.panel)

    def __copy__(self):
        return self

    def __deepcopy__(self, _):
        return self

    def __reduce__(self):
        raise PanelError("a Panel cannot be pickled: open its file in each process")


class Panel:
    """An open panel file, or the bytes of one. Raises PanelError, or MemoryError where there is
    not enough memory."""

    _opened = None

    def __init__(self, source):
        library, error = _library(), ctypes.create_string_buffer(2048)
        panel = ctypes.c_void_p()
        into = (ctypes.byref(panel), error, len(error))
        if isinstance(source, (bytes, bytearray)):
            status = library.parhelion_panel_open_memory(bytes(source), len(source), *into)
        else:
            path = os.fsencode(source)
            if b"\0" in path:
                raise PanelError(f"{source!r} has a zero byte, required: a path without")
            status = library.parhelion_panel_open(path, *into)
        if status:
            words = error.value.decode("utf-8", "replace")
            raise MemoryError(words) if status == NO_MEMORY else PanelError(words)
        self._opened = _Opened(panel.value, library.parhelion_panel_close)

    def close(self):
        """It cannot be asked afterwards; frees the panel when no copy and no question has it."""
        self._opened = None

    def __enter__(self):
        return self

    def __exit__(self, *_):
        self.close()

    def _open(self):
        opened = self._opened
        if not opened:
            raise PanelError("the panel is closed")
        return opened

    def info(self):
        """What the file holds, as a dictionary."""
        told, opened = _Info(size=ctypes.sizeof(_Info)), self._open()
        _library().parhelion_panel_info(opened.panel, ctypes.byref(told))
        out = {name: bool(told.flags >> bit & 1) for bit, name in enumerate(FLAGS)}
        for name in ("emission_nm", "reflection_nm"):
            out[name] = tuple(getattr(told, name))
        for name in ("emission_cone", "reflection_cone", "last_incidence", "polarisation",
                     "polarisation_azimuth"):
            out[name] = getattr(told, name)
        return out

    def _ask(self, name, asked, nm, outputs):
        """Calls a question of the library. asked: its arrays by name; outputs: (width or None
        for the wavelengths', type) of each array of answers, or None for one not wanted."""
        given = {key: _array(key, value, WIDTH[key]) for key, value in asked.items()
                 if value is not None}
        shape = numpy.broadcast_shapes(*(array.shape[:-1] for array in given.values()))
        flat = {key: numpy.ascontiguousarray(numpy.broadcast_to(array, shape + (WIDTH[key],)))
                for key, array in given.items()}
        count = int(numpy.prod(shape, dtype=int))
        waves = None
        if nm is not None:
            waves = numpy.ascontiguousarray(nm, dtype=numpy.float32).reshape(-1)
        questions = _Questions(size=ctypes.sizeof(_Questions), count=count)
        for key, array in flat.items():
            setattr(questions, key, _pointer(array))
        questions.wavelengths, questions.nm = (0 if waves is None else waves.size,
                                               _pointer(waves))
        made = []
        for output in outputs:
            if output is None:
                made.append(None)
                continue
            width, kind = output
            last = () if width == 1 else (waves.size if width is None else width,)
            made.append(numpy.empty(shape + last, kind))
        pointers = [_pointer(array, BYTES if array is not None and array.dtype == numpy.uint8
                             else FLOATS) for array in made]
        opened = self._open()
        status = getattr(_library(), f"parhelion_panel_{name}")(
            opened.panel, ctypes.byref(questions), *pointers)
        if status:
            raise PanelError(f"{name}: the library refuses the question ({status})")
        return made

    def emission_xyz(self, viewer, code, place=None, measured=False):
        """XYZ in cd m^-2, [..., 3]; with `measured` also whether each lies within the cone."""
        xyz, within = self._ask("emission_xyz", {"viewer": viewer, "code": code,
                                                 "place": place}, None,
                                [(3, numpy.float32), (1, numpy.uint8) if measured else None])
        return (xyz, within.astype(bool)) if measured else xyz

    def emission_spectrum(self, viewer, code, nm, place=None):
        """Spectral radiance in W m^-2 sr^-1 nm^-1, [..., wavelengths]."""
        return self._ask("emission_spectrum", {"viewer": viewer, "code": code, "place": place},
                         nm, [(None, numpy.float32)])[0]

    def brdf(self, viewer, light, nm, place=None, lambertian=False):
        """BRDF without the mirror part, sr^-1, [..., wavelengths]; with `lambertian` also the
        part of it that goes to all sides alike."""
        brdf, part = self._ask("brdf", {"viewer": viewer, "light": light, "place": place}, nm,
                               [(None, numpy.float32),
                                (None, numpy.float32) if lambertian else None])
        return (brdf, part) if lambertian else brdf

    def mirror(self, viewer, nm, place=None):
        """Reflectance of the mirror part, [..., wavelengths]."""
        return self._ask("mirror", {"viewer": viewer, "place": place}, nm,
                         [(None, numpy.float32)])[0]

    def albedo(self, viewer, place=None):
        """Share of the light that the BRDF sends back, luminous mean, [...]."""
        return self._ask("albedo", {"viewer": viewer, "place": place}, None,
                         [(1, numpy.float32)])[0]

    def sample(self, viewer, random, place=None):
        """Directions to the light, [..., 3], and their densities in sr^-1, [...]; a density of
        0 says that there is none. random: three numbers in [0, 1) each."""
        return self._ask("sample", {"viewer": viewer, "random": random, "place": place}, None,
                         [(3, numpy.float32), (1, numpy.float32)])

    def pdf(self, viewer, light, place=None):
        """Density with which `sample` draws a direction to the light, sr^-1, [...]."""
        return self._ask("pdf", {"viewer": viewer, "light": light, "place": place}, None,
                         [(1, numpy.float32)])[0]

    def sample_emission(self, code, random):
        """Directions to a viewer, [..., 3], as luminance times the cosine is distributed, and
        their densities in sr^-1, [...]; a density of 0 says that nothing is emitted. random:
        three numbers in [0, 1) each."""
        return self._ask("sample_emission", {"code": code, "random": random}, None,
                         [(3, numpy.float32), (1, numpy.float32)])

    def pdf_emission(self, viewer, code):
        """Density with which `sample_emission` draws a direction, sr^-1, [...]."""
        return self._ask("pdf_emission", {"viewer": viewer, "code": code}, None,
                         [(1, numpy.float32)])[0]
