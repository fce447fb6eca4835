"""A program that answers many requests (requests.h), and tests that ask one."""
import os
import resource
import select
import subprocess
import sys
import tempfile

from in_folder import FolderTest

PROGRAM = os.path.abspath(sys.argv[1])
LIMIT_SECONDS = 120  # only so that a hang is a failure
MEMORY = 1 << 29  # bytes that a hostile file may make the program ask for, which sanitizers cannot be held to
SANITIZED = "asan" in PROGRAM


def limit_memory():
    if not SANITIZED:
        resource.setrlimit(resource.RLIMIT_AS, (MEMORY, MEMORY))


class AnswersTest(FolderTest):
    """All tests of a class ask one process, which is started for the first and must end well after the last. What it finds at
    its end, such as leaks, belongs to one of them."""

    process = None

    @classmethod
    def tearDownClass(cls):
        if cls.process:
            cls.process.stdin.close()
            code = cls.process.wait(LIMIT_SECONDS)
            cls.process.stdout.close()
            cls.process = None
            if code != 0:
                raise AssertionError(f"{PROGRAM} ended with {code}: {cls.messages()}")

    @classmethod
    def messages(cls):
        cls.errors.seek(0)
        return cls.errors.read()[-4000:]

    @classmethod
    def answer(cls, *arguments):
        """What `PROGRAM ARGUMENT...` would have said and ended with, as subprocess.run returns it."""
        if cls.process is None:
            cls.errors = tempfile.TemporaryFile("w+", errors="replace")
            cls.addClassCleanup(cls.errors.close)
            cls.process = subprocess.Popen([PROGRAM, "-"], stdin=subprocess.PIPE, stdout=subprocess.PIPE, stderr=cls.errors,
                                           preexec_fn=limit_memory, bufsize=0)
        cls.process.stdin.write("\t".join(map(str, arguments)).encode() + b"\n")
        said = b""
        while not said.endswith(b"\n") or not said[said.rfind(b"\n", 0, -1) + 1:].startswith(b"= "):
            part = b""
            if select.select([cls.process.stdout], [], [], LIMIT_SECONDS)[0]:
                part = os.read(cls.process.stdout.fileno(), 1 << 20)
            if not part:  # it crashed, or hangs
                cls.process.kill()
                code = cls.process.wait()
                cls.process.stdin.close()
                cls.process.stdout.close()
                cls.process = None
                return subprocess.CompletedProcess(arguments, code, said.decode(errors="replace"), cls.messages())
            said += part
        text, _, code = said.decode().rstrip("\n").rpartition("= ")
        shown, message = (text, "") if code == "0" else ("", text)
        return subprocess.CompletedProcess(arguments, int(code), shown, message)
