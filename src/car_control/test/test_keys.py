"""Keys held, told from a window's events and a terminal's characters; `xset r off` is there."""

import logging
import math
import os
import pty
import subprocess
import sys

import pytest
from car_control.key_terminal import keys_in, run_terminal
from car_control.keys import (
    FIRST_WAIT,
    RELEASE_WAIT,
    REPEAT_WAIT,
    Pace,
    TerminalKeys,
    WindowKeys,
    command,
)


@pytest.mark.parametrize(("keys", "speed", "angle"), [
    ("", 0, 0), ("w", 2, 0), ("s", -2, 0), ("a", 0, 0.34), ("d", 0, -0.34), ("wa", 2, 0.34),
    ("sd", -2, -0.34), ("ws", 0, 0), ("wad", 2, 0), ("wasd", 0, 0),
])
def test_what_the_keys_drive(keys, speed, angle):
    assert command(set(keys), 2.0, 0.34) == (speed, angle)


def test_a_repetition_is_no_release():
    keys = WindowKeys()
    keys.press("w")
    for i in range(50):  # a release and a press for each
        keys.release("w", i * 0.04)
        keys.press("w")
        assert keys.held(i * 0.04 + 0.039) == {"w"}
    keys.release("w", 2.0)
    assert keys.held(2.0 + RELEASE_WAIT * 0.9) == {"w"}
    assert keys.held(2.001 + RELEASE_WAIT) == frozenset()


def test_a_release_of_one_key_leaves_the_other():
    keys = WindowKeys()
    keys.press("w")
    keys.press("a")
    keys.release("a", 1.0)
    keys.release("x", 1.0)
    assert keys.held(1.001 + RELEASE_WAIT) == {"w"}
    keys.release_all()
    assert keys.held(1.0) == frozenset()


def test_a_typed_key_waits_for_its_first_repetition():
    keys = TerminalKeys()
    keys.press("w", 0.0)
    assert keys.held(FIRST_WAIT * 0.99) == {"w"}
    assert keys.held(FIRST_WAIT) == frozenset()


def test_once_repeated_a_key_is_let_go_sooner():
    keys = TerminalKeys()
    keys.press("w", 0.0)
    keys.press("w", 0.5)
    assert keys.held(0.5 + REPEAT_WAIT * 0.99) == {"w"}
    assert keys.held(0.501 + REPEAT_WAIT) == frozenset()


def test_the_second_key_keeps_the_first_alive():
    keys = TerminalKeys()
    keys.press("w", 0.0)
    for i in range(100):
        keys.press("a", 0.5 + i * 0.04)
    assert keys.held(0.5 + 99 * 0.04) == {"w", "a"}
    keys.press("d", 4.5)
    assert keys.held(4.5) == {"w", "d"}


@pytest.mark.parametrize(("text", "keys"), [
    ("wW", "ww"), ("\x1b[A\x1b[D", "wa"), ("\x1bOB", "s"), ("\x1b[1;5C", "d"), ("\x1b[3~w", "w"),
    ("\x1b", ""), ("q ", "q "),
])
def test_arrows_are_keys_and_other_sequences_are_not(text, keys):
    assert keys_in(text) == keys


def sent(pace, wanted, times):
    return [t for t in times if pace.due(wanted, t)]


def test_a_command_is_sent_at_once_and_ten_times_a_second():
    pace, steps = Pace(), [i * 0.02 for i in range(100)]
    assert sent(pace, (0.0, 0.0), steps) == []
    times = sent(pace, (2.0, 0.0), [2 + t for t in steps])
    assert times[0] == 2.0 and len(times) == 20
    assert math.isclose(times[-1] - times[0], 1.9, abs_tol=0.021)


def test_standing_is_said_at_once_for_a_moment_and_no_more():
    pace = Pace()
    pace.due((2.0, 0.1), 0.0)
    times = sent(pace, (0.0, 0.0), [0.05 + i * 0.02 for i in range(200)])
    assert times[0] == 0.05 and 3 <= len(times) <= 5 and times[-1] <= 0.05 + Pace.FAREWELL
    assert pace.due((0.0, 0.1), 9.0)


def test_xset_is_there_and_says_that_it_has_no_screen():
    nowhere = {name: value for name, value in os.environ.items() if name != "DISPLAY"}
    ended = subprocess.run(["xset", "r", "off"], env=nowhere, capture_output=True, text=True,
                           timeout=60, check=False)
    assert (ended.returncode, ended.stdout) == (1, "")
    assert "unable to open display" in ended.stderr


def test_a_log_line_begins_on_a_line_of_its_own_and_the_status_comes_below(capsys):
    # rospy writes it to the terminal while the status line is there
    keyboard, terminal = pty.openpty()
    log, stream = logging.getLogger("rosout"), logging.StreamHandler(sys.stdout)
    log.addHandler(stream)
    turns = iter([lambda: None, lambda: log.warning("Nobody listens to /motor_output yet."),
                  lambda: None])

    def turn(_keys):
        act = next(turns, None)
        return act and (act() or "the car stands")

    try:
        run_terminal(terminal, turn)
    finally:
        log.removeHandler(stream)
        os.close(keyboard)
        os.close(terminal)
    overwritten = [line.rpartition("\r")[2].rstrip()
                   for line in capsys.readouterr().out.split("\n")]
    assert overwritten[2:5] == ["Nobody listens to /motor_output yet.", "the car stands", ""]
    assert not log.filters
