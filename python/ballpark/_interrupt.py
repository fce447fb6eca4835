"""Ctrl-C while the library works.

In:    calls into the library, the signal.   Out: their results, or KeyboardInterrupt soon after the signal.
Knows: signals, threads.   Does not know: what is called.
"""

import signal
import threading
import time
import types
import typing

T = typing.TypeVar("T")


class CtrlC:
    """While entered, Ctrl-C is noted and does not raise, so that it never comes between two steps of the bookkeeping; it
    raises at the end, unless something else is raised.

    Only where it would raise otherwise: in the main thread, and where nobody has installed a handler of his own.
    """

    def __init__(self) -> None:
        self.pressed_at: typing.Optional[float] = None
        self.presses = 0
        self._ours = False

    def _note(self, number: int, frame: typing.Optional[types.FrameType]) -> None:
        self.presses += 1
        if self.pressed_at is None:
            self.pressed_at = time.monotonic()

    def __enter__(self) -> "CtrlC":
        self._ours = (threading.current_thread() is threading.main_thread()
                      and signal.getsignal(signal.SIGINT) is signal.default_int_handler)
        if self._ours:
            signal.signal(signal.SIGINT, self._note)
        return self

    def __exit__(self, kind: typing.Optional[typing.Type[BaseException]], *_: object) -> None:
        if self._ours:
            signal.signal(signal.SIGINT, signal.default_int_handler)
        if kind is None and self.pressed_at is not None:
            raise KeyboardInterrupt  # also when it came after the last look, and would be lost


POLL_SECONDS = 0.1


class Job:
    """A call into the library, which Python cannot interrupt: it runs in a thread of its own, and can be left alone.

    daemon: the end of Python does not wait for it.
    """

    def __init__(self, function: typing.Callable[[], typing.Any], daemon: bool = False):
        self.function = function
        self.result: typing.Any = None
        self.problem: typing.Optional[BaseException] = None
        self.done = threading.Event()
        self._thread = threading.Thread(target=self._run, name="ballpark", daemon=daemon)
        self._thread.start()

    def _run(self) -> None:
        try:
            self.result = self.function()
        except BaseException as problem:  # raised again where it is waited for
            self.problem = problem
        self.done.set()

    def wait(self, ctrl_c: CtrlC, patience: float) -> bool:
        """Until it is done; False: Ctrl-C was pressed, and it is not done within `patience` seconds of that, or when it is
        pressed again."""
        while not self.done.wait(POLL_SECONDS):
            waited = time.monotonic() - ctrl_c.pressed_at if ctrl_c.pressed_at is not None else 0
            if waited > patience or ctrl_c.presses > 1:
                return False
        self._thread.join()
        if self.problem is not None:
            raise self.problem
        return True


def interruptible(function: typing.Callable[[], T], patience: float = 0, daemon: bool = False) -> T:
    """Calls it. Ctrl-C raises KeyboardInterrupt within `patience` seconds, and leaves the call to its end (Job)."""
    with CtrlC() as ctrl_c:
        job = Job(function, daemon)
        if not job.wait(ctrl_c, patience):
            raise KeyboardInterrupt
    result: T = job.result
    return result
