"""Renders: from a scene to a picture, step by step.

In:    a scene, options.   Out: pictures, progress.
Knows: stop rules, interruption.   Does not know: where scenes come from.
"""

import collections.abc
import ctypes as c
import dataclasses
import difflib
import inspect
import math
import os
import sys
import threading
import types
import typing

import numpy.typing as npt

from . import _library as lib
from ._arguments import ADAPTERS, c_text, warn, whole_number, wrong_type
from ._colors import Color
from ._interrupt import CtrlC, Job, interruptible
from ._picture import Picture
from ._lines import Lines
from ._mesh import Mesh
from ._scene import SHAPES, Document, Scene, Shape, Spheres, list_of_shapes, shape_document
from ._trial import try_drivers


class Interrupted(KeyboardInterrupt):
    """Ctrl-C ended a render. `picture` is what it has rendered so far, or None if no pixel has a sample yet."""

    def __init__(self, picture: typing.Optional[Picture]):
        super().__init__("interrupted")
        self.picture = picture


@dataclasses.dataclass(frozen=True)
class Progress:
    """How far a render is. `noise` and `seconds_left` are NaN while they are unknown."""

    fraction: float
    seconds: float
    seconds_left: float
    noise: float
    samples: int
    samples_per_second: float


@dataclasses.dataclass(frozen=True)
class Device:
    """An OpenCL device, as `ballpark devices` lists it."""

    number: int
    type: str
    name: str
    platform: str
    driver: str
    compute_units: int
    memory_bytes: int
    has_double: bool
    refusal: str


def _device(info: lib.BpDeviceInfo) -> Device:
    return Device(info.number, lib.DEVICE_TYPES[info.type], info.name.decode(errors="replace"),
                  info.platform.decode(errors="replace"), info.driver.decode(errors="replace"), info.compute_units,
                  info.memory_bytes, info.has_double, info.refusal.decode(errors="replace"))


def devices() -> typing.List[Device]:
    """Every OpenCL device; those with a `refusal` cannot render."""
    try_drivers(lib.library()._name)
    return interruptible(_list_devices, START_SECONDS, daemon=True)


def _list_devices() -> typing.List[Device]:
    found, count = c.POINTER(lib.BpDeviceInfo)(), c.c_size_t()
    lib.call("bp_devices_list", c.byref(found), c.byref(count))
    try:
        return [_device(found[i]) for i in range(count.value)]
    finally:
        lib.library().bp_free(c.cast(found, c.c_void_p))


