"""What tests need that start ranks: the launcher, why there is none, and the ranks that it has started."""

import os
import re
import shutil
import subprocess

import cli

MPIRUN = shutil.which("mpirun")
MODULE = os.path.join(os.path.dirname(cli.PROGRAM), "ballpark_mpi.so")
# Open MPI loses a few bytes in parts of itself that are unloaded by the end, so no suppression can name them. Our own side of
# ranks is looked at by tests/cluster, without MPI.
FLAGS = ["--oversubscribe", *(["--allow-run-as-root"] if os.getuid() == 0 else []),
         "-x", f"ASAN_OPTIONS={os.environ.get('ASAN_OPTIONS', '')}:detect_leaks=0",
         "--mca", "btl", "self,vader", "--mca", "orte_base_help_aggregate", "0"]


def reason_to_skip():
    if MPIRUN is None or b"Open MPI" not in subprocess.run([MPIRUN, "--version"], check=False, stdout=subprocess.PIPE,
                                                           stderr=subprocess.STDOUT).stdout:
        return "there is no mpirun of Open MPI"
    if not os.path.exists(MODULE):
        return "Ballpark was built without MPI"
    tried = subprocess.run([MPIRUN, *FLAGS, "-n", "2", "true"], check=False, stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
    return None if tried.returncode == 0 else "mpirun cannot start two processes here"


def rank_processes(launcher):
    """Process ids of the ranks that the process `launcher` has started, by rank."""
    ranks = {}
    for entry in os.listdir("/proc"):
        try:
            with open(f"/proc/{entry}/environ", "rb") as file:
                found = re.search(rb"(?:^|\0)OMPI_COMM_WORLD_RANK=(\d+)", file.read())
            with open(f"/proc/{entry}/stat", encoding="utf-8") as file:
                parent = int(file.read().rpartition(")")[2].split()[1])
        except (OSError, ValueError, IndexError):
            continue
        if found and parent == launcher.pid:
            ranks[int(found[1])] = int(entry)
    return ranks
