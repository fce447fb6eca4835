"""Objects at their end: closed, pickled, in a function that raises, in a cycle, at the end of the program.

Usage: test_python_lifetime.py SOURCE_DIR BUILD_DIR
"""

import copy
import gc
import os
import pathlib
import pickle
import subprocess
import sys
import threading

import package

source, build = map(pathlib.Path, sys.argv[1:3])
ballpark, np = package.load(source, build)
POSITIONS = np.random.default_rng(3).random((50, 3))
scene = ballpark.make_scene(POSITIONS, radius=0.1, width=32)


def test_closed():
    with ballpark.Render(scene, spp=1) as running:
        pass
    for call in (running.step, running.picture, running.progress):
        package.refused(ballpark.Error, "closed", call)
    running.close()
    assert running.stopped is None


def test_pickled():
    picture, running = ballpark.render(scene, spp=1), ballpark.Render(scene, spp=1)
    for thing, words in ((picture, ["picture", "radiance"]), (scene, ["scene", "made of"]), (running, "process")):
        for function in (pickle.dumps, copy.deepcopy):
            package.refused(TypeError, words, function, thing)
    assert np.array_equal(pickle.loads(pickle.dumps(picture.radiance)), picture.radiance)
    spheres = pickle.loads(pickle.dumps(ballpark.Spheres(POSITIONS, radius=0.1)))
    assert np.array_equal(ballpark.render(spheres, width=32, spp=1).radiance, picture.radiance)
    for error in (ballpark.SceneError("text", "bad scene", "file", 1, 2, "log"), ballpark.Interrupted(None)):
        again = pickle.loads(pickle.dumps(error))
        assert type(again) is type(error) and str(again) == str(error) and vars(again) == vars(error)


class Stop(Exception):
    pass


def names_of_threads():
    return [thread.name for thread in threading.enumerate() if thread.name == "ballpark"]


def test_exception_in_progress():
    """It arrives as it is, the render is over, and no thread is left."""
    for problem in (Stop("why"), SystemExit(3), GeneratorExit(), MemoryError()):
        seen = []

        def report(now):
            seen.append(now)
            raise problem

        caught = package.refused(type(problem), str(problem), ballpark.render, scene, spp=2**26, progress=report)
        assert caught is problem and len(seen) == 1 and names_of_threads() == []
    stop = package.refused(KeyboardInterrupt, "interrupted", ballpark.render, scene, spp=2**26, progress=press_ctrl_c)
    assert isinstance(stop, ballpark.Interrupted) and stop.picture.samples.max() > 0 and names_of_threads() == []
    # A render in a report, which is interrupted, hands over its own picture.
    inner = package.refused(KeyboardInterrupt, "interrupted", ballpark.render, scene, spp=2**26, progress=lambda now: ballpark.render(
        POSITIONS, radius=0.1, width=16, spp=2**26, progress=press_ctrl_c))
    assert inner.picture.width == 16 and names_of_threads() == []
    assert ballpark.render(scene, spp=1).stopped == "samples"


def press_ctrl_c(*_arguments, **_options):
    raise KeyboardInterrupt


def test_interrupted_before_the_first_step():
    """While the scene is read, or the kernel is built: there is no picture yet."""
    for place in (ballpark._scene, ballpark._render):
        kept, place.interruptible = place.interruptible, press_ctrl_c
        try:
            stop = package.refused(ballpark.Interrupted, "interrupted", ballpark.render, POSITIONS, width=16, spp=1)
        finally:
            place.interruptible = kept
        assert stop.picture is None


def test_memory_error_has_its_text():
    """Of a failure that is made up: the text is read before it is cleared."""
    lib = ballpark._library

    class Failing:
        def __getattr__(self, name):
            return getattr(kept, name) if name != "bp_scene_load" else self.fail

        @staticmethod
        def fail(*arguments):
            error = arguments[-1]._obj
            error.code, error.message = 2, b"out of memory for 3 spheres"
            return 2

    kept, lib._loaded = lib._loaded, Failing()
    try:
        package.refused(MemoryError, "out of memory for 3 spheres", ballpark.Scene.load, "any.json")
    finally:
        lib._loaded = kept


def test_texts_with_a_zero_byte():
    """They would be cut there."""
    picture = ballpark.render(scene, spp=1)
    package.refused(ValueError, ["path", "zero byte"], ballpark.render, "scene.json\0.xyz")
    package.refused(ValueError, ["device", "zero byte"], ballpark.Render, scene, device="\0")
    package.refused(ValueError, ["path", "zero byte"], picture.save, "a\0b.png")
    package.refused(TypeError, ["name", "int"], ballpark.render, ballpark.Spheres(POSITIONS, name=3))


# Everything at once: globals, cycles, arrays without their picture, a render and a step of it that nobody waits for.
ENDS = """
import gc, sys, threading
import numpy as np, ballpark
gc.disable()
scene = ballpark.make_scene(np.random.default_rng(3).random((50, 3)), radius=0.1, width=32)
picture = ballpark.render(scene, spp=1, aovs=True)
depth = ballpark.render(scene, spp=1, aovs=True).depth
running = ballpark.Render(scene, spp=2**26)
running.step()
class Node: pass
for _ in range(20):
    node = Node()
    node.render, node.scene = ballpark.Render(scene, spp=1), ballpark.make_scene(np.zeros((1, 3)))
    node.render.step()
    node.picture, node.render.me = node.render.picture(), node
    node.again, node.scene.me = node, node
    if sys.argv[1] == "collect": gc.collect()
if sys.argv[1] == "thread":
    threading.Thread(target=running.step).start()
if sys.argv[1] == "raise":
    raise SystemExit(5)
sys.modules["kept"] = node
"""


def test_end_of_the_program():
    for how, code in (("collect", 0), ("leave", 0), ("thread", 0), ("raise", 5)):
        done = subprocess.run([sys.executable, "-X", "faulthandler", "-c", ENDS, how], timeout=200, capture_output=True, text=True,
                              check=False, env=dict(os.environ, PYTHONPATH=str(source / "python")))
        assert (done.returncode, done.stderr) == (code, ""), (how, done)


for function in (test_closed, test_pickled, test_exception_in_progress, test_interrupted_before_the_first_step, test_memory_error_has_its_text, test_texts_with_a_zero_byte,
                 test_end_of_the_program):
    print(function.__name__, flush=True)
    function()
    gc.collect()
print("ok")
