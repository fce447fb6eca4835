"""A copy of PoCL that compiles Ballpark's kernels in about half the time, for tests: trim_pocl.py FOLDER BALLPARK SOURCE_DIR

In:    the PoCL that is installed, as the OpenCL loader finds it; the sources of all kernels, those of tests too.
Out:   FOLDER/vendors, which OCL_ICD_VENDORS may name: the copy, without the other drivers that are installed. A program loads
       every driver it finds, and Mesa's take 15 ms; tests of other drivers name them.
       Where it cannot be made, there is no FOLDER, and one line says why: tests then use PoCL as it is installed.
Knows: what PoCL's files are called, how OpenCL's functions are mangled, LLVM's interface in C.
Does not know: what the kernels do.

In each process that compiles, PoCL reads its whole library of functions (9 MB of LLVM's bitcode) and clang's header with all
their declarations (0.9 MB), which takes 0.6 s, as long as it takes to compile a kernel without optimising it. Here both have
only functions whose names stand in a kernel, and what these call, unchanged. So pictures have the same bits; and a kernel that
calls another function fails to compile, until the next build.
"""

import ctypes
import hashlib
import json
import os
import pathlib
import re
import shutil
import subprocess
import sys

# Functions whose names the kernels put together by macros.
ASSEMBLED = re.compile(r"(convert_(float|double|u?char|u?int|u?long)|vload|vstore)(2|3|4|8|16)?")
# Types that no kernel has: short and half.
MANGLED = re.compile(r"Dh|(^|_)[st]")
DECLARED = re.compile(r"\b(u?short|half)\d*\b")
# Which of the libraries for instruction sets are trimmed. The others are there too, but as they are installed.
TRIMMED = re.compile(r"kernel-(x86_64-.*-(avx512|avx2|sse41|sse2)|aarch64-.*)\.bc")


class CannotTrim(Exception):
    pass


class Llvm:
    """The few functions of LLVM's C interface that are needed, from the library that PoCL itself has loaded."""

    def __init__(self, path):
        self.library = ctypes.CDLL(path)

    def call(self, name, result, *arguments):
        function = self.library[name]
        function.restype = result
        return function(*[ctypes.c_void_p(a) if isinstance(a, int) else a for a in arguments])

    def trim(self, source, target, wanted):
        """Writes the functions of the bitcode file `source` whose names are `wanted`, and what they call, to `target`."""
        memory, module, message = ctypes.c_void_p(), ctypes.c_void_p(), ctypes.c_char_p()
        if self.call("LLVMCreateMemoryBufferWithContentsOfFile", ctypes.c_int, str(source).encode(), ctypes.byref(memory),
                     ctypes.byref(message)):
            raise CannotTrim(f"{source}: {message.value}")
        context = self.call("LLVMContextCreate", ctypes.c_void_p)
        if self.call("LLVMParseBitcodeInContext2", ctypes.c_int, context, memory, ctypes.byref(module)):
            raise CannotTrim(f"{source} is no bitcode of this LLVM")
        internal, external, hidden = 8, 0, []
        for function in self.functions(module):
            if not wanted(self.name(function)):
                self.call("LLVMSetLinkage", None, function, internal)
                hidden.append(self.name(function))
        options = self.call("LLVMCreatePassBuilderOptions", ctypes.c_void_p)
        if self.call("LLVMRunPasses", ctypes.c_void_p, module, b"globaldce,strip-dead-prototypes", None, options):
            raise CannotTrim(f"LLVM cannot trim {source}")
        hidden = set(hidden)
        for function in self.functions(module):  # what the wanted ones call
            if self.name(function) in hidden:
                self.call("LLVMSetLinkage", None, function, external)
        if self.call("LLVMWriteBitcodeToFile", ctypes.c_int, module, str(target).encode()):
            raise CannotTrim(f"{target} cannot be written")
        self.call("LLVMDisposeModule", None, module)
        self.call("LLVMContextDispose", None, context)

    def functions(self, module):
        """Those with a body."""
        function = self.call("LLVMGetFirstFunction", ctypes.c_void_p, module)
        while function:
            if not self.call("LLVMIsDeclaration", ctypes.c_int, function):
                yield function
            function = self.call("LLVMGetNextFunction", ctypes.c_void_p, function)

    def name(self, function):
        return self.call("LLVMGetValueName2", ctypes.c_char_p, function, ctypes.byref(ctypes.c_size_t())).decode()


def kernel_words(source_dir):
    """Every word in the sources of kernels: in kernels/, and in files of the host and of tests that have some of their own."""
    words = set()
    for folder in ("kernels", "host", "tests"):
        for path in (source_dir / folder).rglob("*"):
            if path.suffix in (".cl", ".h", ".c", ".py") and path != pathlib.Path(__file__).resolve():
                text = path.read_text(encoding="utf-8")
                if folder == "kernels" or "kernel void" in text:
                    words.update(re.findall(r"\w+", text))
    return words


def is_wanted(words):
    def named(name):
        return name in words or ASSEMBLED.fullmatch(name)

    def wanted(symbol):
        mangled = re.match(r"_Z(\d+)(.*)", symbol)
        if not mangled:  # PoCL's own, and the mathematical library that its functions call
            return not symbol.startswith("Sleef_")
        length = int(mangled[1])
        return named(mangled[2][:length].removeprefix("_cl_")) and not MANGLED.search(mangled[2][length:])

    return named, wanted