class Render:
    """A render of a scene, for pictures on the way: step() until it returns a reason, picture() at any time.

    spp: samples per pixel; error: noise to reach, a fraction such as 0.01; time: seconds. The first that is reached
    ends it; without any, the scene's samples per pixel do. With error or time and without spp, samples have no limit.
    device: its number, a part of its name, "gpu" or "cpu"; None: the most capable GPU, or else a CPU. depth: ray segments of
    a path at most. aovs=True adds depth, normal and albedo. The other options are described by `ballpark help render`.
    """

    def __init__(self, scene: Scene, *, spp: typing.Optional[int] = None, error: typing.Optional[float] = None,
                 time: typing.Optional[float] = None, seed: int = 0, depth: typing.Optional[int] = None,
                 first_sample: int = 0, device: typing.Union[None, int, str] = None, sampler: str = "sobol",
                 precision: str = "single", math: str = "strict", numerics: str = "robust", light_sampling: str = "on",
                 caustics: str = "auto", roulette: str = "on", kernel: str = "auto", adaptive: bool = False, aovs: bool = False, threads: int = 0,
                 force: bool = False):
        if not isinstance(scene, Scene):
            raise wrong_type("ballpark.Render", scene, "a Scene, such as ballpark.make_scene() returns")
        self.scene = scene
        self._stop = lib.Handle("stop")
        self._render = lib.Handle("render", first=self._stop)
        self._progress, self._reason = lib.BpProgress(), c.c_int(0)
        self._lock, self._busy, self._closing, self._process = threading.Lock(), False, False, os.getpid()
        options = lib.BpRenderOptions()
        lib.library().bp_render_defaults(scene._handle.pointer, c.byref(options))
        words = {"sampler": sampler, "precision": precision, "math": math, "numerics": numerics, "light_sampling": light_sampling,
                 "caustics": caustics, "roulette": roulette, "kernel": kernel}
        for name, word in words.items():
            if word not in lib.CHOICES[name]:
                raise lib.SceneError(f'{name}: found "{word}", expected one of {", ".join(lib.CHOICES[name])}')
            setattr(options, name, lib.CHOICES[name].index(word))
        if spp is not None:
            options.samples_per_pixel = whole_number("spp", spp, 1, 1 << 32)
        options.seed = whole_number("seed", seed, 0, (1 << 64) - 1)
        options.first_sample = whole_number("first_sample", first_sample, 0, (1 << 32) - 1)
        if depth is not None:
            options.max_depth = whole_number("depth", depth, 0, 1000000)
        options.threads = whole_number("threads", threads, 0, 65536)
        options.adaptive, options.features, options.force = bool(adaptive), bool(aovs), bool(force)
        rule = lib.BpStopRule()
        lib.library().bp_stop_rule_defaults(scene._handle.pointer, c.byref(options), c.byref(rule))
        rule.error, rule.seconds = _positive("error", error), _positive("time", time)
        if spp is None and (error is not None or time is not None):
            rule.samples_max = 0
        chosen = lib.BpDeviceInfo()
        devices()  # starts the drivers, one of which may hang: the end of Python is not to wait for that
        interruptible(lambda: self._create(options, rule, device, chosen))
        self.device = _device(chosen)

    def _create(self, options: lib.BpRenderOptions, rule: lib.BpStopRule, device: typing.Union[None, int, str],
                chosen: lib.BpDeviceInfo) -> None:
        name = None if device is None else c_text("device", str(device))
        lib.call("bp_device_find", name, c.byref(chosen))
        lib.call("bp_render_create", self.scene._handle.pointer, c.byref(options), c.byref(chosen), 1,
                 self._render.address)
        lib.call("bp_stop_create", self._render.pointer, c.byref(rule), self._stop.address)

    def step(self) -> typing.Optional[str]:
        """Renders for about 0.2 s. Returns why the render has ended ("samples", "error", ...), or None: go on."""
        if self._reason.value == 0:
            with CtrlC() as ctrl_c:
                if not self._start_step().wait(ctrl_c, self._patience()):
                    raise KeyboardInterrupt
        return self.stopped

    def _take(self) -> None:
        """From here to _give() no other call may use the handles; one that is closed meanwhile is destroyed by _give()."""
        if self._process != os.getpid():
            devices()  # says that drivers do not survive a fork
        with self._lock:
            if self._busy:
                raise lib.Error("a step of the render is under way, or another thread uses it")
            if self._closing:
                raise lib.Error("the render is closed")
            self._busy = True

    def _give(self) -> None:
        with self._lock:
            self._busy = False
            if self._closing:
                self._render.destroy()

    def _call(self, name: str, *arguments: typing.Any) -> None:
        with CtrlC():
            self._take()
            try:
                lib.call(name, *arguments)
            finally:
                self._give()

    def _patience(self) -> float:
        return STEP_SECONDS if self._progress.samples_done > 0 else START_SECONDS

    def _start_step(self) -> Job:
        self._take()
        return Job(self._step)

    def _step(self) -> None:
        try:
            lib.call("bp_render_step", self._render.pointer, c.byref(self._progress))
            lib.call("bp_stop_check", self._stop.pointer, c.byref(self._progress), c.byref(self._reason))
        finally:
            self._give()

    @property
    def stopped(self) -> typing.Optional[str]:
        """Why the render has ended; None: it has not."""
        if self._reason.value == 0:
            return None
        name: bytes = lib.library().bp_stop_reason_name(self._reason)
        return name.decode()

    def progress(self) -> Progress:
        """How far it is; as often as wanted."""
        estimate = lib.BpStopEstimate()
        self._call("bp_stop_estimate", self._stop.pointer, c.byref(self._progress), c.byref(estimate))
        return Progress(estimate.fraction, estimate.seconds, estimate.seconds_left, estimate.nrmse,
                        self._progress.samples_done, estimate.samples_per_second)

    def picture(self) -> Picture:
        """The picture as it stands, of its own: later steps do not change it."""
        film = lib.Handle("film")
        self._call("bp_render_film", self._render.pointer, film.address)
        picture = Picture(film, self.scene.transfer, self.stopped or "interrupt", self._progress.trace_seconds)
        lost = ", ".join(f"{count:,} {cause}" for cause, count in picture.invalid.items() if count > 0)
        if lost:
            warn(f"ballpark: invalid samples were left out of the picture ({lost}); `ballpark check` compares the device "
                 "with the reference tracer")
        return picture

    def close(self) -> None:
        """Releases the device's memory now instead of when the object is gone, or once a step under way has ended."""
        if self._process != os.getpid():
            return  # the lock may be a thread's that is not here, and the memory goes with the process
        with self._lock:
            self._closing = True
            if not self._busy:
                self._render.destroy()

    def __enter__(self) -> "Render":
        return self

    def __exit__(self, kind: typing.Optional[typing.Type[BaseException]], problem: typing.Optional[BaseException],
                 trace: typing.Optional[types.TracebackType]) -> None:
        self.close()


