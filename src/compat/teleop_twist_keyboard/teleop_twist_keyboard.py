#!/usr/bin/env python3
"""Reads keys from the terminal and publishes cmd_vel, with upstream's keys, text and parameters."""

from __future__ import annotations

import os
import re
import select
import sys
import time
from contextlib import suppress
from dataclasses import dataclass

import rospy
from geometry_msgs.msg import Twist, TwistStamped
from node_basics.ending import interruptible, single_keys

CTRL_C = "\x03"
# One key: what function keys and arrows send (F1 is ESC O P, of which O alone would drive), or a
# character.
KEY = re.compile(r"\x1b[\[O]?[0-9;]*.?|.", re.DOTALL)
LOOK_UP = 0.1  # s, how often the end of ROS is looked for while no key comes
FLUSH_TIME = 0.2  # s, rospy sends from threads of its own that end with the process
SPEED_KEYS_PER_HELP = 15
HELP = """
Reading from the keyboard and publishing to Twist!
---------------------------
Moving around:
   u    i    o
   j    k    l
   m    ,    .

For holonomic mode (strafing), hold down the shift key:
---------------------------
   U    I    O
   J    K    L
   M    <    >

t : up (+z)
b : down (-z)

anything else : stop

q/z : increase/decrease max speeds by 10%
w/x : increase/decrease only linear speed by 10%
e/c : increase/decrease only angular speed by 10%

CTRL-C to quit
"""
STANDING = (0, 0, 0, 0)
MOVES = {  # key -> signs of forward, left, up, turning left
    "i": (1, 0, 0, 0), "o": (1, 0, 0, -1), "j": (0, 0, 0, 1), "l": (0, 0, 0, -1),
    "u": (1, 0, 0, 1), ",": (-1, 0, 0, 0), ".": (-1, 0, 0, 1), "m": (-1, 0, 0, -1),
    "O": (1, -1, 0, 0), "I": (1, 0, 0, 0), "J": (0, 1, 0, 0), "L": (0, -1, 0, 0),
    "U": (1, 1, 0, 0), "<": (-1, 0, 0, 0), ">": (-1, -1, 0, 0), "M": (-1, 1, 0, 0),
    "t": (0, 0, 1, 0), "b": (0, 0, -1, 0),
}
FACTORS = {  # key -> what it multiplies speed and turn by
    "q": (1.1, 1.1), "z": (0.9, 0.9), "w": (1.1, 1), "x": (0.9, 1), "e": (1, 1.1), "c": (1, 0.9),
}


@dataclass
class KeyedSpeeds:
    """What the keys have asked for so far."""

    speed: float  # m/s
    turn: float  # rad/s
    speed_limit: float  # m/s
    turn_limit: float  # rad/s
    move: tuple[int, int, int, int] = STANDING
    speed_keys: int = 0

    def press(self, key: str) -> list[str]:
        """What the terminal is to show after this key; one that means nothing stops."""
        if key not in FACTORS:
            self.move = MOVES.get(key, STANDING)
            return []
        faster, sharper = FACTORS[key]
        self.speed = min(self.speed * faster, self.speed_limit)
        self.turn = min(self.turn * sharper, self.turn_limit)
        shown = []
        if self.speed == self.speed_limit:
            shown.append("Linear speed limit reached!")
        if self.turn == self.turn_limit:
            shown.append("Angular speed limit reached!")
        shown.append(self.state())
        self.speed_keys += 1
        return [*shown, HELP] if self.speed_keys % SPEED_KEYS_PER_HELP == 0 else shown

    def state(self) -> str:
        return f"currently:\tspeed {self.speed:g}\tturn {self.turn:g} "


