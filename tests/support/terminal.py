"""The program on a pseudo-terminal, as a person runs it."""

import fcntl
import os
import pty
import re
import select
import struct
import subprocess
import termios
import time

from cli import LIMIT_SECONDS, PROGRAM


class Terminal:
    """The program with its standard error (and output, unless told) on a terminal of `columns`. `controls`: it is the
    terminal that the program finds as /dev/tty."""

    def __init__(self, test, *arguments, columns=80, stdout=None, environment=None, controls=False):
        try:
            self.master, slave = pty.openpty()
        except OSError as error:
            test.skipTest(f"this machine gives no pseudo-terminal ({error})")
        fcntl.ioctl(slave, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        values = {**test.environment, "TERM": "xterm", **(environment or {})}
        self.process = subprocess.Popen([PROGRAM, *arguments], cwd=test.folder, stdin=slave, stderr=slave,
                                        stdout=slave if stdout is None else stdout, env=values,
                                        start_new_session=True,
                                        preexec_fn=(lambda: fcntl.ioctl(0, termios.TIOCSCTTY, 0)) if controls else None)
        os.close(slave)
        self.seen = b""
        self.deadline = time.monotonic() + LIMIT_SECONDS
        test.addCleanup(self.close)

    def close(self):
        if self.process.poll() is None:
            self.process.kill()
            self.process.wait()
        os.close(self.master)

    def read_until(self, pattern=None):
        """Reads until `pattern` has been seen, or the program has ended."""
        while pattern is None or not re.search(pattern, self.seen):
            if time.monotonic() > self.deadline:
                raise AssertionError(f"waited too long for {pattern}: {self.seen[-500:]}")
            ready, _, _ = select.select([self.master], [], [], 0.1)
            if ready:
                try:
                    self.seen += os.read(self.master, 65536)
                except OSError:  # the other end is closed
                    break
            elif self.process.poll() is not None:
                break
        return self.seen

    def finish(self):
        self.read_until()
        return self.process.wait(timeout=LIMIT_SECONDS)

    def resize(self, columns):
        """Changes the width and reads on until a drawing has been seen that was begun afterwards; forgets all before."""
        fcntl.ioctl(self.master, termios.TIOCSWINSZ, struct.pack("HHHH", 24, columns, 0, 0))
        # The terminal echoes what is typed: what stands before the mark may have been drawn any time ago. The drawing
        # after it may have been under way; the next one was not, for there is one at a time.
        self.seen = b""
        os.write(self.master, b"~")
        self.read_until(rb"~[^\x1b]*\x1b\[K[^\x1b]*\x1b\[K")
        self.seen = re.sub(rb"(?s)^.*~[^\x1b]*\x1b\[K", b"", self.seen)

    def drawings(self):
        """The texts of the status line, one after the other."""
        return [text.decode() for text in re.findall(rb"\r([^\r\n\x1b]*)\x1b\[K", self.seen)]