def _positive(name: str, value: typing.Optional[float]) -> float:
    if value is None:
        return 0.0
    try:
        number = math.nan if isinstance(value, str) else float(value)
    except (TypeError, ValueError, OverflowError):
        number = math.nan
    if not 0 < number < math.inf:
        raise lib.SceneError(f"{name}: found {value!r}, expected a number above 0")
    return number


# How long Ctrl-C waits for the step under way, so that its samples are kept: in a first one the driver may compile. Later
# ones take 0.2 s, but many times as long where other programs keep the processor busy.
START_SECONDS = 0.7
STEP_SECONDS = 30.0


def _partial(render: Render) -> typing.Optional[Picture]:
    return render.picture() if render._progress.samples_done > 0 else None


def _run(render: Render, report: typing.Optional[typing.Callable[[Progress], object]]) -> Picture:
    """Steps to the end; Ctrl-C hands over what there is."""
    while True:
        try:
            if render.stopped is not None:
                return render.picture()
            with CtrlC() as ctrl_c:
                # A step ends soon, unless a driver compiles in it: then nothing is rendered yet, and it is left to its end.
                if not render._start_step().wait(ctrl_c, render._patience()):
                    raise Interrupted(None)
            if report is not None and report(render.progress()) is False:
                return render.picture()
        except Interrupted:
            raise  # the one above, or of another render, in the report
        except KeyboardInterrupt:  # behind a step, or in the report
            raise Interrupted(_partial(render)) from None


def _bar(progress: Progress) -> None:
    noise = "" if math.isnan(progress.noise) else f"  noise {100 * progress.noise:.2g} %"
    left = "" if math.isnan(progress.seconds_left) else f"  {progress.seconds_left:.0f} s left"
    print(f"\rballpark: {100 * progress.fraction:3.0f} %{noise}{left}    ", end="", file=sys.stderr, flush=True)


Subject = typing.Union[Scene, Shape, typing.Sequence[Shape], Document, str, "os.PathLike[str]", npt.ArrayLike]


def _is_shapes(subject: typing.Any) -> bool:
    return isinstance(subject, SHAPES) or (isinstance(subject, (list, tuple)) and any(isinstance(one, SHAPES) for one in subject))


def _with_arrays(subject: typing.Any, arrays: typing.Dict[str, typing.Any]) -> typing.Any:
    """The subject, or the mesh or the lines of these arrays in its place."""
    given = [name for name, value in arrays.items() if value is not None]
    if not given:
        return subject
    if subject is not None:
        raise TypeError(f"{given[0]}: found beside what is to be rendered, expected one or the other; several shapes are a list of "
                        "ballpark.Spheres, ballpark.Mesh and ballpark.Lines")
    if arrays["lines"] is not None:
        for name in ("faces", "normals", "uvs"):
            if arrays[name] is not None:
                raise TypeError(f"{name}: found beside lines, expected one or the other; both are a list of ballpark.Mesh and ballpark.Lines")
        return Lines(arrays["lines"], arrays["vertices"], colors=arrays["colors"])
    del arrays["lines"]
    for name in ("vertices", "faces"):
        if arrays[name] is None:
            raise TypeError(f"{name}: found none, expected them beside {given[0]}")
    return Mesh(**arrays)


