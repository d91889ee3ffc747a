"""What waits for one browser, newest only unless kept; JSON that browsers read; freed memory."""

import asyncio
import json
import struct
import subprocess
import sys

from sim_viewer.hub import MOST_BYTES, MOST_KEPT, Outbox, encode


def drained(fill, watches=(1, 2)):
    """All that a browser gets after `fill(outbox)`."""
    async def story():
        outbox = Outbox(asyncio.get_running_loop())
        for watch in watches:
            outbox.open(watch)
        fill(outbox)
        await asyncio.sleep(0)
        got = []
        while True:
            try:
                got.append(await asyncio.wait_for(outbox.next(), 0.01))
            except TimeoutError:
                return got

    return asyncio.run(story())


def test_of_many_pictures_a_slow_browser_gets_the_newest():
    got = drained(lambda box: [box.post(1, b"%d" % i, keep=False) for i in range(50)])
    assert got == [struct.pack("<I", 1) + b"49"]


def test_what_is_kept_comes_whole_and_in_order_up_to_a_limit():
    got = drained(lambda box: [box.post(1, i, keep=True) for i in range(MOST_KEPT + 10)])
    assert [json.loads(text)["data"] for text in got] == list(range(10, MOST_KEPT + 10))


def test_what_is_kept_costs_no_more_than_some_memory():
    got = drained(lambda box: [box.post(1, f"{i:03}" + "x" * 400_000, keep=True)
                               for i in range(100)])
    assert sum(map(len, got)) <= MOST_BYTES
    assert json.loads(got[-1])["data"].startswith("099")
    assert len(got) > 5


def test_the_newest_never_replaces_what_is_kept():
    def fill(box):
        box.post(1, "old", keep=False)
        box.post(1, "names", keep=True)
        box.post(1, "rows", keep=False)
        box.post(1, "newer rows", keep=False)

    assert [json.loads(text)["data"] for text in drained(fill)] == ["old", "names", "newer rows"]


def test_watches_take_turns_and_answers_go_first():
    def fill(box):
        for i in range(3):
            box.post(1, i, keep=True)
            box.post(2, i, keep=True)
        box.answer({"id": 7})

    got = [json.loads(text) for text in drained(fill)]
    assert got[0] == {"id": 7}
    assert [message["watch"] for message in got[1:]] == [1, 2, 1, 2, 1, 2]


def test_nothing_of_a_closed_watch_is_sent():
    def fill(box):
        box.post(1, "late", keep=True)
        box.close(1)

    assert drained(fill) == []


def test_numbers_that_json_does_not_know_become_null():
    text = encode({"a": [1.0, float("nan"), (float("inf"),)]})
    assert json.loads(text) == {"a": [1, None, [None]]}


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
