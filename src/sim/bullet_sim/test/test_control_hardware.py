"""Joints driven through the hardware, in the engine: each interface, limits, emergency stop."""

import math

import pytest

from bullet_sim.control.controllers.forward import Forward
from bullet_sim.control.controllers.servo import PositionServo, Servos, VelocityServo
from bullet_sim.control.handles import CommandHandle, JointHandle
from bullet_sim.control.hardware import RobotHardware
from bullet_sim.control.pid import Pid, PidGains
from bullet_sim.description import (
    Inertial,
    JointDescription,
    JointLimits,
    LinkDescription,
    ModelDescription,
)
from bullet_sim.errors import SimulationError, UnknownName
from bullet_sim.formats.urdf.transmission import Transmission
from bullet_sim.world import World

DT = 0.001  # s, a step
INERTIA = 0.02  # kg m^2 about each joint's axis
ARM = Inertial(mass=1.0, inertia=(INERTIA, 0.0, 0.0, INERTIA, 0.0, INERTIA))


class Bench:
    """Links that turn about z, without gravity's help, each on a joint of its own."""

    def __init__(self, gains=None, limits=None, kind="revolute", **joints):
        """`joints`: name=interface."""
        links = [LinkDescription(f"{name}_link", inertial=ARM) for name in joints]
        described = [JointDescription(name, kind, "world", f"{name}_link", friction=0.0)
                     for name in joints]
        self._interfaces = joints
        self.world = World()
        self.model = self.world.spawn(
            ModelDescription("bench", links=tuple(links), joints=tuple(described)))
        self.hardware = RobotHardware(
            self.model, [Transmission(name, name, kind) for name, kind in joints.items()],
            limits or {}, gains or {})

    def handle(self, joint):
        return self.hardware.command_handle(self._interfaces[joint], joint)

    def run(self, steps, *laws):
        for _ in range(steps):
            self.hardware.read()
            for law in laws:
                law.update(self.world.time, DT)
            self.hardware.write(DT)
            self.world.step()
        self.hardware.read()


def test_an_effort_accelerates_as_newton_says_and_is_shown():
    bench = Bench(a="effort", b="effort")
    bench.handle("a").command = 0.1
    bench.run(100)
    a, b = bench.hardware.joints["a"], bench.hardware.joints["b"]
    assert a.velocity == pytest.approx(0.1 / INERTIA * 0.1, rel=0.01)
    assert (a.effort, b.velocity, b.effort) == (0.1, 0.0, 0.0)
    bench.handle("a").command = 0.0
    before = a.velocity
    bench.run(100)
    assert a.velocity == pytest.approx(before, rel=0.01)  # no effort is left behind


def test_efforts_stop_at_their_limit():
    bench = Bench(limits={"a": JointLimits(effort=0.05)}, a="effort")
    bench.handle("a").command = 9.0
    bench.run(100)
    assert bench.hardware.joints["a"].velocity == pytest.approx(0.05 / INERTIA * 0.1, rel=0.01)


def test_a_velocity_without_gains_is_reached_with_the_effort_limit():
    bench = Bench(limits={"a": JointLimits(effort=0.1)}, a="velocity", b="velocity")
    bench.handle("a").command = bench.handle("b").command = 1.0
    bench.run(100)
    a, b = bench.hardware.joints["a"], bench.hardware.joints["b"]
    assert a.velocity == pytest.approx(0.5, rel=0.01)  # 0.1 N m for 0.1 s
    assert b.velocity == pytest.approx(1.0)
    bench.run(200)
    assert a.velocity == pytest.approx(1.0)


def test_a_position_without_gains_is_there_at_the_next_step_but_no_faster_than_allowed():
    bench = Bench(limits={"a": JointLimits(-0.5, 0.5, velocity=2.0)}, a="position", b="position")
    bench.handle("a").command, bench.handle("b").command = 9.0, 0.05
    bench.run(1)
    a, b = bench.hardware.joints["a"], bench.hardware.joints["b"]
    assert (a.position, b.position) == pytest.approx((0.002, 0.05), abs=1e-6)
    bench.run(99)
    assert (a.position, a.velocity) == pytest.approx((0.2, 2.0), abs=1e-4)
    bench.run(200)
    assert (a.position, a.velocity) == pytest.approx((0.5, 0.0), abs=1e-4)


