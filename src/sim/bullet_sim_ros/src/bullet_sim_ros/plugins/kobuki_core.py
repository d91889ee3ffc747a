"""What a Kobuki base reports of its sensors 50 times a second: one message with all of them."""

import math
from collections.abc import Collection, Sequence

from kobuki_msgs.msg import SensorState

from bullet_sim.drives.kobuki import Kobuki
from bullet_sim_ros import convert, names
from bullet_sim_ros.plugin_host import PluginContext
from bullet_sim_ros.plugins.kobuki_events import BumperTopic, CliffTopic, WheelDropTopic

TICKS = 2578.33 / math.tau  # of a wheel's encoder, a rad: 52 a turn of the motor, geared
BATTERY = 165  # 0.1 V: full, and simulated ones stay so
BITS = {"right": SensorState.BUMPER_RIGHT, "center": SensorState.BUMPER_CENTRE,
        "left": SensorState.BUMPER_LEFT}  # those of the cliff sensors, too
WHEEL_BITS = {"right": SensorState.WHEEL_DROP_RIGHT, "left": SensorState.WHEEL_DROP_LEFT}
WORD = 0xFFFF


class CoreTopic:
    """`sensors/core`. Currents, duty cycles, buttons and inputs are not simulated: they are 0."""

    def __init__(self, context: PluginContext, base: str, kobuki: Kobuki, bumper: BumperTopic,
                 cliffs: Sequence[CliffTopic], drop: WheelDropTopic):
        self._context, self._kobuki = context, kobuki
        self._bumper, self._drop = bumper, drop
        self._cliffs = {cliff.side: cliff for cliff in cliffs}
        self._topic = context.advertise(names.join(base, "sensors/core"), SensorState, queue_size=1)

    def wanted(self) -> int:
        """Whether anybody listens: contacts and rays cost time."""
        return self._topic.get_num_connections()

    def publish(self) -> None:
        """After a step."""
        time = self._context.world.time
        cliffs = {side: self._cliffs[side].read() for side in BITS}
        left, right = (int(joint.position * TICKS) & WORD for joint in self._kobuki.wheels)
        msg = SensorState(
            time_stamp=round(time * 1000) & WORD, bumper=_bits(self._bumper.pressed(), BITS),
            wheel_drop=_bits(self._drop.dropped(), WHEEL_BITS),
            cliff=_bits([side for side, (cliff, _) in cliffs.items() if cliff], BITS),
            left_encoder=left, right_encoder=right, charger=SensorState.DISCHARGING,
            battery=BATTERY, bottom=[reading for _, reading in cliffs.values()],
            current=[0, 0], analog_input=[0, 0, 0, 0])
        self._topic.publish(convert.stamped(msg, time))


def _bits(sides: Collection[str], bits: dict[str, int]) -> int:
    return sum(bit for side, bit in bits.items() if side in sides)