def _is_array(subject: typing.Any) -> bool:
    return hasattr(subject, "__array__") or isinstance(subject, collections.abc.Sequence)


def make_scene(subject: typing.Optional[Subject] = None, *, vertices: typing.Optional[npt.ArrayLike] = None,
               faces: typing.Optional[npt.ArrayLike] = None, normals: typing.Optional[npt.ArrayLike] = None,
               uvs: typing.Optional[npt.ArrayLike] = None,
               lines: typing.Optional[npt.ArrayLike] = None, colors: typing.Optional[Color] = None,
               radius: typing.Optional[npt.ArrayLike] = None,
               color: typing.Optional[Color] = None, material: typing.Union[None, str, Document] = None,
               interior: typing.Union[None, str, Document] = None,
               cmap: typing.Optional[str] = None, color_range: typing.Optional[typing.Tuple[float, float]] = None,
               up: typing.Optional[str] = None, camera: typing.Optional[Document] = None,
               width: typing.Optional[int] = None, height: typing.Optional[int] = None,
               materials: typing.Optional[Document] = None, textures: typing.Optional[Document] = None,
               media: typing.Optional[Document] = None, background: typing.Any = None,
               lighting: typing.Optional[str] = None, backdrop: typing.Any = None,
               select: typing.Optional[str] = None) -> Scene:
    """The scene that render() would render of the same arguments; its camera can be used for other pictures."""
    subject = _with_arrays(subject, {"vertices": vertices, "faces": faces, "normals": normals, "uvs": uvs, "lines": lines,
                                     "colors": colors})
    looks: typing.Dict[str, typing.Any] = {"radius": radius, "color": color, "material": material, "interior": interior, "cmap": cmap,
                                           "color_range": color_range, "up": up}
    given = {name: value for name, value in looks.items() if value is not None}
    scene_members = {name: value for name, value in (("materials", materials), ("textures", textures), ("media", media), ("background", background),
                                                         ("lighting", lighting), ("backdrop", backdrop))
                     if value is not None}
    if isinstance(subject, (Scene, str, os.PathLike, collections.abc.Mapping)):
        extra = list(given) + list(scene_members) + [name for name, value in (("camera", camera), ("height", height))
                                                     if value is not None]
        if extra:
            raise lib.SceneError(f"{extra[0]}: found beside a whole scene, expected it in the scene itself")
        if select is not None and not isinstance(subject, (str, os.PathLike)):
            raise lib.SceneError('select: found beside a scene that is no file, expected "select" in its "particles"')
        if isinstance(subject, Scene):
            scene = subject
        elif isinstance(subject, collections.abc.Mapping):
            scene = Scene(subject)
        else:
            scene = Scene.load(subject, select)
        if width is not None and width != scene.width:
            scene.set_width(width)
        return scene
    if select is not None:
        raise lib.SceneError("select: found beside arrays, expected the path of a file of particles; index the arrays instead")
    shapes: typing.List[Shape]
    if _is_shapes(subject):
        shapes = list_of_shapes(subject)
        for name, kind, noun in (("radius", Mesh, "a mesh"), ("color", Mesh, "a mesh"), ("color", Lines, "lines")):
            if name in given and any(isinstance(one, kind) for one in shapes):
                raise lib.SceneError(f"{name}: found for {noun}, expected {'colors' if name == 'color' else 'none'}")
        shapes = [dataclasses.replace(one, **given) for one in shapes]
    elif not _is_array(subject) or type(subject).__module__.partition(".")[0] in ADAPTERS:
        raise wrong_type("ballpark.render", subject, "positions (N, 3), Spheres, a Mesh, Lines, a dict, a Scene, the path of a file, "
                         "lines=, or vertices= and faces=")
    else:
        shapes = [Spheres(typing.cast(npt.ArrayLike, subject), **given)]
    return Scene(shape_document(shapes, camera, width, height, scene_members), shapes)