def trim_header(source, target, named):
    """Leaves out the lines that declare functions which are not wanted."""
    lines = []
    for line in source.read_text(encoding="utf-8").splitlines(keepends=True):
        declared = re.match(r"[a-z]\w*[\w *]*\b__ovld\b[^(]*\b(\w+)\(.*;\s*$", line)
        if not declared or named(declared[1]) and not DECLARED.search(line):
            lines.append(line)
    target.unlink()
    target.write_text("".join(lines), encoding="utf-8")


def loaded_libraries(driver):
    """The paths of PoCL's library and of LLVM's, which it has loaded."""
    try:
        ctypes.CDLL(driver)
    except OSError as error:
        raise CannotTrim(str(error)) from error
    paths = {pathlib.Path(line.split()[-1]) for line in pathlib.Path("/proc/self/maps").read_text().splitlines() if "/" in line}
    pocl = [path for path in paths if path.name.startswith("libpocl.so")]
    llvm = [path for path in paths if re.match(r"libLLVM[-.]", path.name)]
    if len(pocl) != 1 or len(llvm) != 1:
        raise CannotTrim("PoCL does not share LLVM's library with other programs")
    return pocl[0], llvm[0]


def copy_pocl(pocl, llvm, folder, source_dir):
    """Copies PoCL, whose library is `pocl`, to `folder`. It finds its files from where its library lies.

    `llvm` is the library of the LLVM that it was made with. Returns where the driver now lies.
    """
    words = kernel_words(source_dir)
    installed = next((place / "share/pocl" for place in pocl.parents[1:3] if (place / "share/pocl").is_dir()), None)
    if installed is None:
        raise CannotTrim(f"{pocl} has no files beside it")
    driver = folder / pocl.parent.relative_to(installed.parents[1]) / pocl.name
    driver.parent.mkdir(parents=True)
    shutil.copy(pocl, driver)
    if (pocl.parent / "pocl").is_dir():  # its devices
        shutil.copytree(pocl.parent / "pocl", driver.parent / "pocl")
    files = folder / "share/pocl"
    shutil.copytree(installed / "include", files / "include")
    named, wanted = is_wanted(words)
    trim_header(installed / "include/opencl-c.h", files / "include/opencl-c.h", named)
    for library in sorted(installed.glob("kernel-*.bc")):
        if TRIMMED.fullmatch(library.name):
            Llvm(llvm).trim(library, files / library.name, wanted)
        else:
            (files / library.name).symlink_to(library)
    return driver


def installed_driver():
    """The name of PoCL's .icd file, and the library that it names."""
    for path in sorted(pathlib.Path("/etc/OpenCL/vendors").glob("*.icd")):
        library = path.read_text(encoding="utf-8").strip()
        if "libpocl" in library:
            return path.name, library
    raise CannotTrim("no PoCL in /etc/OpenCL/vendors")


def installed_pocl():
    """PoCL's library and LLVM's."""
    return loaded_libraries(installed_driver()[1])


def make(folder, program, source_dir):
    """Makes `folder`, and tries whether the program draws with it."""
    name, library = installed_driver()
    trial = folder / "trial"
    trial.mkdir(parents=True)
    (trial / name).write_text(f"{copy_pocl(*loaded_libraries(library), folder, source_dir)}\n", encoding="utf-8")
    environment = {**os.environ, "OCL_ICD_VENDORS": str(trial), "POCL_CACHE_DIR": str(trial),
                   "POCL_EXTRA_BUILD_FLAGS": "-cl-opt-disable"}
    done = subprocess.run([program, "render", source_dir / "tests/agree/scenes/tie.json", "--width", "8", "--spp", "1", "--quiet",
                           "-o", trial / "picture.pfm"], capture_output=True, text=True, env=environment, check=False, timeout=300)
    if done.returncode != 0:
        raise CannotTrim(done.stderr.strip())
    for path in trial.iterdir():
        if path.name != name:
            shutil.rmtree(path, ignore_errors=True)
            path.unlink(missing_ok=True)
    trial.rename(folder / "vendors")


def state(source_dir):
    """Names all that the copy depends on."""
    files = [*sorted(pathlib.Path("/etc/OpenCL/vendors").glob("*")), *sorted(pathlib.Path("/usr/share/pocl").glob("*"))]
    parts = [sorted(kernel_words(source_dir)), pathlib.Path(__file__).read_text(encoding="utf-8"),
             [(str(path), path.stat().st_size, path.stat().st_mtime_ns) for path in files]]
    return hashlib.sha256(json.dumps(parts).encode()).hexdigest()


def main():
    folder, program, source_dir = pathlib.Path(sys.argv[1]).resolve(), sys.argv[2], pathlib.Path(sys.argv[3]).resolve()
    if sys.argv[4:] == ["--now"]:
        make(folder, program, source_dir)
        return
    # What was made stays until something it depends on changes; what could not be made is not tried again until then.
    record, now = folder.with_suffix(".state"), state(source_dir)
    if record.exists() and record.read_text(encoding="utf-8") == now:
        return
    shutil.rmtree(folder, ignore_errors=True)
    # By a process of its own: other versions of PoCL and LLVM than those that were tried may end it.
    done = subprocess.run([sys.executable, "-B", __file__, *sys.argv[1:4], "--now"], capture_output=True, text=True, check=False)
    if done.returncode != 0:
        shutil.rmtree(folder, ignore_errors=True)
        reason = (done.stderr.strip().splitlines() or [f"exit code {done.returncode}"])[-1]
        print(f"trim_pocl: tests use PoCL as it is installed: {reason}")
    record.write_text(now, encoding="utf-8")


if __name__ == "__main__":
    main()