class CommandTopic:
    """cmd_vel, as Twist or TwistStamped."""

    def __init__(self) -> None:
        self._stamped = rospy.get_param("~stamped", False)
        self._frame = rospy.get_param("~frame_id", "")
        kind = TwistStamped if self._stamped else Twist
        self._publisher = rospy.Publisher("cmd_vel", kind, queue_size=1)

    def wait_for_subscriber(self) -> None:
        seconds = 0.0
        while not rospy.is_shutdown() and not self._publisher.get_num_connections():
            if seconds and seconds % 2 == 0:
                say(f"Waiting for subscriber to connect to {self._publisher.name}")
            time.sleep(0.5)
            seconds += 0.5

    def send(self, drive: KeyedSpeeds) -> None:
        twist = Twist()
        forward, left, up, turning = drive.move
        twist.linear.x = forward * drive.speed
        twist.linear.y = left * drive.speed
        twist.linear.z = up * drive.speed
        twist.angular.z = turning * drive.turn
        message = twist
        if self._stamped:
            message = TwistStamped(twist=twist)
            message.header.stamp, message.header.frame_id = rospy.Time.now(), self._frame
        self._publisher.publish(message)


def read_keys(terminal: int, wait: float) -> list[str]:
    """What was typed, none when nothing came in time; a terminal that is gone counts as Ctrl-C."""
    if not select.select([terminal], [], [], wait)[0]:
        return []
    try:
        typed = os.read(terminal, 1024).decode(errors="replace")
    except OSError:
        typed = ""
    return KEY.findall(typed) or [CTRL_C]


def drive_by_keys(terminal: int, topic: CommandTopic, drive: KeyedSpeeds) -> None:
    """Until Ctrl-C or the end of ROS. A rate or timeout of 0 means none, as upstream's."""
    repeat_rate, key_timeout = read_number("repeat_rate", 0.0), read_number("key_timeout", 0.0)
    period = 1.0 / repeat_rate if repeat_rate > 0 else float("inf")  # s
    last_key = last_sent = time.monotonic()
    while not rospy.is_shutdown():
        keys = read_keys(terminal, max(0.0, min(LOOK_UP, last_sent + period - time.monotonic())))
        now = time.monotonic()
        if CTRL_C in keys:
            return
        forgotten = key_timeout > 0 and now - last_key >= key_timeout and drive.move != STANDING
        for key in keys:
            say(*drive.press(key))
            topic.send(drive)
            last_key = last_sent = now
        if not keys and forgotten:
            drive.move = STANDING
        if not keys and (forgotten or now - last_sent >= period):
            topic.send(drive)
            last_sent = now


def read_number(name: str, default: float) -> float:
    """A private parameter, Hz, s, m/s or rad/s; ends the node with a line where it is none."""
    value = rospy.get_param(f"~{name}", default)
    if isinstance(value, bool) or not isinstance(value, int | float):
        sys.exit(f"teleop_twist_keyboard: {name} is {value!r}, which is not a number; "
                 f"type _{name}:={default}")
    return value


def say(*lines: str) -> None:
    for line in lines:
        print(line, flush=True)


def main() -> None:
    if not sys.stdin.isatty():
        sys.exit("teleop_twist_keyboard: no terminal to read keys from. Type it in a terminal, "
                 "without <, | or & beside it; or use the page's tab Drive: "
                 "roslaunch sim_viewer viewer.launch control:=true")  # fmt: skip
    rospy.init_node("teleop_twist_keyboard", disable_signals=True)
    drive = KeyedSpeeds(read_number("speed", 0.5), read_number("turn", 1.0),
                        read_number("speed_limit", 1000.0), read_number("turn_limit", 1000.0))
    topic = CommandTopic()
    terminal = sys.stdin.fileno()
    try:
        with single_keys(terminal):
            topic.wait_for_subscriber()
            say(HELP, drive.state())
            drive_by_keys(terminal, topic, drive)
    finally:  # a robot may keep its last command: every way out has to pass the zero Twist
        drive.move = STANDING
        topic.send(drive)
        time.sleep(FLUSH_TIME)


if __name__ == "__main__":
    with suppress(KeyboardInterrupt), interruptible():
        main()
