"""The shared library as host/ballpark.h declares it.

In:    libballpark.so.   Out: its functions and structs, and its failures as exceptions.
Knows: the C interface (tests/python compares the structs with the header).   Does not know: numpy, scenes.
"""

import ctypes as c
import os
import pathlib
import threading
import typing

from . import _driver

API_VERSION = 1


def shown(text: str) -> str:
    """The text as a terminal may show it: control characters, of a file's name for example, as \\x1b."""
    return "".join(char if char.isprintable() else char.encode("unicode_escape").decode() for char in text)


class Error(Exception):
    """What went wrong, and what to do about it.

    `status` names the kind of error ("bad scene", "device error", ...). `file`, `line` and `column` tell the place,
    where there is one: "" and 0 otherwise. `log` is a long text such as a compiler's, or "".
    """

    def __init__(self, message: str, status: str = "", file: str = "", line: int = 0, column: int = 0, log: str = ""):
        place = file + (f":{line}:{column}" if line else "") if file else ""
        super().__init__(shown(f"{place}: {message}" if place and not message.startswith(file) else message))
        self.message, self.status, self.file, self.line, self.column, self.log = message, status, file, line, column, log


class SceneError(Error, ValueError):
    """A scene, an array or an option is not valid; the message names the member."""


class DeviceError(Error, RuntimeError):
    """A device, its driver or its compiler failed, or there is none that fits."""


class BpError(c.Structure):
    _fields_ = [("code", c.c_int), ("message", c.c_char * 1024), ("file", c.c_char * 512), ("line", c.c_int),
                ("column", c.c_int), ("attachment", c.c_char_p), ("remedy", c.c_int), ("remedy_value", c.c_char * 24)]


class BpRows(c.Structure):
    _fields_ = [("data", c.c_void_p), ("row_stride", c.c_ssize_t), ("column_stride", c.c_ssize_t), ("type", c.c_int)]


class BpSphereSet(c.Structure):
    _fields_ = [("count", c.c_size_t), ("center", BpRows), ("radius", BpRows), ("color", BpRows),
                ("material", c.c_char_p), ("name", c.c_char_p), ("interior", c.c_char_p)]


class BpMeshSet(c.Structure):
    _fields_ = [("vertex_count", c.c_size_t), ("triangle_count", c.c_size_t), ("vertex", BpRows), ("triangle", c.c_void_p),
                ("color", BpRows), ("material", c.c_char_p), ("name", c.c_char_p), ("normal", BpRows), ("smooth", c.c_uint32),
                ("uv_of_corners", c.c_uint32), ("uv", BpRows), ("interior", c.c_char_p)]


class BpLineSet(c.Structure):
    _fields_ = [("point_count", c.c_size_t), ("line_count", c.c_size_t), ("point", BpRows), ("line", c.c_void_p), ("radius", BpRows),
                ("color", BpRows * 2), ("material", c.c_char_p), ("name", c.c_char_p), ("interior", c.c_char_p)]


class BpShapeSets(c.Structure):
    _fields_ = [("spheres", c.POINTER(BpSphereSet)), ("sphere_set_count", c.c_size_t), ("meshes", c.POINTER(BpMeshSet)),
                ("mesh_set_count", c.c_size_t), ("lines", c.POINTER(BpLineSet)), ("line_set_count", c.c_size_t)]


class BpSceneInfo(c.Structure):
    _fields_ = [("title", c.c_char_p), ("source", c.c_char_p), ("width", c.c_uint32), ("height", c.c_uint32),
                ("samples_per_pixel", c.c_uint32), ("max_depth", c.c_uint32), ("spheres", c.c_size_t),
                ("materials", c.c_size_t), ("transfer", c.c_int), ("triangles", c.c_size_t), ("capsules", c.c_size_t)]


class BpCameraInfo(c.Structure):
    _fields_ = [("vfov", c.c_double), ("lookfrom", c.c_double * 3), ("lookat", c.c_double * 3),
                ("vup", c.c_double * 3), ("aperture", c.c_double), ("focus_dist", c.c_double)]


class BpElementInfo(c.Structure):
    _fields_ = [("symbol", c.c_char * 4), ("mass", c.c_double), ("van_der_waals", c.c_double),
                ("covalent", c.c_double), ("color", c.c_double * 3)]


