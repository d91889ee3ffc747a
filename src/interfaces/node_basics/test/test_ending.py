"""Programs that get signals, each in a process of its own."""

import select
import signal
import subprocess
import sys

import pytest

pytestmark = pytest.mark.processes

LIMIT = 60  # s, wall; a busy machine starts a process slowly
INTERRUPTED = """
import time
from node_basics.ending import interruptible
try:
    with interruptible():
        print("ready", flush=True)
        time.sleep(600)
except KeyboardInterrupt:
    print("cleanup", flush=True)
    input()
    print("clean", flush=True)
"""
INNER = """
import atexit
from node_basics.ending import interruptible
atexit.register(input)
try:
    with interruptible():
        print("ready", flush=True)
        input()
except KeyboardInterrupt:
    with interruptible():
        pass
    print("cleanup", flush=True)
"""
ASKED = """
import os, sys, threading, time
from node_basics.ending import at_signals
asked = threading.Event()
at_signals(asked.set, float(sys.argv[1]), os._exit)
print("ready", flush=True)
while not asked.wait(0.05):
    pass
print("asked", flush=True)
time.sleep(600 if sys.argv[1] == "1" else 0)
"""
STUCK = """
import os, time
from node_basics.ending import at_signals
at_signals(lambda: time.sleep(600), 1, os._exit)
print("ready", flush=True)
time.sleep(600)
"""
UNREAD = """
from node_basics.ending import drop_unread_output
print("ready", drop_unread_output() or "", sep="", flush=True)
input()
assert drop_unread_output()
print("a line of the cleanup", flush=True)
"""
SIGNALS = pytest.mark.parametrize("number", [signal.SIGINT, signal.SIGTERM, signal.SIGHUP])


@pytest.fixture
def start():
    started = []

    def begin(*command):
        started.append(subprocess.Popen([sys.executable, "-c", *command], stdin=subprocess.PIPE,
                                        stdout=subprocess.PIPE, stderr=subprocess.PIPE, text=True))
        assert started[-1].stdout.readline() == "ready\n"
        return started[-1]

    yield begin
    for process in started:
        process.kill()
        process.communicate()


@SIGNALS
def test_a_second_signal_does_not_disturb_the_cleanup(start, number):
    process = start(INTERRUPTED)
    process.send_signal(number)
    assert process.stdout.readline() == "cleanup\n"
    process.send_signal(number)
    assert process.communicate("\n", LIMIT) == ("clean\n", "")
    assert process.returncode == 0


def test_two_signals_at_once_are_no_traceback(start):
    process = start(INTERRUPTED)
    process.send_signal(signal.SIGSTOP)
    for number in (signal.SIGINT, signal.SIGTERM, signal.SIGCONT):  # as a shell passes Ctrl-C on
        process.send_signal(number)
    assert process.communicate("\n", LIMIT) == ("cleanup\nclean\n", "")


@SIGNALS
def test_a_second_signal_at_the_very_end_is_quiet(start, number):
    process = start(INNER)
    process.send_signal(number)
    assert process.stdout.readline() == "cleanup\n"
    process.send_signal(number)
    assert process.communicate("\n", LIMIT) == ("", "")
    assert process.returncode == 0


@SIGNALS
@pytest.mark.parametrize("limit", ["60", "1"])
def test_a_program_that_does_not_end_when_asked_is_ended(start, number, limit):
    process = start(ASKED, limit)
    process.send_signal(number)
    assert process.communicate(timeout=LIMIT) == ("asked\n", "")
    assert process.returncode == (128 + number if limit == "1" else 0)


@pytest.mark.parametrize("program", [[INTERRUPTED], [ASKED, "60"]])
def test_nohup_outlives_its_terminal(start, program):
    before = signal.signal(signal.SIGHUP, signal.SIG_IGN)  # as nohup; a process inherits it
    try:
        process = start(*program)
    finally:
        signal.signal(signal.SIGHUP, before)
    process.send_signal(signal.SIGHUP)
    assert select.select([process.stdout], [], [], 0.5)[0] == []
    process.send_signal(signal.SIGTERM)
    assert process.stdout.readline() in ("cleanup\n", "asked\n")


def test_a_program_that_cannot_even_be_asked_is_ended(start):
    process = start(STUCK)
    process.send_signal(signal.SIGTERM)
    assert process.communicate(timeout=LIMIT) == ("", "")
    assert process.returncode == 128 + signal.SIGTERM


def test_a_cleanup_whose_lines_nobody_reads_goes_on(start):
    process = start(UNREAD)
    process.stdout.close()
    process.stdin.write("\n")
    process.stdin.flush()
    assert process.wait(LIMIT) == 0 and process.stderr.read() == ""
    process.stdout = None  # for what ends it
