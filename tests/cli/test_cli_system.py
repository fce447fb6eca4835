"""What the system lacks is said, with the remedy: a linker for PoCL, a folder for its kernels."""

import os
import shutil
import signal
import subprocess
import sys
import time

import cli


class System(cli.ProgramTest):
    def setUp(self):
        super().setUp()
        listed = self.run_program("devices")
        if b"Portable Computing Language" not in listed.stdout:
            self.skipTest("PoCL is not installed")
        self.write("x.json", cli.scene(width=4))
        os.mkdir(self.path("bin"))  # no programs

    def test_no_linker(self):
        for number, path in enumerate((self.path("bin"), "")):
            here = {"PATH": path, "POCL_CACHE_DIR": self.path(f"cache-{number}")}
            for command in (("render", "x.json", "--device", "portable"), ("check", "x.json", "--device", "portable")):
                result = self.run_program(*command, environment=here)
                if result.returncode == 0:
                    self.skipTest("this PoCL needs no linker")
                self.assertEqual(result.returncode, 6 if command[0] == "check" else 1, f"{command}: {result.errors}")
                self.assertIn("`ld`", result.errors, command)
                self.assertIn("install binutils", result.errors)
                self.assertNotIn("x.png", self.files())
        result = self.run_program("check", "x.json", "--device", "all", environment=here)
        self.assertEqual(result.returncode, 6)
        self.assertIn("install binutils", result.stdout.decode() + result.errors)

    def test_control_c_spares_the_linker(self):
        """The key reaches every process of the terminal; a linker that dies of it would take PoCL and us along."""
        real = shutil.which("ld")
        if real is None:
            self.skipTest("there is no linker")
        self.write("bin/ld", f"#!{sys.executable}\n"
                             "import os, sys, time\n"
                             f"open({self.path('began')!r}, 'w').close()\n"
                             f"while not os.path.exists({self.path('may-end')!r}):\n"
                             "    time.sleep(0.01)\n"
                             f"os.execv({real!r}, ['ld', *sys.argv[1:]])\n")
        os.chmod(self.path("bin/ld"), 0o755)
        here = dict(self.environment, PATH=self.path("bin") + ":" + os.environ["PATH"], POCL_CACHE_DIR=self.path("cache"))
        process = subprocess.Popen([cli.PROGRAM, "check", "x.json", "--device", "portable", "--quiet"], cwd=self.folder,
                                   env=here, stderr=subprocess.PIPE, start_new_session=True)
        while process.poll() is None and "began" not in self.files():
            time.sleep(0.01)
        if "began" not in self.files():
            process.communicate()
            self.skipTest("this PoCL needs no linker")
        os.killpg(process.pid, signal.SIGINT)
        self.write("may-end", "")
        said = process.communicate(timeout=cli.LIMIT_SECONDS)[1].decode()
        self.assertEqual(process.returncode, 130, said)
        self.assertIn("interrupted before a verdict was reached", said)

    def test_cache_that_cannot_be_written(self):
        self.write("file", "")
        for folder, what in (("/proc/no-such-folder", "No such file or directory"),
                             (self.path("file"), "Not a directory")):
            result = self.run_program("render", "x.json", "--device", "portable", environment={"POCL_CACHE_DIR": folder})
            self.assertEqual(result.returncode, 1, result.errors)
            for text in ("PoCL cannot write", folder, what, "POCL_CACHE_DIR"):
                self.assertIn(text, result.errors)
            self.assertNotIn("apt install", result.errors)

    @cli.deep
    def test_cache_that_eight_share(self):
        """All compile at once into a cache that is empty."""
        cache = {"POCL_CACHE_DIR": self.path("cache"), "MESA_SHADER_CACHE_DIR": self.path("cache")}
        started = [subprocess.Popen([cli.PROGRAM, "render", "x.json", "-o", f"{number}.pfm", "--threads", "1", "-q"], cwd=self.folder,
                                    env={**self.environment, **cache}, stderr=subprocess.PIPE) for number in range(8)]
        for process in started:
            said = process.communicate(timeout=cli.LIMIT_SECONDS)[1]
            self.assertEqual(process.returncode, 0, said)
        self.succeed("render", "x.json", "-o", "alone.pfm", "-q", environment=cache)
        for number in range(8):
            self.assert_same(self.read(f"{number}.pfm"), self.read("alone.pfm"), number)

    def test_cache_that_can_be_made(self):
        cache = self.path("a/b/c")
        self.succeed("render", "x.json", "--device", "portable", "--quiet", environment={"POCL_CACHE_DIR": cache})


if __name__ == "__main__":
    cli.main()
