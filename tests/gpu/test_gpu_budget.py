"""What the kernels that GPUs get take of a GPU, by compilers that need none: registers, private memory, spills, code.

Usage: test_gpu_budget.py GPU_KERNELS SCENE [--table]

GPU_KERNELS writes the kernels of the scene. They are compiled for

    NVIDIA  by clang 19 to PTX, and from there by ptxas, of the CUDA toolkit or PyPI's nvidia-cuda-nvcc
    AMD     by clang 19 to assembly
    Intel   by ocloc, Intel's own compiler; BALLPARK_OCLOC names it where it is not on the PATH
    SPIR-V  by clang and llvm-spirv of one version, and validated by spirv-val

clang takes OpenCL's functions from libclc. What is missing leaves out its part. Other versions of a compiler take a few
registers more or less, so clang is this one. --table prints the figures as a table for docs/GPU.md.
"""

import os
import pathlib
import re
import shutil
import struct
import subprocess
import sys
import tempfile

KERNELS, SCENE, TABLE = os.path.abspath(sys.argv[1]), os.path.abspath(sys.argv[2]), "--table" in sys.argv
FORMS = ("sample", "pool")
CLANG = "clang-19"
LIBCLC = ("/usr/lib/clc", "/usr/share/clc", "/usr/lib/llvm-19/share/clc")
COMMON = ["-x", "cl", "-cl-std=CL1.2", "-Xclang", "-finclude-default-header", "-cl-fp32-correctly-rounded-divide-sqrt"]
OPTIONS = "-cl-std=CL1.2 -cl-fp32-correctly-rounded-divide-sqrt"
# The most that a target may take, and for SIMD the least. A GPU hides the latency of memory by running other groups
# meanwhile, and has room for as many as their registers leave; private memory is memory. Code has room to grow by a fifth.
LIMITS = {
    "sm_86": {"registers": 96, "private": 128, "spills": 0, "code": 49152},
    "sm_90": {"registers": 96, "private": 128, "spills": 0, "code": 49152},
    "gfx90a": {"registers": 152, "private": 128, "spills": 0, "code": 20480},
    "gfx942": {"registers": 152, "private": 128, "spills": 0, "code": 20480},
    "gfx1030": {"registers": 128, "private": 128, "spills": 0, "code": 20480},
    "gfx1100": {"registers": 128, "private": 128, "spills": 0, "code": 20480},
    "dg2": {"registers": 128, "private": 128, "SIMD": 8},
    "dg2, 256 registers": {"registers": 256, "private": 0, "SIMD": 16},
}
NAMES = {"sm_86": "NVIDIA Ampere (RTX 30)", "sm_90": "NVIDIA Hopper (H100)", "gfx90a": "AMD CDNA 2 (MI200)",
         "gfx942": "AMD CDNA 3 (MI300)", "gfx1030": "AMD RDNA 2 (RX 6000)", "gfx1100": "AMD RDNA 3 (RX 7000)",
         "dg2": "Intel Arc", "dg2, 256 registers": "Intel Arc, 256 registers per thread"}


def run(*command, **options):
    done = subprocess.run([str(word) for word in command], capture_output=True, text=True, check=False, **options)
    assert done.returncode == 0, f"{' '.join(map(str, command))}\n{done.stdout}{done.stderr[-3000:]}"
    return done.stdout + done.stderr


class Missing(Exception):
    """What is not on this machine."""


def find(*names):
    for name in names:
        if name and shutil.which(name):
            return shutil.which(name)
    raise Missing(f"no {names[-1]} here")


def library(target):
    for folder in LIBCLC:
        if os.path.exists(f"{folder}/{target}.bc"):
            return f"{folder}/{target}.bc"
    raise Missing(f"no libclc for {target} here")


def compile_for(target, source, options):
    """Assembly, as text."""
    path = library(target[0])
    command = [find(CLANG), *COMMON, "-O3", "-target", target[1], *options, "-Xclang", "-mlink-builtin-bitcode", "-Xclang", path,
               "-Wno-linker-warnings", "-S"]
    # Bitcode of a later LLVM cannot be read. What fails for a kernel of one line is not the fault of the tracer's.
    small = source.with_name("small.cl")
    small.write_text("__kernel void small(__global float *x) { x[get_global_id(0)] = fma(x[0], x[1], sin(x[2])); }\n")
    tried = subprocess.run([*command, "-o", os.devnull, small], capture_output=True, text=True, check=False)
    if tried.returncode != 0:
        # Behind a quotation mark is a name that clang has freed already.
        reason = tried.stderr.strip().split(" '")[0].splitlines() or ["it says nothing"]
        raise Missing(f"{CLANG} cannot use {path}: {reason[0]}")
    out = source.with_suffix(".s")
    run(*command, "-o", out, source)
    return out.read_text()


