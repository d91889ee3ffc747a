"""libgazebo_ros_tricycle_drive.so: speed and steering angle in; odometry, tf, joint states out."""

from geometry_msgs.msg import Twist
from sensor_msgs.msg import JointState

from bullet_sim.drives.tricycle import Tricycle, TricycleParameters
from bullet_sim.joint import Joint
from bullet_sim.plugin_tags import LoggedParameters
from bullet_sim.sensors.joint_states import sample_joints
from bullet_sim.sensors.odometry import WheelOdometry
from bullet_sim_ros import convert, names, params
from bullet_sim_ros.plugin_host import PluginContext, open_odometry, plugin, subscribe_commands
from bullet_sim_ros.plugin_host.drive_topics import OdometrySource, wheel_transform


@plugin("libgazebo_ros_tricycle_drive.so")
class TricycleDrivePlugin:
    """Encoder odometry turns left when the robot does, and braking slows the robot down.

    gazebo_ros_tricycle_drive.cpp, UpdateOdometryEncoder and motorController, have both the other
    way round. A reset of the simulation stops the robot and sets the encoders to zero; the original
    has no Reset, so the robot drives on.
    """

    def __init__(self, context: PluginContext):
        self._context = context
        name = context.model.name
        namespace = context.parameters.namespace(missing=name, empty=name)
        p = LoggedParameters(context.parameters, "TricycleDrive", namespace)
        self._joints = self._find_joints(p)
        acceleration = p.number("wheelAcceleration", 0.0)
        self._torque = p.number("wheelTorque", 5.0)
        self._drive = Tricycle(*self._joints[:2], TricycleParameters(
            p.number("actuatedWheelDiameter", 0.15), self._torque, acceleration,
            p.number("wheelDeceleration", acceleration), p.number("wheelSpeedTolerance", 0.01),
            p.number("steeringSpeed", 0.0), p.number("steeringAngleTolerance", 0.01)))
        self._odometry_source = OdometrySource(context, p, self._joints[2:], WheelOdometry(
            p.number("encoderWheelSeparation", 0.5), p.number("encoderWheelDiameter", 0.15),
            signed=True))
        self._updated = context.world.time
        self._wheel_tf = p.flag("publishWheelTF", False)
        self._states = context.advertise(
            names.join(namespace, "joint_states"), JointState, queue_size=1000,
        ) if p.flag("publishWheelJointState", False) else None
        self._prefix = params.tf_prefix(namespace)
        self._output = open_odometry(context, namespace, "base_link")
        subscribe_commands(context, namespace, p.text("commandTopic", "cmd_vel"), self._command)
        context.every(p.number("updateRate", 100.0), self._update)
        context.on_reset(self._restart)

    def _find_joints(self, p: LoggedParameters) -> list[Joint]:
        """Steering, driven wheel, left and right encoder."""
        return [self._context.model.joint(p.text(tag, name)) for tag, name in (
            ("steeringJoint", "front_steering_joint"), ("actuatedWheelJoint", "front_wheel_joint"),
            ("encoderWheelLeftJoint", "left_wheel_joint"),
            ("encoderWheelRightJoint", "right_wheel_joint"))]

    def _command(self, msg: Twist) -> None:
        self._drive.command(msg.linear.x, msg.angular.z)

    def _update(self) -> None:
        world = self._context.world
        if self._output.wanted():
            # publishWheelTF names the wheels' frames after the joints.
            wheels = self._joints if self._wheel_tf else ()
            self._output.publish(self._odometry_source.sample(), [
                wheel_transform(self._context.model, joint, world.time, self._prefix, joint.name)
                for joint in wheels])
        if self._states and self._states.get_num_connections():
            self._publish_states()
        self._drive.update(world.time - self._updated)
        self._updated = world.time

    def _publish_states(self) -> None:
        msg = convert.joints_to_msg(sample_joints(self._context.world, self._joints))
        # The motors' limits, as in publishWheelJointState.
        msg.effort = [self._torque, self._torque, 0.0, 0.0]
        self._states.publish(msg)

    def _restart(self) -> None:
        self._drive.stop()
        self._odometry_source.restart()
        self._updated = self._context.world.time
