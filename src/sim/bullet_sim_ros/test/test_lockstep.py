"""What the loop waits for in lockstep, without a master."""

import pytest
import rospy

from bullet_sim_ros import names, params
from bullet_sim_ros.lockstep import Lockstep
from bullet_sim_ros.mailbox import Mailbox


class Waiting:
    """A loop in lockstep that has just taken a frame."""

    def __init__(self, topics="/cmd_vel"):
        self.mailbox = Mailbox()
        self.lockstep = Lockstep(topics, 10.0, self.mailbox)
        self.commands = []

    def joined(self, name, topic="/cmd_vel"):
        """What a plugin does with a message."""
        self.lockstep.subscribe(topic, name)

        def take():
            self.mailbox.post(lambda: self.commands.append(name))
            self.lockstep.receive(topic, name)
        return take

    def goes_on(self):
        """Whether the loop ends its wait with what has come."""
        looks = iter((False, True))
        self.lockstep.expect()
        self.lockstep.wait(lambda: next(looks))
        return next(looks, None) is not None


def test_the_world_waits_until_every_plugin_has_its_command():
    """Two drives on one topic; rospy tells them in the order in which they subscribed."""
    loop = Waiting()
    front, rear = loop.joined("front"), loop.joined("rear")
    front()
    assert not loop.goes_on()
    rear()
    assert loop.goes_on()
    assert loop.commands == ["front", "rear"]


def test_of_a_plugin_that_is_gone_nothing_is_awaited():
    loop = Waiting()
    front, _ = loop.joined("front"), loop.joined("rear")
    loop.lockstep.unsubscribe("/cmd_vel", "rear")
    front()
    assert loop.goes_on()


def test_an_image_without_an_answer_is_counted():
    lockstep = Lockstep("/cmd_vel", 1e-3, Mailbox())
    lockstep.expect()
    lockstep.wait(lambda: False)
    assert lockstep.unanswered == 1


def test_the_world_waits_after_the_messages_of_one_sensor():
    lockstep = Lockstep("/cmd_vel", 1e-3, Mailbox(), "/scan")
    lockstep.expect()
    lockstep.expect(sensor="/imu")
    lockstep.wait(lambda: False)
    assert lockstep.unanswered == 0
    lockstep.expect(sensor="/scan")
    lockstep.wait(lambda: False)
    assert lockstep.unanswered == 1


def test_nobody_waits_for_a_sensor_that_is_gone():
    lockstep = Lockstep("/cmd_vel", 1e-3, Mailbox())
    lockstep.expect("front")
    lockstep.cancel("rear")
    lockstep.wait(lambda: False)
    assert lockstep.unanswered == 1
    lockstep.expect("front")
    lockstep.cancel("front")
    lockstep.wait(lambda: False)
    assert lockstep.unanswered == 1


def test_the_world_waits_for_a_message_on_each_of_several_topics():
    loop = Waiting("/left, /right")
    left, right = loop.joined("left", "/left"), loop.joined("right", "/right")
    left()
    assert not loop.goes_on()
    right()
    left()
    assert loop.goes_on()
    right()
    assert not loop.goes_on()


@pytest.mark.parametrize(("given", "used", "lines"), [
    (0, 0.0, 0), ("0.0", 0.0, 0), (5, 5.0, 0), (-1, 1.0, 1), (float("nan"), 1.0, 1)])
def test_a_time_out_below_0_is_not_for_ever(monkeypatch, given, used, lines):
    said = []
    monkeypatch.setattr(rospy, "get_param", lambda name, default: (
        given if name == names.LOCKSTEP_TIMEOUT else default))
    monkeypatch.setattr(rospy, "has_param", lambda name: True)
    monkeypatch.setattr(rospy, "logwarn", lambda form, *values: said.append(form % values))
    assert params.read_node_parameters().lockstep_timeout == used
    assert len(said) == lines and all("which is not 0 or more; 1 is used" in line for line in said)
