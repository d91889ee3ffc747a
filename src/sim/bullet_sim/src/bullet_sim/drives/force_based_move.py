"""A model pushed in the plane: the force is the velocity error times a gain."""

from dataclasses import dataclass

from bullet_sim.control.controllers.mobile_base import PlanarOdometry
from bullet_sim.link import Link
from bullet_sim.physics.auto_disable import REST_RATE, REST_SPEED
from bullet_sim.pose import rotate
from bullet_sim.sensors.odometry import OdometryReading
from bullet_sim.twist import twist_in
from bullet_sim.world import World


@dataclass(frozen=True)
class ForceGains:
    """Gains of the velocity error; defaults as in hector's gazebo_ros_force_based_move.cpp."""

    forward: float = 10000.0  # N per m/s
    leftward: float = 10000.0  # N per m/s
    yaw: float = 100.0  # N m per rad/s


class ForceDrive:
    """Call `update` at each step. The link's centre of mass is pushed.

    F = gain * (wanted - measured), forward and leftward in the link's axes, and the same for a
    torque about the world's vertical axis: as hector's force_based_move and its copies.
    """

    def __init__(self, world: World, link: Link, gains: ForceGains, timeout: float):
        """`timeout` (s) is how long a command is valid; infinite: until the next one."""
        self._world, self._link, self._gains = world, link, gains
        self._timeout = timeout
        self.reset()

    def command(self, forward: float, leftward: float, yaw_rate: float) -> None:
        """Set the wanted speeds (m/s) in the model's heading and the yaw rate (rad/s)."""
        self._wanted = (forward, leftward, yaw_rate)
        self._commanded = self._world.time

    def reset(self) -> None:
        """Stand still; odometry starts at zero."""
        self._wanted = (0.0, 0.0, 0.0)
        self._commanded = self._world.time
        self._odometry = PlanarOdometry(window=1)
        self._odometry.restart(self._world.time)
        self._counted = self._world.time

    def update(self) -> None:
        """Update the odometry with the last step, then push."""
        time = self._world.time
        elapsed, self._counted = time - self._counted, time
        if time - self._commanded > self._timeout:
            self._wanted = (0.0, 0.0, 0.0)
        model = self._link.model
        own = twist_in(model.pose, model.twist)
        forward, leftward, _ = own.linear
        self._odometry.move(time, forward * elapsed, leftward * elapsed, own.angular[2] * elapsed)
        turning = model.twist.angular[2]
        if not any(self._wanted) and abs(turning) < REST_RATE and max(
                map(abs, own.linear)) < REST_SPEED:
            return  # so that a world where nothing moves can come to rest
        g = self._gains
        push = (g.forward * (self._wanted[0] - forward), g.leftward * (self._wanted[1] - leftward),
                0.0)
        self._link.apply_force(rotate(self._link.pose.orientation, push),
                               (0.0, 0.0, g.yaw * (self._wanted[2] - turning)))

    def odometry(self) -> OdometryReading:
        """The motion since it was spawned."""
        return self._odometry.sample()