def test_with_gains_position_and_velocity_are_driven_by_effort():
    gains = {"a": PidGains(p=4.0, d=0.4), "b": PidGains(p=1.0)}
    bench = Bench(gains, {"b": JointLimits(effort=0.02)}, a="position", b="velocity")
    bench.handle("a").command, bench.handle("b").command = 0.3, 5.0
    bench.run(1)
    assert bench.hardware.joints["b"].effort == 0.02
    bench.run(3000)
    a, b = bench.hardware.joints["a"], bench.hardware.joints["b"]
    assert a.position == pytest.approx(0.3, abs=1e-3)
    assert b.velocity == pytest.approx(0.02 / INERTIA * 3.0, rel=0.01)


def test_a_continuous_joint_counts_turns_and_turns_the_short_way():
    bench = Bench({"a": PidGains(p=4.0, d=0.6)}, kind="continuous", a="position", b="velocity")
    bench.handle("a").command, bench.handle("b").command = 2 * math.pi + 0.2, 10.0
    bench.run(2000)
    assert bench.hardware.joints["a"].position == pytest.approx(0.2, abs=1e-2)
    assert bench.hardware.joints["b"].position == pytest.approx(20.0, rel=0.01)


@pytest.mark.parametrize("interface", ["effort", "velocity", "position"])
def test_nothing_is_commanded_at_first(interface):
    assert CommandHandle(JointHandle("a", "revolute"), interface).command == 0.0


def test_until_a_command_comes_positions_are_held():
    bench = Bench(a="position", b="position")
    bench.model.joint("a").reset(0.4)
    hardware = RobotHardware(
        bench.model, [Transmission(name, name, "position") for name in "ab"], {}, {})
    for _ in range(100):
        hardware.read()
        hardware.write(DT)
        bench.world.step()
    positions = [bench.model.joint(name).position for name in "ab"]
    assert positions == pytest.approx([0.4, 0.0], abs=1e-6)


def test_an_emergency_stop_holds_positions_and_lets_go_of_the_rest():
    bench = Bench(kind="continuous", a="effort", b="position", c="velocity")
    law = Forward([bench.handle(name) for name in "abc"])
    law.start()
    law.commands.take((0.1, 0.4, 3.0))
    bench.run(50, law)
    joints = bench.hardware.joints
    bench.hardware.stop(True)
    bench.model.joint("b").reset(0.3)
    bench.hardware.read()
    bench.hardware.stop(True)  # said twice, it still holds where it stood first
    speed = joints["a"].velocity
    law.commands.take((0.1, 0.9, 3.0))
    bench.run(50, law)
    assert (joints["a"].velocity, joints["a"].effort) == (pytest.approx(speed, rel=0.01), 0.0)
    assert joints["b"].position == pytest.approx(0.4, abs=1e-6)
    assert joints["c"].velocity == pytest.approx(0.0, abs=1e-6)
    bench.hardware.stop(False)
    bench.run(50, law)
    assert joints["b"].position == pytest.approx(0.9, abs=1e-6)
    assert joints["c"].velocity == pytest.approx(3.0)


def test_what_is_no_number_never_reaches_the_engine():
    bench = Bench(a="effort", b="position", c="velocity")
    bench.run(1)
    for name in "abc":
        bench.handle(name).command = math.nan
    bench.run(10)
    states = [(joint.position, joint.velocity) for joint in bench.hardware.joints.values()]
    assert all(abs(value) < 1e-9 for state in states for value in state)


