"""Links between the ranks of a job on one machine, with a delay and a rate as a network has them.

Each rank gets a network and a host name of its own (Linux namespaces), whose only interface leads to a switch: a process
that hands every packet on, late and one after the other. So Open MPI takes the ranks for machines of their own. The
kernel's means for delays (netem) is not on all machines; this needs root and /dev/net/tun alone.
"""

import ctypes
import fcntl
import heapq
import os
import select
import stat
import struct
import subprocess
import tempfile
import time

CLONE_NEWNET, TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x40000000, 0x400454CA, 0x0001, 0x1000
PACKET_BYTES = 60000  # few and large ones: the switch is a script
libc = ctypes.CDLL(None, use_errno=True)


def enter_network(descriptor):
    if libc.setns(descriptor, CLONE_NEWNET) != 0:
        raise OSError(ctypes.get_errno(), "setns")


def switch(tunnels, delay, rate):
    """Hands packets on for ever. `rate`: bytes a second of each link and direction; None: as fast as it goes."""
    os.nice(-20)  # other work on the machine is not to slow the network down
    waiting, number = [], 0
    sent, received = [0.0] * len(tunnels), [0.0] * len(tunnels)  # when each link is free again
    while True:
        ready = select.select(tunnels, [], [], max(0.0, waiting[0][0] - time.monotonic()) if waiting else None)[0]
        for tunnel in ready:
            try:
                packet = os.read(tunnel, 1 << 16)
            except BlockingIOError:
                continue
            source, target = tunnels.index(tunnel), packet[19] - 1  # the last byte of IPv4's destination
            if packet[0] >> 4 != 4 or not 0 <= target < len(tunnels):
                continue
            due = time.monotonic()
            if rate is not None:
                sent[source] = max(due, sent[source]) + len(packet) / rate
                received[target] = max(sent[source], received[target] + len(packet) / rate)
                due = received[target]
            heapq.heappush(waiting, (due + delay, number, target, packet))
            number += 1
        while waiting and waiting[0][0] <= time.monotonic():
            _, _, target, packet = heapq.heappop(waiting)
            try:
                os.write(tunnels[target], packet)
            except OSError:
                pass  # as on a network: it is sent again


class Links:
    """with Links(4, delay=0.001, rate=125e6) as links: subprocess.run(links.command(4, program, ...))"""

    def __init__(self, ranks, delay, rate):
        self.ranks, self.delay, self.rate = ranks, delay, rate
        self.machines, self.tunnels, self.switch = [], [], None

    def __enter__(self):
        try:
            self.begin()
        except BaseException:
            self.__exit__()
            raise
        return self

    def begin(self):
        own = os.open("/proc/self/ns/net", os.O_RDONLY)
        for rank in range(self.ranks):
            machine = subprocess.Popen(["unshare", "--net", "--uts", "sh", "-c",
                                        f"hostname rank{rank} && ip link set lo up && echo up && exec sleep 100000"],
                                       stdout=subprocess.PIPE, text=True)
            self.machines.append(machine)
            if machine.stdout.readline() != "up\n":
                raise OSError("networks of their own for ranks need root")
            network = os.open(f"/proc/{machine.pid}/ns/net", os.O_RDONLY)
            enter_network(network)
            try:
                self.tunnels.append(os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK))
                fcntl.ioctl(self.tunnels[-1], TUNSETIFF, struct.pack("16sH22x", b"ranks", IFF_TUN | IFF_NO_PI))
            finally:
                enter_network(own)
                os.close(network)
            subprocess.run(self.enter(rank) + ["sh", "-c", f"ip addr add 10.77.0.{rank + 1}/24 dev ranks && "
                                               f"ip link set ranks mtu {PACKET_BYTES} up"], check=True)
        os.close(own)
        self.switch = os.fork()
        if self.switch == 0:
            try:
                switch(self.tunnels, self.delay, self.rate)
            finally:
                os._exit(1)
        # What mpirun uses for ssh: the first argument is the address, the others are what to run there.
        handle, self.agent = tempfile.mkstemp(prefix="ballpark-agent-")
        os.write(handle, b"#!/bin/sh\nrank=$((${1##*.} - 1)); shift\ncase $rank in\n" +
                 b"".join(f"{rank}) exec {' '.join(self.enter(rank))} sh -c \"$*\";;\n".encode() for rank in range(self.ranks)) +
                 b"esac\n")
        os.close(handle)
        os.chmod(self.agent, stat.S_IRWXU)

    def enter(self, rank):
        pid = self.machines[rank].pid
        return ["nsenter", f"--net=/proc/{pid}/ns/net", f"--uts=/proc/{pid}/ns/uts"]

    def command(self, mpirun, *command):
        """One rank a machine. `mpirun`: the launcher and its options."""
        hosts = ",".join(f"10.77.0.{rank + 1}" for rank in range(self.ranks))
        return [*self.enter(0), *mpirun, "-n", str(self.ranks), "--host", hosts, "--bind-to", "none",
                "--mca", "plm_rsh_agent", self.agent, "--mca", "btl", "self,tcp", "--mca", "btl_tcp_if_include", "ranks",
                "--mca", "oob_tcp_if_include", "ranks", *command]

    @staticmethod
    def end_all(machine):
        """What a launcher that was interrupted has left there."""
        network = os.readlink(f"/proc/{machine.pid}/ns/net")
        for entry in filter(str.isdigit, os.listdir("/proc")):
            try:
                if os.readlink(f"/proc/{entry}/ns/net") == network != os.readlink("/proc/self/ns/net"):
                    os.kill(int(entry), 9)
            except OSError:
                pass  # it has ended meanwhile

    def __exit__(self, *_):
        if self.switch is not None:
            os.kill(self.switch, 9)
            os.waitpid(self.switch, 0)
            os.unlink(self.agent)
        for tunnel in self.tunnels:
            os.close(tunnel)
        for machine in self.machines:
            self.end_all(machine)
            machine.kill()
            machine.wait()
            machine.stdout.close()
