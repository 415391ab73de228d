"""Two computers in network namespaces, joined by a link that loses, delays and reorders packets, and can be cut.

The link is two TAP devices and a thread that carries frames between them, so that it needs nothing of the kernel but namespaces
and /dev/net/tun (no netem). Needs root.
"""

import ctypes
import fcntl
import heapq
import os
import random
import select
import struct
import subprocess
import threading
import time
from dataclasses import dataclass

CLONE_NEWNET = 0x40000000
TUNSETIFF = 0x400454CA
IFF_TAP_WITHOUT_HEADER = 0x1002
MOST_WAITING = 20000  # Frames under way.
INTERFACE = "slam0"


def is_possible():
    """Empty, or what is missing."""
    if os.geteuid() != 0:
        return "needs root"
    if not os.path.exists("/dev/net/tun"):
        return "needs /dev/net/tun"
    probe = subprocess.run(["unshare", "--net", "true"], capture_output=True, check=False)
    return "" if probe.returncode == 0 else "needs network namespaces"


@dataclass
class Conditions:
    loss: float = 0.0  # Share of frames.
    delay_s: float = 0.0
    jitter_s: float = 0.0  # Added to the delay, drawn for each frame: reorders.
    is_cut: bool = False


class Computer:
    """A network namespace with an address on the link."""

    def __init__(self, name, address):
        self.name, self.address = name, address
        self.tap = None
        subprocess.run(["ip", "netns", "add", name], check=True)
        self.ip("link", "set", "lo", "up")

    def ip(self, *arguments):
        subprocess.run(["ip", "-n", self.name, *arguments], check=True)

    def plug(self):
        """Makes the interface, with its address."""
        self.tap = in_namespace(self.name, open_tap)
        self.ip("addr", "add", f"{self.address}/24", "dev", INTERFACE)
        self.ip("link", "set", INTERFACE, "up")

    def unplug(self):
        """The interface disappears."""
        tap, self.tap = self.tap, None
        os.close(tap)

    def start(self, command, **options):
        return subprocess.Popen(["ip", "netns", "exec", self.name, *map(str, command)], **options)

    def remove(self):
        if self.tap is not None:
            self.unplug()
        subprocess.run(["ip", "netns", "del", self.name], check=False)


def open_tap():
    device = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(device, TUNSETIFF, struct.pack("16sH", INTERFACE.encode(), IFF_TAP_WITHOUT_HEADER))
    return device


def in_namespace(name, function):
    """The result of the function, called by a thread in the namespace."""
    results = []

    def call():
        with open(f"/run/netns/{name}", "rb") as namespace:
            if ctypes.CDLL(None, use_errno=True).setns(namespace.fileno(), CLONE_NEWNET) != 0:
                raise OSError(ctypes.get_errno(), "setns")
        results.append(function())

    thread = threading.Thread(target=call)
    thread.start()
    thread.join()
    return results[0]


class BadLink:
    """Carries frames between two computers. `conditions` may be replaced at any time."""

    def __init__(self, left, right, seed=1):
        self.sides = (left, right)
        self.conditions = Conditions()
        self.carried = self.lost = 0
        self.random = random.Random(seed)
        self.waiting = []  # (time, number, side, frame)
        self.is_running = True
        self.thread = threading.Thread(target=self.run, daemon=True)
        self.thread.start()

    def run(self):
        while self.is_running:
            taps = {side.tap: i for i, side in enumerate(self.sides) if side.tap is not None}
            pause_s = min(0.02, max(0.0, self.waiting[0][0] - time.monotonic())) if self.waiting else 0.02
            try:
                for tap in select.select(list(taps), [], [], pause_s)[0]:
                    self.take(tap, 1 - taps[tap])
            except (OSError, ValueError):  # an interface disappeared
                time.sleep(0.001)
            self.deliver()

    def take(self, tap, to):
        for _ in range(64):
            try:
                frame = os.read(tap, 65536)
            except BlockingIOError:
                return
            conditions = self.conditions
            if conditions.is_cut or self.random.random() < conditions.loss or len(self.waiting) >= MOST_WAITING:
                self.lost += 1
                continue
            due = time.monotonic() + conditions.delay_s + conditions.jitter_s * self.random.random()
            heapq.heappush(self.waiting, (due, self.carried + len(self.waiting), to, frame))

    def deliver(self):
        while self.waiting and self.waiting[0][0] <= time.monotonic():
            _, _, to, frame = heapq.heappop(self.waiting)
            tap = self.sides[to].tap
            try:
                if tap is not None:
                    os.write(tap, frame)
                    self.carried += 1
            except OSError:  # its interface is down
                self.lost += 1

    def stop(self):
        self.is_running = False
        self.thread.join()