def section_size(path, name):
    """Bytes of a section of an ELF file of 64 bits."""
    data = path.read_bytes()
    offset, = struct.unpack_from("<Q", data, 40)
    size, count, names = struct.unpack_from("<HHH", data, 58)
    headers = [struct.unpack_from("<IIQQQQ", data, offset + i * size) for i in range(count)]
    for header in headers:
        start = headers[names][4] + header[0]
        if data[start:data.index(b"\0", start)].decode() == name:
            return header[5]
    raise AssertionError(f"no section {name}")


def nvidia(source):
    options = [word for one in ("-target-cpu", "sm_86", "-target-feature", "+ptx71") for word in ("-Xclang", one)]
    ptx = compile_for(("nvptx64--nvidiacl", "nvptx64--nvidiacl"), source, options)
    trace = ptx[ptx.index(".entry trace("):].split("\n}\n")[0]
    found = {"doubles": len(re.findall(r"\.f64", trace)), "calls": len(re.findall(r"^\s*call", trace, re.M))}
    yield "PTX", found
    ptxas = find("ptxas")
    source.with_suffix(".ptx").write_text(ptx)
    for target in ("sm_86", "sm_90"):
        binary = source.with_suffix(".cubin")
        said = run(ptxas, "-v", f"-arch={target}", source.with_suffix(".ptx"), "-o", binary)
        own = said[said.index("entry function 'trace'"):]
        frame, stores, loads = map(int, re.search(r"(\d+) bytes stack frame, (\d+) bytes spill stores, (\d+) bytes spill loads",
                                                  own).groups())
        registers = int(re.search(r"Used (\d+) registers", own).group(1))
        resident = 65536 // (-(-registers // 8) * 8 * 32) // 4 * 4  # warps come in fours, and registers in eights
        yield target, {"registers": registers, "private": frame, "spills": stores + loads,
                       "code": section_size(binary, ".text.trace"), "resident": min(resident, 48 if target == "sm_86" else 64)}


def amd(source):
    for target in ("gfx90a", "gfx942", "gfx1030", "gfx1100"):
        text = compile_for(("amdgcn--amdhsa", "amdgcn-amd-amdhsa"), source, [f"-mcpu={target}", "-nogpulib"])
        own = text[text.index("\ntrace:"):]
        numbers = {name: int(re.search(rf"^; {name}: (\d+)", own, re.M).group(1))
                   for name in ("NumVgprs", "ScratchSize", "Occupancy")}
        described = text[text.index("amdhsa.kernels:"):]
        kernel = next(one for one in described.split("  - .a")[1:] if re.search(r"\.name: +trace\n", one))
        yield target, {"registers": numbers["NumVgprs"], "private": numbers["ScratchSize"],
                       "spills": int(re.search(r"\.vgpr_spill_count: +(\d+)", kernel).group(1)),
                       "code": int(re.search(r"codeLenInByte = (\d+)", own).group(1)), "resident": numbers["Occupancy"]}


def intel(source):
    ocloc = pathlib.Path(find(os.environ.get("BALLPARK_OCLOC"), "ocloc")).resolve()
    # It may lie in a folder of its own, with its libraries beside it.
    libraries = ":".join(str(path) for path in ocloc.parents[1].glob("lib/*-linux-gnu"))
    environment = {**os.environ, "LD_LIBRARY_PATH": libraries + ":" + os.environ.get("LD_LIBRARY_PATH", "")}
    for target, more in (("dg2", ""), ("dg2, 256 registers", " -cl-intel-256-GRF-per-thread")):
        folder = source.parent / "intel"
        run(ocloc, "compile", "-file", source, "-device", "dg2", "-options", OPTIONS + more, "-internal_options",
            "-cl-intel-allow-zebin", "-output", "kernel", "-output_no_suffix", "-out_dir", folder, env=environment)
        data = (folder / "kernel").read_bytes()
        described = data[data.index(b"kernels:"):].split(b"\0")[0].decode()
        kernel = next(one for one in described.split("- name:")[1:] if one.split()[0] == "trace")
        private = [int(size) for size in re.findall(r"usage: +(?:private_space|spill_fill_space|single_space)\n +size: +(\d+)",
                                                    kernel)]
        yield target, {"registers": int(re.search(r"grf_count: +(\d+)", kernel).group(1)), "private": sum(private),
                       "SIMD": int(re.search(r"simd_size: +(\d+)", kernel).group(1))}
        shutil.rmtree(folder)


