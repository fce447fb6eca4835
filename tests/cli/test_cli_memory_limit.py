"""Under a limit on memory (ulimit -v) the program says that memory is what it lacks, also where the driver ends the process.

Where the C library itself finds no room for a thread's own data, it ends the process at once, with its own sentence about
memory and exit code 127: no handler sees that, so its word has to do.

Run as: python3 test_cli_memory_limit.py PROGRAM SOURCE_DIR [unittest's arguments]"""

import subprocess
import unittest

import cli


class MemoryLimit(cli.ProgramTest):
    def run_within(self, mebibytes, *arguments):
        """With a kernel cache of its own, so that the driver compiles."""
        environment = {**self.environment, "POCL_CACHE_DIR": self.path(f"cache-{mebibytes}")}
        command = ["sh", "-c", f"ulimit -c 0; ulimit -v {mebibytes * 1024}; exec \"$@\"", "sh", cli.PROGRAM, *arguments]
        result = subprocess.run(command, cwd=self.folder, env=environment, capture_output=True, timeout=cli.LIMIT_SECONDS, check=False)
        result.errors = result.stderr.decode(errors="replace")
        return result

    def test_the_program_says_so(self):
        self.write("s.json", cli.scene())
        given_up = 0
        for mebibytes in range(200, 900, 50):
            result = self.run_within(mebibytes, "render", "s.json", "-o", "p.pfm")
            if result.returncode == 0:
                break
            if result.returncode == 127:
                self.assertIn("cannot allocate memory for thread-local data", result.errors, f"{mebibytes} MiB")
                continue
            self.assertEqual(result.returncode, 1, f"{mebibytes} MiB: {result.errors}")
            self.assertRegex(result.errors, r"(?m)^ballpark: .*memory", f"{mebibytes} MiB")
            given_up += "was refused memory and gave up" in result.errors
        self.assertEqual([name for name in self.files() if not name.startswith("cache-")], ["p.pfm", "s.json"])
        if given_up == 0:
            raise unittest.SkipTest("this driver does not end the process when it lacks memory")

    def test_a_check_says_so(self):
        self.write("s.json", cli.scene())
        for mebibytes in (250, 450):
            result = self.run_within(mebibytes, "check", "s.json", "--spp", "16")
            self.assertIn(result.returncode, (0, 4, 5, 6), result.errors)
            if result.returncode in (5, 6):
                self.assertRegex(result.errors + result.stdout.decode(), "memory", f"{mebibytes} MiB")


if __name__ == "__main__":
    cli.main()
