"""Ctrl-C: a render that would take days ends with the picture so far; one whose kernel is being built ends without; the
program that called it goes on.

Usage: test_python_interrupt.py SOURCE_DIR BUILD_DIR
"""

import os
import signal
import subprocess
import sys
import tempfile

import package

# A shell starts what runs in the background with Ctrl-C ignored, and that would be handed on.
signal.signal(signal.SIGINT, signal.default_int_handler)
source, build = sys.argv[1:]
ballpark, _ = package.load(source, build)

# Says READY, waits for Ctrl-C in what follows, and then renders again in the same process.
RENDERING = """
import sys, threading
import numpy as np, ballpark
positions = np.random.default_rng(1).random((100, 3))
def report(now):
    if now.samples > 0: print("READY", flush=True)
try:
    ballpark.render(positions, radius=0.05, width=64, spp=2**26, progress=report)
except ballpark.Interrupted as stop:
    assert isinstance(stop, KeyboardInterrupt)
    picture = stop.picture
    assert threading.active_count() == 1
    assert picture.stopped == "interrupt" and picture.samples.max() > 0 and picture.radiance.mean() > 0.1
    picture.save("partial.png")
    assert ballpark.render(positions, radius=0.05, width=64, spp=2).stopped == "samples"
    print("STOPPED", flush=True)
"""
# No kernel is in this cache, so that it is built; Ctrl-C comes somewhere between the start and the first samples.
BUILDING = """
import numpy as np, ballpark
positions = np.random.default_rng(1).random((100, 3))
ballpark.devices()
try:
    print("READY", flush=True)
    ballpark.render(positions, radius=0.05, width=64, spp=2**26)
except KeyboardInterrupt as stop:  # a plain one if it comes before the render
    print("STOPPED", getattr(stop, "picture", None), flush=True)
"""
# Step by step: KeyboardInterrupt comes out of step(), and what is there can still be read.
STEPPING = """
import threading
import numpy as np, ballpark
scene = ballpark.make_scene(np.random.default_rng(1).random((100, 3)), radius=0.05, width=64)
with ballpark.Render(scene, spp=2**26) as running:
    running.step()
    try:
        print("READY", flush=True)
        while running.step() is None: pass
    except KeyboardInterrupt:
        assert running.picture().samples.max() > 0 and running.step() is None
        print("STOPPED", threading.active_count(), flush=True)
"""
# The same where a step takes as long as on a machine that has other work: its samples are kept. The second time, Ctrl-C is
# pressed twice: then nothing waits for the step.
SLOW = """
import signal, threading, time
import numpy as np, ballpark
from ballpark import _library as lib
slow, call = threading.Event(), lib.call
def slower(name, *arguments, **options):
    if name == "bp_render_step" and slow.is_set():
        print("READY", flush=True)
        time.sleep(3)
    return call(name, *arguments, **options)
lib.call = slower
scene = ballpark.make_scene(np.random.default_rng(1).random((100, 3)), radius=0.05, width=64)
with ballpark.Render(scene, spp=2**26) as running:
    running.step()
    slow.set()
    try:
        running.step()
    except KeyboardInterrupt:
        slow.clear()
        before = running.picture().samples.max()
        assert before > 0 and running.step() is None
    slow.set()
    threading.Timer(0.3, signal.raise_signal, [signal.SIGINT]).start()
    threading.Timer(0.6, signal.raise_signal, [signal.SIGINT]).start()
    begin = time.monotonic()
    try:
        running.step()
    except KeyboardInterrupt:
        assert time.monotonic() - begin < 2.5
        print("STOPPED", flush=True)
"""
# Ctrl-C behind the last look at whether it was pressed is not lost.
LATE = """
import signal
from ballpark._interrupt import CtrlC
try:
    with CtrlC():
        signal.raise_signal(signal.SIGINT)
except KeyboardInterrupt:
    print("STOPPED")
"""
LEFT_ALONE = """
import numpy as np, ballpark
print("READY", flush=True)
ballpark.render(np.zeros((1, 3)), width=64, spp=2**26)
"""


def interrupted(program, folder, **variables):
    with subprocess.Popen([sys.executable, "-c", program], cwd=folder, stdout=subprocess.PIPE, stderr=subprocess.PIPE,
                          text=True, env=dict(os.environ, PYTHONPATH=f"{source}/python", **variables)) as process:
        for line in process.stdout:
            if line.startswith("READY"):
                break
        process.send_signal(signal.SIGINT)
        output, errors = process.communicate(timeout=300)
        return process.returncode, output, errors


with tempfile.TemporaryDirectory() as folder:
    code, output, errors = interrupted(RENDERING, folder)
    assert code == 0 and "STOPPED" in output, (code, output, errors)
    assert os.path.getsize(f"{folder}/partial.png") > 100

    code, output, errors = interrupted(BUILDING, folder, POCL_CACHE_DIR=folder, XDG_CACHE_HOME=folder)
    assert code == 0 and "STOPPED" in output, (code, output, errors)

    code, output, errors = interrupted(STEPPING, folder)
    assert code == 0 and "STOPPED 1" in output, (code, output, errors)

    code, output, errors = interrupted(SLOW, folder)
    assert code == 0 and "STOPPED" in output, (code, output, errors)

    late = subprocess.run([sys.executable, "-c", LATE], stdout=subprocess.PIPE, env=dict(os.environ, PYTHONPATH=f"{source}/python"),
                          check=True)
    assert late.stdout == b"STOPPED\n", late

    # Nobody catches it: Python ends as it does on every Ctrl-C.
    code, output, errors = interrupted(LEFT_ALONE, folder)
    assert code in (1, -signal.SIGINT, 130) and "Interrupt" in errors, (code, output, errors)
print("ok")