FORMER_NAMES = {"lamps": "light_sampling", "light": "lighting"}


def _refuse_unknown(options: typing.Dict[str, typing.Any]) -> None:
    """Names the option that was probably meant, before any work."""
    known = set(inspect.signature(Render).parameters) - {"scene"}
    for name in sorted(set(options) - known):
        if name in FORMER_NAMES:
            raise TypeError(f"ballpark.render has no option {name!r}, which is now {FORMER_NAMES[name]!r}")
        near = difflib.get_close_matches(name, [*known, *inspect.signature(render).parameters], 1, 0.8)
        raise TypeError(f"ballpark.render has no option {name!r}" + (f"; did you mean {near[0]!r}?" if near else ""))


def render(subject: typing.Optional[Subject] = None, *, vertices: typing.Optional[npt.ArrayLike] = None,
           faces: typing.Optional[npt.ArrayLike] = None, normals: typing.Optional[npt.ArrayLike] = None,
           uvs: typing.Optional[npt.ArrayLike] = None,
           lines: typing.Optional[npt.ArrayLike] = None, colors: typing.Optional[Color] = None,
           radius: typing.Optional[npt.ArrayLike] = None, color: typing.Optional[Color] = None,
           material: typing.Union[None, str, Document] = None, interior: typing.Union[None, str, Document] = None, cmap: typing.Optional[str] = None,
           color_range: typing.Optional[typing.Tuple[float, float]] = None, up: typing.Optional[str] = None,
           camera: typing.Optional[Document] = None, width: typing.Optional[int] = None,
           height: typing.Optional[int] = None, materials: typing.Optional[Document] = None,
           textures: typing.Optional[Document] = None, media: typing.Optional[Document] = None,
           background: typing.Any = None, lighting: typing.Optional[str] = None, backdrop: typing.Any = None,
           select: typing.Optional[str] = None,
           progress: typing.Union[None, bool, typing.Callable[[Progress], object]] = None,
           **options: typing.Any) -> Picture:
    """Renders a picture.

    subject: positions (N, 3); Spheres, Meshes, Lines, or a list of them; a scene as a dict, a Scene, or the path of a scene, of a
    file of particles or of a mesh. Or in its place vertices, faces, normals, uvs and colors of a mesh, as in Mesh, or lines, vertices
    and colors of lines, as in Lines.
    For positions and Spheres: radius, color, material, interior, cmap, color_range and up as in Spheres; for Lines: those but
    color; for a mesh: those but color and radius; camera: members of the scene's "camera" (without lookfrom, lookat or focus_dist it is fitted to the shapes); width, height: of the picture;
    materials, textures, media, background, lighting, backdrop: as in a scene. Without background and lighting, the light is "soft" on white, and for
    a mesh that of a "studio".
    select: of a file of particles, or of a scene's, only those for which this expression holds, such as "element == 'Fe'".
    progress: True for a line on standard error, or a function that is called with a Progress about five times a second;
    when it returns False, the render ends with what it has.
    options: those of Render (spp, error, time, seed, device, adaptive, aovs, ...).

    Ctrl-C raises Interrupted, a KeyboardInterrupt, whose `picture` is what was rendered so far.
    """
    _refuse_unknown(options)
    if progress is not None and not isinstance(progress, bool) and not callable(progress):
        raise wrong_type("progress", progress, "True or a function")
    report = _bar if progress is True else progress if callable(progress) else None
    try:
        scene = make_scene(subject, vertices=vertices, faces=faces, normals=normals, uvs=uvs, lines=lines, colors=colors, radius=radius,
                           color=color, material=material, interior=interior, cmap=cmap, color_range=color_range, up=up, camera=camera, width=width,
                           height=height, materials=materials, textures=textures, media=media, background=background, lighting=lighting, backdrop=backdrop,
                           select=select)
        running = Render(scene, **options)
    except KeyboardInterrupt:
        raise Interrupted(None) from None
    with running:
        try:
            return _run(running, report)
        finally:
            if progress is True:
                print(file=sys.stderr)
