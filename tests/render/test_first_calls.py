"""Several threads as the first thing that a process does with the library: each gets what it would get alone.

usage: test_first_calls.py PROGRAM SOURCE_DIR LIBRARY FIRST_CALLS COMPILER [--deep] [unittest's arguments]

FIRST_CALLS is built from first_calls.c. The deep part has a hundred runs of each kind, and one with ThreadSanitizer.
"""

import gzip
import os
import subprocess
import sys

import cli

LIBRARY, FIRST_CALLS, COMPILER = sys.argv[3:6]
del sys.argv[3:6]
PARTICLES = 500

PYTHON = """
import concurrent.futures, sys
import numpy as np, ballpark
positions = np.random.default_rng(1).random((20, 3))
def work(i):
    if i % 4 == 3:
        return len(ballpark.devices()) > 0
    return ballpark.render(positions, radius=0.1, width=16, spp=2).radiance.tobytes()
with concurrent.futures.ThreadPoolExecutor(int(sys.argv[1])) as pool:
    found = list(pool.map(work, range(int(sys.argv[1]))))
pictures = {f for f in found if isinstance(f, bytes)}
assert len(pictures) == 1 and all(f is True for f in found if not isinstance(f, bytes)), found
"""


class FirstCalls(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        lines = [f"{PARTICLES}", ""] + [f"C {i * 0.37:.3f} {i % 7}.5 {i % 11}.25" for i in range(PARTICLES)]
        self.write("p.xyz.gz", gzip.compress("\n".join(lines + [""]).encode()))

    def call(self, threads, *kinds, program=FIRST_CALLS, **variables):
        result = subprocess.run([program, str(threads), self.path("p.xyz.gz"), str(PARTICLES), *kinds], cwd=self.folder,
                                stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, timeout=cli.LIMIT_SECONDS,
                                env=dict(self.environment, **variables))
        self.assertEqual(result.returncode, 0, f"{threads} threads, {kinds}: {result.stdout}")
        self.assertEqual(result.stdout.count(": done\n"), threads, result.stdout)
        return result.stdout

    def call_often(self, times):
        for i in range(times):
            self.call(3 + i % 6, "render")
            self.call(3 + i % 6, "list", "render", "load", "find")

    def test_c(self):
        self.call_often(10)

    def test_folders_of_caches_that_are_not_there_yet(self):
        for i in range(2):
            self.call(4, "render", "load", XDG_CACHE_HOME=self.path(f"cache{i}"), POCL_CACHE_DIR=self.path(f"pocl{i}"),
                      BALLPARK_KERNEL_CACHE="on")
        self.assertTrue(os.listdir(self.path("cache0/ballpark/kernels")))

    @cli.deep
    def test_c_a_hundred_times(self):
        self.call_often(100)

    def call_python(self, times):
        if subprocess.run([sys.executable, "-c", "import numpy"], stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("no numpy for this Python")
        if LIBRARY == "none":
            self.skipTest("Python cannot load the library with sanitizers")
        for i in range(times):
            result = subprocess.run([sys.executable, "-B", "-c", PYTHON, str(3 + i % 6)], cwd=self.folder, text=True,
                                    stdout=subprocess.PIPE, stderr=subprocess.STDOUT, timeout=cli.LIMIT_SECONDS,
                                    env=dict(self.environment, PYTHONPATH=os.path.join(cli.SOURCE, "python"),
                                             BALLPARK_LIBRARY=LIBRARY))
            self.assertEqual(result.returncode, 0, f"run {i}: {result.stdout}")

    def test_python(self):
        self.call_python(6)

    @cli.deep
    def test_python_a_hundred_times(self):
        self.call_python(100)

    @cli.deep
    def test_thread_sanitizer(self):
        """Of our own code alone: drivers, which are not compiled with it, are left out."""
        build = self.path("build")
        words = ["-fsanitize=thread", "-g", "-O1"]
        self.write("t.c", "int main(void) { return 0; }\n")
        tried = subprocess.run([COMPILER, *words, "t.c", "-o", "t"], cwd=self.folder, stderr=subprocess.DEVNULL)
        if tried.returncode != 0 or subprocess.run([self.path("t")], stderr=subprocess.DEVNULL).returncode != 0:
            self.skipTest("the compiler has no ThreadSanitizer that runs here")
        for command in (["cmake", "-S", cli.SOURCE, "-B", build, "-G", "Ninja", f"-DCMAKE_C_COMPILER={COMPILER}",
                         "-DCMAKE_C_FLAGS=" + " ".join(words), "-DBALLPARK_TESTS=OFF", "-DBALLPARK_BENCH=OFF",
                         "-DBALLPARK_MPI=OFF", *[f"-DCMAKE_C_COMPILER_LAUNCHER={os.environ[v]}" for v in
                                                 ["CMAKE_C_COMPILER_LAUNCHER"] if v in os.environ]],
                        ["cmake", "--build", build, "--target", "ballpark_shared"],
                        [COMPILER, *words, os.path.join(cli.SOURCE, "tests/render/first_calls.c"), "-I",
                         os.path.join(cli.SOURCE, "host"), "-L", build, "-lballpark", f"-Wl,-rpath,{build}", "-pthread", "-o",
                         self.path("first_calls")]):
            done = subprocess.run(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True, cwd=self.folder)
            self.assertEqual(done.returncode, 0, done.stdout)
        self.write("tsan.supp", "".join(f"{kind}:{library}\n" for kind in ("race", "mutex", "deadlock", "thread")
                                        for library in ("libpocl", "libLLVM", "libMesaOpenCL", "libRusticlOpenCL", "libOpenCL")))
        for threads in (3, 8):
            said = self.call(threads, "list", "render", "load", "find", program=self.path("first_calls"),
                             TSAN_OPTIONS=f"suppressions={self.path('tsan.supp')} ignore_noninstrumented_modules=1 exitcode=66")
            self.assertNotIn("WARNING: ThreadSanitizer", said)


if __name__ == "__main__":
    cli.main()
