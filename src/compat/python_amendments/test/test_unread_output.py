"""A program of ours whose output's reader has ended, as of `roslaunch ... | grep`, ends quietly."""

import os
import subprocess
import sys
from pathlib import Path

import pytest

SPAWNER = Path(__file__).parents[2] / "controller_manager/scripts/spawner"
PRINTS = f"import sys; sys.orig_argv = ['python3', {str(SPAWNER)!r}]; print('a line', flush=True)"


def run_unread(*command, **environment):
    """Its exit code, and what it says on stderr."""
    reading, writing = os.pipe()
    os.close(reading)
    try:
        done = subprocess.run([sys.executable, *command], stdout=writing, stderr=subprocess.PIPE,
                              text=True, timeout=60, env=os.environ | environment)
    finally:
        os.close(writing)
    return done.returncode, done.stderr


@pytest.mark.parametrize("language", ["en", "zh_CN"])
@pytest.mark.parametrize(("unbuffered", "code"), [("", 0), ("1", 1)])  # the last lines; each
def test_its_lines_are_lost_without_a_word(language, unbuffered, code):
    assert run_unread(SPAWNER, "--help", LC_ALL="C.UTF-8", LANGUAGE=language,
                      PYTHONUNBUFFERED=unbuffered) == (code, "")


def test_a_line_that_fails_is_no_traceback():
    assert run_unread("-c", PRINTS) == (1, "")


@pytest.mark.parametrize("code", ["print('a line', flush=True)", "print('a line')"])
def test_a_persons_own_program_is_as_ever(code):
    assert "BrokenPipeError" in run_unread("-c", code, PYTHONUNBUFFERED="")[1]


def test_another_broken_pipe_is_a_fault():
    code = PRINTS.rpartition(";")[0] + "; raise BrokenPipeError('a socket')"
    done = subprocess.run([sys.executable, "-c", code], capture_output=True, text=True, timeout=60)
    assert done.returncode == 1 and "a socket" in done.stderr
