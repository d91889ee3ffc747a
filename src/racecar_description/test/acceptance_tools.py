"""Runs the commands of package controller_manager in namespace /racecar, as a person does."""

import os
import signal
import subprocess
import tempfile

from acceptance_car import CONTROLLERS, LIMIT, all_running, call, wait_until
from gazebo_msgs.srv import GetPhysicsProperties, SetPhysicsProperties
from roslib.packages import find_node


def _command(name, words):
    return [find_node("controller_manager", name)[0], *words]


ENVIRONMENT = os.environ | {"ROS_NAMESPACE": "/racecar", "PYTHONUNBUFFERED": "1"}


def run(name, *words):
    """Exit code, standard output and standard error of a command that ends by itself."""
    done = subprocess.run(_command(name, words), env=ENVIRONMENT, capture_output=True, text=True,
                          timeout=LIMIT)
    return done.returncode, done.stdout, done.stderr


def manager(*words):
    """What `controller_manager WORDS` prints; it ends with 0 whatever the manager answers."""
    code, said, reason = run("controller_manager", *words)
    assert code == 0, (code, said, reason)
    assert "Traceback" not in reason, reason
    return said


def slow_down(share):
    """Let simulated time pass at this share of its rate; returns what ends that."""
    physics = call("/gazebo/get_physics_properties", GetPhysicsProperties)

    def set_rate(rate_hz):
        call("/gazebo/set_physics_properties", SetPhysicsProperties, time_step=physics.time_step,
             max_update_rate=rate_hz, gravity=physics.gravity, ode_config=physics.ode_config)

    set_rate(share * physics.max_update_rate)
    return lambda: set_rate(physics.max_update_rate)


class Spawner:
    """`spawner CONTROLLERS...`, which lives until it is told to end."""

    def __init__(self, *names):
        self._output = tempfile.TemporaryFile("w+")  # noqa: SIM115  (as long as the process)
        self.process = subprocess.Popen(_command("spawner", names), env=ENVIRONMENT,
                                        stdout=self._output, stderr=subprocess.STDOUT)

    def said(self):
        self._output.seek(0)
        return self._output.read()

    def wait_for(self, words):
        wait_until(lambda: words in self.said() or self.process.poll() is not None, words)
        assert words in self.said(), self.said()

    def end(self, number=signal.SIGINT):
        """Its exit code."""
        if self.process.poll() is None:
            self.process.send_signal(number)
        try:
            return self.process.wait(LIMIT)
        finally:
            self.process.kill()


def spawn_all():
    """The spawner of the car's seven controllers, which all run."""
    spawner = Spawner(*CONTROLLERS)
    wait_until(all_running, f"seven running controllers; {spawner.said()}")
    return spawner