def test_errors_say_what_there_is():
    bench = Bench(a="effort", b="position")
    with pytest.raises(UnknownName, match="'c'; there are: a, b"):
        bench.hardware.command_handle("effort", "c")
    with pytest.raises(SimulationError, match=r"'b' takes position commands, not effort .*: a"):
        bench.hardware.command_handle("effort", "b")
    with pytest.raises(SimulationError, match=r'"x" which is not in the gazebo model.*a, b'):
        RobotHardware(bench.model, [Transmission("t", "x", "effort")], {}, {})


# --- laws

def test_servos_hold_what_is_there_until_told_otherwise():
    bench = Bench(a="effort", b="effort")
    bench.model.joint("a").reset(0.2)
    bench.hardware.read()
    position = PositionServo(bench.handle("a"), Pid(PidGains(p=4.0, d=0.4)))
    velocity = VelocityServo(bench.handle("b"), Pid(PidGains(p=0.5)))
    laws = [Servos([position]), Servos([velocity])]
    for law in laws:
        law.start()
    bench.run(100, *laws)
    assert bench.hardware.joints["a"].position == pytest.approx(0.2)
    laws[0].commands.take((0.5,))
    laws[1].commands.take((2.0,))
    bench.run(2000, *laws)
    assert bench.hardware.joints["a"].position == pytest.approx(0.5, abs=1e-3)
    assert bench.hardware.joints["b"].velocity == pytest.approx(2.0, abs=1e-3)


def test_after_a_time_out_a_velocity_is_0_and_a_position_held():
    bench = Bench(a="effort", b="effort")
    for servo, after in ((PositionServo(bench.handle("a"), Pid(PidGains())), 0.5),
                         (VelocityServo(bench.handle("b"), Pid(PidGains())), 0.0)):
        law = Servos([servo], timeout=0.1)
        law.start()
        law.commands.take((0.5,))
        for time, target in ((1.0, 0.5), (1.2, after)):
            law.update(time, DT)
            assert servo.target == target


def test_a_servo_that_starts_again_has_forgotten_its_integral():
    bench = Bench(a="effort")
    gains = PidGains(i=1.0, i_clamp_max=1.0, i_clamp_min=-1.0)
    servo = VelocityServo(bench.handle("a"), Pid(gains))
    servo.start()
    servo.update(1.0, DT)
    first = servo.output
    servo.update(1.0, DT)
    servo.start()
    servo.update(1.0, DT)
    assert servo.output == first


def test_a_position_servo_keeps_within_the_limits():
    bench = Bench(limits={"a": JointLimits(-0.3, 0.3)}, a="effort")
    servo = PositionServo(bench.handle("a"), Pid(PidGains(p=1.0)))
    servo.update(5.0, DT)
    assert (servo.target, servo.error, servo.output) == (0.3, 0.3, 0.3)


@pytest.mark.parametrize(("interface", "after"), [("effort", 0.0), ("velocity", 0.0),
                                                  ("position", 0.4)])
def test_a_command_stands_until_its_time_out(interface, after):
    bench = Bench(a=interface)
    law = Forward([bench.handle("a")], timeout=0.2)
    law.start()
    law.commands.take((0.4,))
    values = []
    for tick in range(0, 500, 50):
        law.update(tick * DT, DT)
        values.append(bench.handle("a").command)
    assert values == [0.4] * 4 + [after] * 6


def test_a_time_out_counts_anew_when_time_is_reset():
    bench = Bench(a="velocity")
    law = Forward([bench.handle("a")], timeout=0.2)
    law.start()
    law.commands.take((0.4,))
    values = []
    for time in (10.0, 0.0, 0.1, 0.2):
        law.update(time, DT)
        values.append(bench.handle("a").command)
    assert values == [0.4, 0.4, 0.4, 0.0]


def test_without_a_time_out_a_command_stands_for_ever():
    bench = Bench(a="velocity")
    law = Forward([bench.handle("a")])
    law.start()
    law.commands.take((0.4,))
    law.update(0.0, DT)
    law.update(1e6, DT)
    assert bench.handle("a").command == 0.4
