"""What large messages took is free again, whichever thread had them."""

import subprocess
import sys

STORY = """
import pathlib, threading
from sim_viewer.node import give_back_large_blocks

def used():
    return int(pathlib.Path("/proc/self/statm").read_text().split()[1]) * 4096 >> 20

def work(barrier):
    for _ in range(3):
        cloud = b"x" * (16 << 20)
        barrier.wait()
        del cloud
        barrier.wait()

give_back_large_blocks()
before, barrier = used(), threading.Barrier(8)
threads = [threading.Thread(target=work, args=(barrier,)) for _ in range(8)]
for one in threads:
    one.start()
for one in threads:
    one.join()
print(used() - before)
"""


def test_large_messages_leave_nothing_behind():
    done = subprocess.run([sys.executable, "-c", STORY], capture_output=True, text=True,
                          check=True, timeout=60)
    assert int(done.stdout) < 10  # MB; otherwise 40 and more
