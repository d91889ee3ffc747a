#!/usr/bin/env python3
"""A slow cable between two network namespaces: each packet comes late, and some never.

  slow_cable.py DEVICE DELAY LOSS SEED NAMESPACE NAMESPACE

Makes the tun device DEVICE in both namespaces, prints "ready", and carries packets from one to the
other after DELAY, s, in their order, but a share LOSS of them, drawn from SEED, not at all. At
SIGUSR1 it prints a line of JSON: how many packets it has carried and lost. Does what
`tc qdisc add ... netem` does where the kernel has that.
"""

from __future__ import annotations

import ctypes
import fcntl
import json
import os
import random
import select
import signal
import struct
import sys
import time
from collections import deque
from pathlib import Path

TUNSETIFF, IFF_TUN, IFF_NO_PI = 0x400454CA, 0x0001, 0x1000  # <linux/if_tun.h>
CLONE_NEWNET = 0x40000000  # <linux/sched.h>
LARGEST = 65536  # bytes of a packet


def enter(namespace: Path) -> None:
    """This process uses that network from now on. Raises OSError."""
    libc = ctypes.CDLL(None, use_errno=True)
    with namespace.open() as file:
        if libc.setns(file.fileno(), CLONE_NEWNET):
            number = ctypes.get_errno()
            raise OSError(number, os.strerror(number), str(namespace))


def open_device(name: str, namespace: str) -> int:
    """A tun device in a namespace of `ip netns`; it lives as long as this file is open."""
    enter(Path("/run/netns") / namespace)
    device = os.open("/dev/net/tun", os.O_RDWR | os.O_NONBLOCK)
    fcntl.ioctl(device, TUNSETIFF, struct.pack("16sH22x", name.encode(), IFF_TUN | IFF_NO_PI))
    return device


class Cable:
    """Both ways of it. Each has the same delay, so packets are due in the order they came in."""

    def __init__(self, devices: tuple[int, int], delay: float, loss: float, seed: int) -> None:
        self._other = dict(zip(devices, devices[::-1]))
        self._delay, self._loss, self._random = delay, loss, random.Random(seed)
        self._waiting: deque[tuple[float, int, bytes]] = deque()  # due (s), device, packet
        self.carried = self.lost = 0

    def step(self) -> None:
        """Waits for the next packet to come in or to be due, and does what is to be done."""
        wait = None
        if self._waiting:
            wait = max(self._waiting[0][0] - time.monotonic(), 0.0)
        for device in select.select(list(self._other), [], [], wait)[0]:
            self._take(device)
        while self._waiting and self._waiting[0][0] <= time.monotonic():
            _, device, packet = self._waiting.popleft()
            self._give(device, packet)

    def _take(self, device: int) -> None:
        while True:
            try:
                packet = os.read(device, LARGEST)
            except BlockingIOError:
                return
            if self._random.random() < self._loss:
                self.lost += 1
            else:
                self._waiting.append((time.monotonic() + self._delay, self._other[device], packet))

    def _give(self, device: int, packet: bytes) -> None:
        try:
            os.write(device, packet)
            self.carried += 1
        except OSError:
            self.lost += 1  # the other end is not up


def main() -> None:
    """Until it is killed."""
    name, delay, loss, seed, *namespaces = sys.argv[1:]
    cable = Cable(tuple(open_device(name, namespace) for namespace in namespaces), float(delay),
                  float(loss), int(seed))

    def tell(*_: object) -> None:
        print(json.dumps({"carried": cable.carried, "lost": cable.lost}), flush=True)

    signal.signal(signal.SIGUSR1, tell)
    print("ready", flush=True)
    while True:
        cable.step()


if __name__ == "__main__":
    main()