def spirv(source):
    validator, reader = find("spirv-val"), find("spirv-dis")
    version = next((v for v in range(22, 13, -1) if shutil.which(f"llvm-spirv-{v}") and shutil.which(f"clang-{v}")), None)
    if version is None:
        raise Missing("no llvm-spirv and clang of one version here")
    # Not optimised: the translator does not know all that LLVM makes of a kernel.
    bitcode, module = source.with_suffix(".bc"), source.with_suffix(".spv")
    run(f"clang-{version}", *COMMON[:-1], "-target", "spir64-unknown-unknown", "-O0", "-Xclang", "-disable-O0-optnone", "-c",
        "-emit-llvm", "-o", bitcode, source)
    run(f"llvm-spirv-{version}", "--spirv-max-version=1.0", bitcode, "-o", module)
    run(validator, "--target-env", "opencl1.2", module)
    text = run(reader, module)
    trace = re.search(r'OpEntryPoint Kernel (%\w+) "trace"', text).group(1)
    contracts = f"OpExecutionMode {trace} ContractionOff" not in text
    yield "SPIR-V", {"doubles": len(re.findall(r"OpCapability Float64", text)), "contracts": int(contracts)}


def complaints(target, found):
    limits = LIMITS.get(target, {})
    for name, value in found.items():
        limit = limits.get(name, 0 if name in ("doubles", "calls", "contracts") else None)
        if limit is None:
            continue
        if value < limit if name == "SIMD" else value > limit:
            yield f"{target}: {name} {value}, limit {limit}"


def measure(source, missing):
    """{target: {what: how many}}"""
    found = {}
    for part in (nvidia, amd, intel, spirv):
        try:
            found.update(part(source))
        except Missing as reason:
            missing[part.__name__] = str(reason)
    return found


def print_table(measured):
    print("| GPU | target | form | registers | private memory, B | spills, B | code, KiB | groups resident | lanes |")
    print("| --- | --- | --- | ---: | ---: | ---: | ---: | ---: | ---: |")
    for target, name in NAMES.items():
        for form in FORMS:
            if target not in measured[form]:
                continue
            own = measured[form][target]
            code = f"{own['code'] / 1024:.1f}" if "code" in own else ""
            lanes = own.get("SIMD", 64 if target in ("gfx90a", "gfx942") else 32)
            print(f"| {name} | {target.split(',')[0]} | {form} | {own['registers']} | {own['private']} | {own.get('spills', '')} | "
                  f"{code} | {own.get('resident', '')} | {lanes} |")


# Breaks what each part looks for: an array that no register holds, doubles where there are any, contraction.
BAD = """#ifdef cl_khr_fp64
#pragma OPENCL EXTENSION cl_khr_fp64 : enable
typedef double number;
#else
typedef float number;
#endif
__kernel void trace(__global float *x, __global const uint *n) {
    number held[256];
    const size_t item = get_global_id(0) * 512;
    for (uint i = 0; i < 256; ++i) held[n[item + i] & 255] = (number)x[i] * x[i + 1] + x[i + 2];
    x[item] = (float)held[n[item + 256] & 255];
}
"""

with tempfile.TemporaryDirectory() as name:
    folder = pathlib.Path(name)
    run(KERNELS, SCENE, folder)
    missing = {}
    measured = {form: measure(folder / f"{form}.cl", missing) for form in FORMS}
    (folder / "bad.cl").write_text(BAD)
    bad = measure(folder / "bad.cl", {})

if TABLE:
    print_table(measured)
    sys.exit(0)
for part, reason in missing.items():
    print(f"skipped: {part}: {reason}")
wrong = []
for form, found in measured.items():
    for target, numbers in found.items():
        print(f"{form}, {target}: " + ", ".join(f"{name} {value}" for name, value in numbers.items()))
        wrong += [f"{form}, {complaint}" for complaint in complaints(target, numbers)]
for target in bad:
    assert list(complaints(target, bad[target])), f"{target}: nothing is wrong with a kernel that breaks the limits: {bad}"
print("\n".join(wrong))
sys.exit(1 if wrong else 0 if measured["pool"] else 77)
