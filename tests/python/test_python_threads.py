"""Threads: renders as the first calls of a process, the library opened once, and one render that several threads use.

Usage: test_python_threads.py SOURCE_DIR BUILD_DIR
"""

import concurrent.futures
import os
import pathlib
import subprocess
import sys
import threading
import time

import package

source, build = map(pathlib.Path, sys.argv[1:3])
ballpark, np = package.load(source, build)
POSITIONS = np.random.default_rng(3).random((50, 3))

# All threads begin together, before anything has used the library.
FIRST = """
import concurrent.futures, threading
import numpy as np, ballpark
positions = np.random.default_rng(3).random((50, 3))
together = threading.Barrier(4)
def draw(number):
    together.wait()
    return ballpark.render(positions, radius=0.1, width=32, spp=1, seed=number % 2).radiance.copy()
with concurrent.futures.ThreadPoolExecutor(4) as pool:
    pictures = list(pool.map(draw, range(4)))
for number, picture in enumerate(pictures):
    assert np.array_equal(picture, ballpark.render(positions, radius=0.1, width=32, spp=1, seed=number % 2).radiance)
"""


def test_first_calls():
    for attempt in range(6):
        done = subprocess.run([sys.executable, "-X", "faulthandler", "-c", FIRST], timeout=300, capture_output=True, text=True,
                              check=False, env=dict(os.environ, PYTHONPATH=str(source / "python")))
        assert done.returncode == 0, (attempt, done.returncode, done.stderr)


def test_opened_once():
    lib = ballpark._library
    opens, open_it, lib._loaded = [], lib._open, None

    def slow():
        opens.append(threading.current_thread())
        time.sleep(0.2)
        return open_it()

    lib._open = slow
    try:
        with concurrent.futures.ThreadPoolExecutor(8) as pool:
            got = list(pool.map(lambda _: lib.library(), range(8)))
    finally:
        lib._open = open_it
    assert len(opens) == 1 and len(set(map(id, got))) == 1, (opens, got)


def test_one_scene_for_many():
    """Handles that are only read may be shared: the pictures are those of a thread alone."""
    scene = ballpark.make_scene(POSITIONS, radius=0.1, width=32)
    expected = [ballpark.render(scene, spp=2, seed=seed).radiance for seed in range(4)]
    with concurrent.futures.ThreadPoolExecutor(4) as pool:
        pictures = list(pool.map(lambda seed: ballpark.render(scene, spp=2, seed=seed).radiance, range(4)))
    assert all(map(np.array_equal, pictures, expected))


def test_closed_by_another():
    """The step under way ends; whatever comes after it says that the render is closed."""
    scene = ballpark.make_scene(POSITIONS, radius=0.1, width=64)
    for attempt in range(6):
        running, problems, began = ballpark.Render(scene, spp=2**26), [], threading.Event()

        def go_on():
            try:
                while True:
                    began.set()
                    running.step()
                    running.progress()
                    running.picture()
            except ballpark.Error as problem:
                problems.append(str(problem))

        thread = threading.Thread(target=go_on)
        thread.start()
        began.wait()
        time.sleep(0.05 * attempt)
        running.close()
        thread.join(60)
        assert not thread.is_alive() and problems == ["the render is closed"], problems
        running.close()
        assert not running._render and not running._stop  # nothing is left
        for call in (running.step, running.picture, running.progress):
            package.refused(ballpark.Error, "closed", call)


def test_two_at_a_time():
    """A second thread is refused while the first one's step is under way, and harms nothing."""
    scene = ballpark.make_scene(POSITIONS, radius=0.1, width=64)
    with ballpark.Render(scene, spp=2**26) as running:
        refusals, stop = [], threading.Event()

        def disturb():
            while not stop.is_set():
                for call in (running.picture, running.progress, running.step):
                    try:
                        call()
                    except ballpark.Error as problem:
                        refusals.append(str(problem))

        threads = [threading.Thread(target=disturb) for _ in range(3)]
        for thread in threads:
            thread.start()
        time.sleep(1)
        stop.set()
        for thread in threads:
            thread.join(60)
        assert refusals and all("under way" in text for text in refusals), set(refusals)
        running.step()
        assert np.isfinite(running.picture().radiance).all()


for function in (test_opened_once, test_one_scene_for_many, test_closed_by_another, test_two_at_a_time, test_first_calls):
    print(function.__name__, flush=True)
    function()
print("ok")