class BpDeviceInfo(c.Structure):
    _fields_ = [("number", c.c_uint), ("type", c.c_int), ("platform", c.c_char * 128), ("name", c.c_char * 256),
                ("vendor", c.c_char * 128), ("version", c.c_char * 128), ("driver", c.c_char * 128),
                ("compute_units", c.c_uint), ("float_lanes", c.c_uint), ("memory_bytes", c.c_uint64),
                ("largest_allocation_bytes", c.c_uint64), ("has_double", c.c_bool), ("has_compiler", c.c_bool),
                ("available", c.c_bool), ("refusal", c.c_char * 128), ("clock_mhz", c.c_uint),
                ("has_shared_memory", c.c_bool)]


class BpRenderOptions(c.Structure):
    _fields_ = [("samples_per_pixel", c.c_uint64), ("first_sample", c.c_uint64), ("max_depth", c.c_uint32),
                ("seed", c.c_uint64), ("precision", c.c_int), ("math", c.c_int), ("numerics", c.c_int),
                ("sampler", c.c_int), ("light_sampling", c.c_int), ("caustics", c.c_int), ("roulette", c.c_int), ("kernel", c.c_int),
                ("all_effects", c.c_bool), ("extra_effects", c.c_uint32), ("adaptive", c.c_bool), ("features", c.c_bool),
                ("samples_only", c.c_bool), ("force", c.c_bool), ("job_first", c.c_uint64),
                ("job_samples", c.c_uint64), ("replicates", c.c_uint32),
                ("threads", c.c_uint32), ("chunk_samples", c.c_uint32), ("local_size", c.c_uint32),
                ("tree_width", c.c_uint32), ("packet_lanes", c.c_uint32), ("force_list", c.c_bool),
                ("force_tree", c.c_bool), ("force_float_refine", c.c_bool), ("build_mark", c.c_uint64)]


class BpProgress(c.Structure):
    _fields_ = [("samples_done", c.c_uint64), ("samples_total", c.c_uint64), ("trace_seconds", c.c_double),
                ("finished", c.c_bool)]


class BpStopRule(c.Structure):
    _fields_ = [("error", c.c_double), ("seconds", c.c_double), ("samples_max", c.c_uint64),
                ("samples_min", c.c_uint64), ("adaptive", c.c_bool)]


class BpStopEstimate(c.Structure):
    _fields_ = [("seconds", c.c_double), ("samples_per_second", c.c_double), ("nrmse", c.c_double),
                ("fraction", c.c_double), ("seconds_left", c.c_double)]


class BpPicture(c.Structure):
    _fields_ = [("width", c.c_uint32), ("height", c.c_uint32), ("rgb", c.c_void_p), ("error", c.c_void_p),
                ("samples", c.c_void_p), ("alpha", c.c_void_p), ("depth", c.c_void_p), ("normal", c.c_void_p),
                ("albedo", c.c_void_p)]


class BpFilmInfo(c.Structure):
    _fields_ = [("title", c.c_char_p), ("width", c.c_uint32), ("height", c.c_uint32), ("samples_per_pixel", c.c_uint64),
                ("samples_least", c.c_uint64), ("samples_most", c.c_uint64), ("samples_mean", c.c_double),
                ("range_count", c.c_size_t), ("partial", c.c_bool), ("segments", c.c_uint64),
                ("truncated_paths", c.c_uint64), ("invalid_samples", c.c_uint64), ("not_finite_samples", c.c_uint64),
                ("negative_samples", c.c_uint64), ("out_of_range_samples", c.c_uint64), ("shadow_rays", c.c_uint64),
                ("scene_hash", c.c_uint64), ("seed", c.c_uint64), ("max_depth", c.c_uint32), ("replicates", c.c_uint32),
                ("sampler", c.c_int), ("precision", c.c_int), ("math", c.c_int), ("numerics", c.c_int),
                ("light_sampling", c.c_int), ("caustics", c.c_int), ("roulette", c.c_int), ("transfer", c.c_int)]


# Their C names are those of the classes.
STRUCTS: typing.List[typing.Type[c.Structure]] = [
    BpError, BpRows, BpSphereSet, BpMeshSet, BpLineSet, BpShapeSets, BpSceneInfo, BpCameraInfo, BpElementInfo, BpDeviceInfo,
    BpRenderOptions, BpProgress, BpStopRule, BpStopEstimate, BpPicture, BpFilmInfo]

INTERFACE = 2  # BP_INTERFACE_PYTHON: messages name arguments, not options of the command line

