"""Forked processes: one that was forked before anything used OpenCL renders; one that was forked later gets an error that says
what to do, whatever made it, and ends. None of them waits for ever.

Usage: test_python_fork.py SOURCE_DIR BUILD_DIR
"""

import concurrent.futures
import gc
import multiprocessing
import os
import pathlib
import signal
import subprocess
import sys
import tempfile
import threading
import time
import warnings

import package

source, build = map(pathlib.Path, sys.argv[1:3])
ballpark, np = package.load(source, build)
if not hasattr(os, "fork"):
    package.skip("no fork on this system")
warnings.simplefilter("ignore", DeprecationWarning)  # of Python 3.12 and later, about forks of programs with threads
SECONDS = 120
signal.alarm(8 * SECONDS)  # ends the test where a worker never answers
POSITIONS = np.array([[0.0, 0, 0], [1, 0, 0]])


def draw(number=0):
    """The mean brightness, or the error's text."""
    try:
        return float(ballpark.render(POSITIONS, radius=0.2, width=32, height=24, spp=1, seed=number).radiance.mean())
    except ballpark.Error as error:
        return f"{type(error).__name__}: {error}"


def told(answer):
    return isinstance(answer, str) and answer.startswith("DeviceError") and "forked" in answer and '"spawn"' in answer


def child(function, leave=os._exit):
    """The exit code of a forked process: 0 where `function` returns True."""
    sys.stdout.flush()
    process = os.fork()
    if process == 0:
        signal.alarm(SECONDS)
        code = 1
        try:
            code = 0 if function() else 2
        except BaseException as problem:
            print("in the child:", repr(problem), flush=True)
        leave(code)
    _, status = os.waitpid(process, 0)
    assert os.WIFEXITED(status), f"ended by signal {os.WTERMSIG(status)}"
    return os.WEXITSTATUS(status)


def test_before():
    """Nothing has used OpenCL so far, though the library is there, and a thread is just opening it."""
    assert ballpark._library._loaded is None
    with ballpark._library._loading:  # as a thread that is opening the library holds it
        assert child(lambda: draw() == draw() > 0) == 0
    assert ballpark.library_version()
    assert child(lambda: draw() > 0, sys.exit) == 0
    with multiprocessing.get_context("fork").Pool(2) as pool:
        answers = pool.map(draw, range(4))
    assert answers == [draw(number) for number in range(4)] and all(answer > 0 for answer in answers), answers


def test_after():
    assert draw() > 0
    assert child(lambda: told(draw())) == 0
    assert child(lambda: told(draw()), sys.exit) == 0
    package.refused(ballpark.DeviceError, ["forked", '"spawn"'], child_error)
    for make in (lambda: multiprocessing.get_context("fork").Pool(2),
                 lambda: concurrent.futures.ProcessPoolExecutor(2, mp_context=multiprocessing.get_context("fork"))):
        with make() as pool:
            answers = list(pool.map(draw, range(4)))
        assert len(answers) == 4 and all(map(told, answers)), answers
    assert draw() > 0  # the parent goes on


def child_error():
    """The error reaches the parent as it is, with pickle's help."""
    context = multiprocessing.get_context("fork")
    with context.Pool(1) as pool:
        pool.apply(ballpark.devices)


def test_inherited():
    """A render, its pictures, and a step under way in a thread: what can be used is used, and nothing waits."""
    picture = ballpark.render(POSITIONS, radius=0.2, width=32, spp=2)
    scene = ballpark.make_scene(POSITIONS, radius=0.2, width=64)
    running = ballpark.Render(scene, spp=2**26)
    running.step()

    def inherits():
        for call in (running.step, running.picture, running.progress, ballpark.devices, lambda: ballpark.Render(scene)):
            package.refused(ballpark.DeviceError, ["forked", '"spawn"'], call)
        running.close()
        again = ballpark.Scene({"camera": {"image_width": 10}})
        return again.width == 10 and picture.radiance.mean() > 0 and picture.encode("png").startswith(b"\x89PNG")

    def drops():
        nonlocal picture, scene, running
        picture = scene = running = None
        gc.collect()
        return True

    assert child(inherits) == 0 and child(inherits, sys.exit) == 0 and child(drops, sys.exit) == 0
    stop = threading.Event()

    def steps():
        while not stop.is_set():
            running.step()

    thread = threading.Thread(target=steps)
    thread.start()
    try:
        for leave in (os._exit, sys.exit) * 3:
            time.sleep(0.03)
            assert child(inherits, leave) == 0
    finally:
        stop.set()
        thread.join()
    running.step()
    assert running.picture().samples.max() > 0
    running.close()


SPAWNED = """
import concurrent.futures, multiprocessing
import numpy as np, ballpark
def draw(number):
    return float(ballpark.render(np.array([[0.0, 0, 0]]), radius=0.2, width=32, spp=1, seed=number).radiance.mean())
if __name__ == "__main__":
    own = [draw(number) for number in range(3)]
    for method in ("spawn", "forkserver"):
        with multiprocessing.get_context(method).Pool(2) as pool:
            assert pool.map(draw, range(3)) == own, method
    try:
        import joblib
    except ImportError:
        print("skipped: not installed: joblib")
    else:
        assert joblib.Parallel(2, timeout=100)(joblib.delayed(draw)(number) for number in range(3)) == own
    print("ok")
"""


def test_remedy():
    """What the message advises works."""
    with tempfile.TemporaryDirectory() as folder:
        program = pathlib.Path(folder, "program.py")
        program.write_text(SPAWNED)
        done = subprocess.run([sys.executable, program], timeout=3 * SECONDS, capture_output=True, text=True, check=False,
                              env=dict(os.environ, PYTHONPATH=str(source / "python")))
    assert done.returncode == 0 and done.stdout.endswith("ok\n"), (done.stdout, done.stderr)
    print(done.stdout.replace("ok\n", ""), end="")


for function in (test_before, test_after, test_inherited, test_remedy):
    print(function.__name__, flush=True)
    function()
print("ok")
