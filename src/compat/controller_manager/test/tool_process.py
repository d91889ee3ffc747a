"""Runs the package's commands as a learner does, and waits for what they say."""

import os
import subprocess
import threading
import time

from roslib.packages import find_node

LIMIT = 60.0  # s


def until(condition, what):
    """Waits for a condition; fails with a word on what did not come."""
    end = time.monotonic() + LIMIT
    while not condition():
        if time.monotonic() > end:
            raise AssertionError(f"{what} did not come within {LIMIT:.0f} s")
        time.sleep(0.02)


class Tool:
    """A running command; `said` is all it wrote so far, to both outputs."""

    def __init__(self, case, name, *words, namespace="/"):
        environment = os.environ | {"ROS_NAMESPACE": namespace, "PYTHONUNBUFFERED": "1"}
        program = find_node("controller_manager", name)[0]
        self.process = subprocess.Popen(
            [program, *words], env=environment, text=True,
            stdout=subprocess.PIPE, stderr=subprocess.STDOUT)
        self.said = ""
        self._reader = threading.Thread(target=self._read)
        self._reader.start()
        case.addCleanup(self._reader.join)
        case.addCleanup(self.process.kill)

    def _read(self):
        with self.process.stdout as lines:
            for line in lines:
                self.said += line

    def until_says(self, words):
        until(lambda: words in self.said or not self._reader.is_alive(), words)
        assert words in self.said, f"{words!r} is not in:\n{self.said}"

    def end(self, number=None):
        """Its exit code, after a signal if one is given."""
        if number is not None:
            self.process.send_signal(number)
        code = self.process.wait(LIMIT)
        self._reader.join()
        return code


def run(case, name, *words, namespace="/"):
    """Exit code, standard output and standard error of a command that ends by itself."""
    environment = os.environ | {"ROS_NAMESPACE": namespace}
    program = find_node("controller_manager", name)[0]
    done = subprocess.run([program, *words], env=environment, text=True, capture_output=True,
                          timeout=LIMIT, check=False)
    case.assertNotIn("Traceback", done.stderr)
    return done.returncode, done.stdout, done.stderr