# Words of enumerations, in the order of the header.
TRANSFERS = ["gamma2", "srgb", "linear"]
FORMATS = ["png", "ppm", "ppm-ascii", "pfm", "exr", "bpa", "pdf", "svg"]
PICTURES = FORMATS[:FORMATS.index("bpa")]  # those that the library writes
DEVICE_TYPES = ["cpu", "gpu", "other"]
CHOICES = {"precision": ["single", "double"], "math": ["strict", "fast"], "numerics": ["robust", "plain"],
           "sampler": ["independent", "sobol"], "light_sampling": ["on", "off"], "caustics": ["auto", "off", "on"],
           "roulette": ["on", "off"], "kernel": ["auto", "sample", "packet", "pool"]}

_HANDLE = c.POINTER(c.c_void_p)
_ERR = c.POINTER(BpError)
_VECTOR = c.c_double * 3

# Functions that return a status take the error last, which call() adds.
_STATUS: typing.Dict[str, typing.List[typing.Any]] = {
    "bp_scene_load": [c.c_char_p, _HANDLE],
    "bp_scene_parse_with_shapes": [c.c_char_p, c.c_size_t, c.c_char_p, c.POINTER(BpShapeSets), _HANDLE],
    "bp_scene_load_selected": [c.c_char_p, c.c_char_p, _HANDLE],
    "bp_scene_set_width": [c.c_void_p, c.c_uint32],
    "bp_devices_list": [c.POINTER(c.POINTER(BpDeviceInfo)), c.POINTER(c.c_size_t)],
    "bp_device_find": [c.c_char_p, c.POINTER(BpDeviceInfo)],
    "bp_render_create": [c.c_void_p, c.POINTER(BpRenderOptions), c.POINTER(BpDeviceInfo), c.c_size_t, _HANDLE],
    "bp_render_step": [c.c_void_p, c.POINTER(BpProgress)],
    "bp_render_film": [c.c_void_p, _HANDLE],
    "bp_stop_create": [c.c_void_p, c.POINTER(BpStopRule), _HANDLE],
    "bp_stop_check": [c.c_void_p, c.POINTER(BpProgress), c.POINTER(c.c_int)],
    "bp_stop_estimate": [c.c_void_p, c.POINTER(BpProgress), c.POINTER(BpStopEstimate)],
    "bp_film_picture": [c.c_void_p, c.POINTER(BpPicture)],
    "bp_film_write": [c.c_void_p, c.c_char_p],
    "bp_picture_write": [c.POINTER(BpPicture), c.c_char_p, c.c_int, c.c_int],
    "bp_picture_encode": [c.POINTER(BpPicture), c.c_int, c.c_int, _HANDLE, c.POINTER(c.c_size_t)],
    "bp_error_map_write": [c.POINTER(BpPicture), c.c_char_p],
}
_OTHER: typing.Dict[str, typing.Tuple[typing.Any, typing.List[typing.Any]]] = {
    "bp_status_name": (c.c_char_p, [c.c_int]),
    "bp_error_add_remedy": (None, [_ERR, c.c_int]),
    "bp_error_clear": (None, [_ERR]),
    "bp_free": (None, [c.c_void_p]),
    "bp_version": (c.c_char_p, []),
    "bp_api_version": (c.c_int, []),
    "bp_scene_destroy": (None, [_HANDLE]),
    "bp_scene_info": (None, [c.c_void_p, c.POINTER(BpSceneInfo)]),
    "bp_scene_camera": (None, [c.c_void_p, c.POINTER(BpCameraInfo)]),
    "bp_element_info": (c.c_bool, [c.c_uint, c.POINTER(BpElementInfo)]),
    "bp_element_of_atom": (c.c_uint, [c.c_char_p, c.c_char_p]),
    "bp_type_color": (None, [c.c_size_t, _VECTOR]),
    "bp_color_map_name": (c.c_char_p, [c.c_size_t]),
    "bp_color_map": (c.c_bool, [c.c_char_p, c.c_double, _VECTOR]),
    "bp_render_defaults": (None, [c.c_void_p, c.POINTER(BpRenderOptions)]),
    "bp_render_samples_done": (c.c_uint64, [c.c_void_p]),
    "bp_render_destroy": (None, [_HANDLE]),
    "bp_stop_reason_name": (c.c_char_p, [c.c_int]),
    "bp_stop_rule_defaults": (None, [c.c_void_p, c.POINTER(BpRenderOptions), c.POINTER(BpStopRule)]),
    "bp_stop_destroy": (None, [_HANDLE]),
    "bp_film_nrmse": (c.c_double, [c.c_void_p]),
    "bp_film_info": (None, [c.c_void_p, c.POINTER(BpFilmInfo)]),
    "bp_film_unseen_part": (c.c_double, [c.c_void_p]),
    "bp_film_destroy": (None, [_HANDLE]),
    "bp_picture_clear": (None, [c.POINTER(BpPicture)]),
    "bp_picture_bytes": (None, [c.POINTER(BpPicture), c.c_int, c.c_void_p]),
}

