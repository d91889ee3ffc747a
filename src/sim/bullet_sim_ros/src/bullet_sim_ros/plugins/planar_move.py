"""libgazebo_ros_planar_move.so: cmd_vel moves the model as a whole; odometry and tf out."""

from geometry_msgs.msg import Twist

from bullet_sim.drives.planar import PlanarDrive, PlanarOdometry
from bullet_sim_ros.plugin_host import PluginContext, open_odometry, plugin, subscribe_commands


@plugin("libgazebo_ros_planar_move.so")
class PlanarMovePlugin:
    """A reset of the simulation stops the model.

    gazebo_ros_planar_move.cpp has no Reset: the model drives on, and nothing is published until
    simulated time has reached its old value.
    """

    def __init__(self, context: PluginContext):
        p = context.parameters
        self._context = context
        namespace = p.namespace(missing="/", empty="/")
        self._drive = PlanarDrive(context.model)
        self._odometry = PlanarOdometry(context.world, context.model)
        self._timeout = p.number("cmdTimeout", -1.0)  # s; below 0: never
        self._commanded = context.world.time
        self._output = open_odometry(context, namespace, flat=True)
        subscribe_commands(context, namespace, p.text("commandTopic", "cmd_vel"), self._command)
        context.each_step(self._move)
        rate_hz = p.number("odometryRate", 20.0)
        if rate_hz > 0:
            context.every(self._quantised(rate_hz), self._publish, self._output.wanted)
        context.on_reset(self._restart)

    def _quantised(self, rate_hz: float) -> float:
        """The rate that results, Hz: UpdateChild waits for more than the period, then restarts."""
        timestep = self._context.world.timestep
        steps = int(1.0 / (rate_hz * timestep) + 1e-6) + 1
        return 1.0 / (steps * timestep)

    def _command(self, msg: Twist) -> None:
        self._commanded = self._context.world.time
        self._drive.command(msg.linear.x, msg.linear.y, msg.angular.z)

    def _move(self) -> None:
        if 0 <= self._timeout < self._context.world.time - self._commanded:
            self._drive.stop()
        self._drive.update()

    def _publish(self) -> None:
        self._output.publish(self._odometry.sample())

    def _restart(self) -> None:
        self._drive.stop()
        self._odometry.restart()
        self._commanded = self._context.world.time
