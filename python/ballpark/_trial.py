"""Drivers that this machine has not started lately are started in a process of their own first: one that crashes, or ends the
program, is left out with a warning, and does not take Python along.

In:    the environment, the system's list of drivers.   Out: OCL_ICD_VENDORS without broken drivers; notes in the cache's folder.
Knows: how the OpenCL loader looks for drivers.   Does not know: what drivers do, nor drivers that hang (the library does).
"""

import atexit
import hashlib
import os
import pathlib
import shutil
import signal
import subprocess
import sys
import tempfile
import threading
import time
import typing

from . import _library as lib
from ._arguments import warn

DAYS = 7  # for which a good start counts
SECONDS = 5  # a driver that takes longer is no matter of this file
GOOD = 86  # an exit code that no driver ends a process with
STARTED = b"started"
# Prints the word before drivers start: without it, the process did not come so far, and nothing is known of them.
PROGRAM = """
import ctypes, os, sys
try:
    import resource
    resource.setrlimit(resource.RLIMIT_CORE, (0, 0))
except Exception:
    pass
library = ctypes.CDLL(sys.argv[1])
library.bp_devices_list.argtypes = [ctypes.c_void_p] * 3
found, count = ctypes.c_void_p(), ctypes.c_size_t()
os.write(1, b"started")
library.bp_devices_list(ctypes.addressof(found), ctypes.addressof(count), None)
os._exit(86)
"""

_done = False
_wrong = ""  # drivers that would end this process; it cannot use any
_trying = threading.Lock()


def _unlock() -> None:
    """In a forked process, where the thread that tries drivers is not."""
    global _trying
    _trying = threading.Lock()


os.register_at_fork(after_in_child=_unlock)


def driver_files() -> typing.List[pathlib.Path]:
    """The .icd files of which the loader starts the drivers; none where it is told a library, which is a choice."""
    system = pathlib.Path(os.environ.get("OPENCL_VENDOR_PATH") or "/etc/OpenCL/vendors")
    told = os.environ.get("OCL_ICD_VENDORS", "")
    place = pathlib.Path(told or system)
    if told and "/" not in told and (system / told).is_file():
        place = system / told
    if place.is_dir():
        return sorted(place.glob("*.icd"))
    return [place] if place.suffix == ".icd" and place.is_file() else []


def _text_of(file: pathlib.Path) -> str:
    try:
        return file.read_text(errors="replace").strip()
    except OSError:
        return ""


def _changed(path: str) -> int:
    try:
        return os.stat(path).st_mtime_ns
    except OSError:
        return 0


def _note(files: typing.List[pathlib.Path], library: str) -> typing.Optional[pathlib.Path]:
    """The file that says that these drivers have started well; None: there is no folder for it."""
    cache = os.environ.get("XDG_CACHE_HOME", "")
    home = os.environ.get("HOME", "")
    folder = cache if cache.startswith("/") else f"{home}/.cache" if home.startswith("/") else ""
    if not folder:
        return None
    seen = [(str(file), _changed(str(file)), _text_of(file), _changed(_text_of(file))) for file in files]
    key = hashlib.sha256(repr((seen, library, _changed(library))).encode()).hexdigest()[:16]
    return pathlib.Path(folder, "ballpark", f"drivers-{key}.txt")


def _is_recent(note: typing.Optional[pathlib.Path]) -> bool:
    age = time.time() - _changed(str(note)) / 1e9 if note is not None else -1.0
    return 0 <= age < DAYS * 86400


def _write(note: typing.Optional[pathlib.Path]) -> None:
    if note is None:
        return
    try:
        note.parent.mkdir(mode=0o700, parents=True, exist_ok=True)
        note.write_text("These OpenCL drivers have started without a crash.\n")
    except OSError:
        pass  # then they are tried again


def _try(library: str, vendors: typing.Optional[str]) -> str:
    """Starts drivers in another process. "": nothing is wrong, or nothing is known; else what happened."""
    environment = dict(os.environ) if vendors is None else dict(os.environ, OCL_ICD_VENDORS=vendors)
    try:
        ended = subprocess.run([sys.executable, "-I", "-S", "-c", PROGRAM, library], env=environment, stdin=subprocess.DEVNULL,
                               stdout=subprocess.PIPE, stderr=subprocess.DEVNULL, timeout=SECONDS, check=False)
    except (OSError, subprocess.SubprocessError):
        return "?"
    if ended.returncode == GOOD:
        return ""
    if not ended.stdout.startswith(STARTED):
        return "?"
    if ended.returncode >= 0:
        return f"ended the process with exit code {ended.returncode}"
    return f"crashed: {signal.strsignal(-ended.returncode) or f'signal {-ended.returncode}'}"


def _leave_out(files: typing.List[pathlib.Path], library: str, reason: str) -> str:
    """Finds those to blame, and points the loader to the others. Returns what is wrong if that helps nothing, else ""."""
    broken = {file: how for file, how in ((file, _try(library, str(file))) for file in files) if how not in ("", "?")}
    said = [f"{file} ({_text_of(file)}) {how}" for file, how in broken.items()]
    good = [file for file in files if file not in broken]
    if not broken or not good:
        return (f"an OpenCL driver {reason}, while starting: {', '.join(said) or 'all of them together'}; remove it, or set "
                "OCL_ICD_VENDORS to the .icd file of another; `ballpark devices` shows which ones work")
    for file, how in broken.items():
        warn(f"ballpark: the OpenCL driver {file} ({_text_of(file)}) is left out, as it {how}")
    folder = tempfile.mkdtemp(prefix="ballpark-drivers-")
    process = os.getpid()
    atexit.register(lambda: shutil.rmtree(folder, ignore_errors=True) if os.getpid() == process else None)
    for file in good:
        shutil.copy(file, folder)
    os.environ["OCL_ICD_VENDORS"] = folder
    return ""


def try_drivers(library: str) -> None:
    """Once in a process, before its first use of a driver. Without a note of a good start, that takes as long as such a start."""
    global _done, _wrong
    with _trying:
        files = [] if _done or not sys.executable else driver_files()
        if files:
            note = _note(files, library)
            reason = "" if _is_recent(note) else _try(library, None)
            if reason not in ("", "?"):
                _wrong = _leave_out(files, library, reason)
            elif reason == "" and not _is_recent(note):
                _write(note)
        _done = True
        if _wrong:
            raise lib.DeviceError(_wrong, "device error")