_loaded: typing.Optional[c.CDLL] = None
_loading = threading.Lock()


def _find() -> str:
    """BALLPARK_LIBRARY, the library that came with this package, or one that the system knows."""
    chosen = os.environ.get("BALLPARK_LIBRARY")
    if chosen:
        return chosen
    name = f"libballpark.so.{API_VERSION // 1000}.{API_VERSION % 1000}"
    beside = pathlib.Path(__file__).with_name(name)
    return str(beside) if beside.exists() else name


def _open() -> c.CDLL:
    _driver.choose()
    path = _find()
    try:
        opened = c.CDLL(path)
    except OSError as problem:
        raise ImportError(f"cannot open {path}: {problem}; install the wheel ballpark-render, or name the library "
                          "in BALLPARK_LIBRARY") from None
    opened.bp_api_version.restype = c.c_int
    if opened.bp_api_version() != API_VERSION:
        raise ImportError(f"{path} is of another version of Ballpark: its interface is {opened.bp_api_version()}, "
                          f"expected {API_VERSION}")
    for name, arguments in _STATUS.items():
        function = getattr(opened, name)
        function.restype, function.argtypes = c.c_int, [*arguments, _ERR]
    for name, (result, arguments) in _OTHER.items():
        function = getattr(opened, name)
        function.restype, function.argtypes = result, arguments
    return opened


def library() -> c.CDLL:
    """The shared library, opened at the first call: once, whatever threads make it, as the environment is changed first."""
    global _loaded
    if _loaded is None:
        with _loading:
            if _loaded is None:
                _loaded = _open()
    return _loaded


def _unlock() -> None:
    """In a forked process, where the thread that opens the library is not."""
    global _loading
    _loading = threading.Lock()


os.register_at_fork(after_in_child=_unlock)


def failure(status: int, error: BpError, hide_place: bool = False) -> Error:
    """The exception for a failed call; releases what `error` holds."""
    name = library().bp_status_name(status).decode()
    kinds: typing.Dict[str, typing.Type[Error]] = {
        "bad scene": SceneError, "usage error": SceneError, "device error": DeviceError,
        "kernel build error": DeviceError, "no such device": DeviceError, "a device or its driver is broken": DeviceError}
    log = (error.attachment or b"").decode(errors="replace")
    message = error.message.decode(errors="replace") or name
    file = error.file.decode(errors="replace")
    line, column = error.line, error.column
    library().bp_error_clear(c.byref(error))
    if hide_place:
        file, line, column = "", 0, 0
    return kinds.get(name, Error)(message, name, file, line, column, log)


def call(name: str, *arguments: typing.Any, hide_place: bool = False) -> None:
    """Calls a function that returns a status, and raises what it reports."""
    error = BpError()
    status = getattr(library(), name)(*arguments, c.byref(error))
    if status == 0:
        return
    library().bp_error_add_remedy(c.byref(error), INTERFACE)
    if status == 2:  # BP_ERR_MEMORY
        message = error.message.decode(errors="replace")
        library().bp_error_clear(c.byref(error))
        raise MemoryError(message or "out of memory")
    raise failure(status, error, hide_place)


class Handle:
    """An object of the library, destroyed with this one; `kind` is "scene", "render", "stop" or "film".

    first: what has to be destroyed before it. A process that inherits it by a fork leaves it alone: a thread that is not
    there may have been changing it, and its memory goes with the process.
    """

    def __init__(self, kind: str, first: typing.Optional["Handle"] = None):
        self.kind, self.pointer, self._first, self._process = kind, c.c_void_p(), first, os.getpid()

    @property
    def address(self) -> typing.Any:
        return c.byref(self.pointer)

    def __bool__(self) -> bool:
        return bool(self.pointer)

    def __reduce__(self) -> typing.NoReturn:
        what, instead = {"film": ("picture", "its arrays, such as picture.radiance, or a file"),
                         "scene": ("scene", "what it was made of")}.get(self.kind, (self.kind, "its scene and options"))
        raise TypeError(f"a {what} lives in the memory of this process and can be neither pickled nor copied; hand over "
                        f"{instead} instead")

    def destroy(self) -> None:
        if self._first is not None:
            self._first.destroy()
        if self.pointer and self._process == os.getpid():
            getattr(library(), f"bp_{self.kind}_destroy")(c.byref(self.pointer))

    def __del__(self) -> None:
        if _loaded is not None:
            self.destroy()
