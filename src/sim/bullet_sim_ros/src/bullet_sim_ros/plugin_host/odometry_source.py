"""The source of a drive's odometry, by its tag `<odometrySource>`."""

from collections.abc import Sequence

from bullet_sim.joint import Joint
from bullet_sim.sensors.odometry import OdometryReading, WheelOdometry, true_odometry
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.logged_parameters import LoggedParameters


class OdometrySource:
    """The true pose (`world`), or the rotation of a left and a right wheel (`encoder`)."""

    def __init__(self, context: PluginContext, p: LoggedParameters, wheels: Sequence[Joint],
                 encoders: WheelOdometry):
        self._world, self._model = context.world, context.model
        self._left, self._right = wheels
        self._encoders = encoders
        self._true = p.choice("odometrySource", ("world", "encoder")) == "world"
        if not self._true:
            context.each_step(self._count)

    def sample(self) -> OdometryReading:
        """Pose and twist now."""
        if self._true:
            return true_odometry(self._world, self._model)
        return self._encoders.sample()

    def restart(self) -> None:
        """Set the encoders to zero."""
        self._encoders.restart(self._world.time)

    def _count(self) -> None:
        self._encoders.update(self._world.time, self._left.velocity, self._right.velocity)
