"""libgazebo_ros_control.so: a model's joints behind ros_control, with a controller manager."""

import logging
import math
from xml.etree.ElementTree import Element, fromstring

import rospy
from std_msgs.msg import Bool

from bullet_sim.control.hardware import RobotHardware, open_hardware
from bullet_sim.control.steer_bot import open_steer_bot
from bullet_sim.errors import SimulationError
from bullet_sim.formats.urdf.facts import RobotFacts
from bullet_sim.formats.urdf.transmission import read_transmissions
from bullet_sim.formats.xml_values import parse_xml
from bullet_sim_ros import names, params
from bullet_sim_ros.control import controllers, services  # noqa: F401  (controllers register)
from bullet_sim_ros.control.controller_context import ControllerContext
from bullet_sim_ros.control.manager import ControllerManager
from bullet_sim_ros.control.urdf_parameter import with_urdf
from bullet_sim_ros.plugin_host import PluginContext, plugin

log = logging.getLogger("bullet_sim.control")

SIMULATION_TYPES = ("gazebo_ros_control/DefaultRobotHWSim", "DefaultRobotHWSim",
                    "steer_bot_hardware_gazebo/SteerBotHardwareGazebo", "SteerBotHardwareGazebo")
ROUNDING = 1e-9  # of a step
NO_ROBOT = fromstring('<robot name="nobody"><link name="nobody"/></robot>')
MOST_STEPS = 1e15  # of a control period: practically for ever


@plugin("libgazebo_ros_control.so")
class RosControlPlugin:
    """Waits for the robot's URDF; from then on it reads, updates and writes at each step."""

    def __init__(self, context: PluginContext):
        rospy.loginfo("Loading gazebo_ros_control plugin")
        p = context.parameters
        self._context = context
        self._namespace = names.join(p.namespace(missing=context.model.name, empty="/"), "")
        simulation_type = p.text("robotSimType", SIMULATION_TYPES[0])
        if simulation_type not in SIMULATION_TYPES:
            log.warning("%s: <robotSimType> is %r; there are: %s and %s; the first is used",
                        context.describe(), simulation_type, *SIMULATION_TYPES[::2])
        self._steer_bot = simulation_type in SIMULATION_TYPES[2:]
        self._control_period = p.number("controlPeriod", 0.0)  # s; 0: every step
        self._emergency = self._restart = False
        self._emergency_topic = p.text("eStopTopic")
        self._set_period()
        self._check_period()
        rospy.loginfo("Starting gazebo_ros_control plugin in namespace: %s", self._namespace)
        self._robot_parameter = p.text("robotParam", "robot_description")
        with_urdf(context, self._namespace, self._robot_parameter, self._begin)

    def _set_period(self) -> None:
        """Count the control period in steps, from now."""
        self._timestep = self._context.world.timestep
        steps = min(self._control_period / self._timestep, MOST_STEPS)
        self._steps = max(1, math.ceil(steps - ROUNDING))
        self._updated = self._context.world.tick

    def _check_period(self) -> None:
        wanted, step = self._control_period, self._timestep
        if not wanted or abs(wanted - step) < ROUNDING * step:
            return
        write, how = (log.error, "faster") if wanted < step else (log.warning, "slower")
        write("%s: Desired controller update period (%g s) is %s than the gazebo simulation period "
            "(%g s).", self._context.describe(), wanted, how, step)

    def _begin(self, urdf: str) -> None:
        try:
            self._hardware, robot = self._open_hardware(urdf)
        except SimulationError as error:
            log.critical("%s: Could not initialize robot simulation interface: %s",
                         self._context.describe(), error)
            return
        context, namespace = self._context, self._namespace

        def open_context(name: str) -> ControllerContext:
            own = PluginContext(context.host, context.model, context.description)
            return ControllerContext(own, name, namespace, self._hardware, robot)

        self._manager = ControllerManager(open_context, rospy.is_shutdown)
        context.on_close(self._manager.close)
        services.offer(context, self._manager, namespace)
        if self._emergency_topic:
            topic = names.join(names.join(context.model.name, ""), self._emergency_topic)
            context.subscribe(topic, Bool, lambda msg: lambda: self._stop(msg.data), queue_size=1)
        context.on_reset(self._reset)
        self._set_period()
        context.each_step(self._step)
        rospy.loginfo("Loaded gazebo_ros_control.")

    def _open_hardware(self, urdf: str) -> tuple[RobotHardware, RobotFacts]:
        element = self._urdf(urdf)
        robot = RobotFacts(element)
        parameters = params.of_controllers(self._namespace)
        if self._steer_bot:
            return open_steer_bot(self._context.model, robot, parameters), robot
        transmissions = read_transmissions(element)
        if not transmissions and element is not NO_ROBOT:
            log.warning("%s: the URDF has no usable <transmission>, so there is no joint to "
                        "control", self._context.describe())
        return open_hardware(self._context.model, robot, transmissions, parameters), robot

    def _urdf(self, text: str) -> Element:
        """The `<robot>`; one without joints if the text is an SDF or empty."""
        element = parse_xml(text, "the URDF parameter") if text.strip() else None
        if element is not None and element.tag == "robot":
            return element
        found = "nothing" if element is None else f"a <{element.tag}>"
        log.warning("%s: its parameter %s holds %s, not a URDF's <robot>: the controller manager "
                    "starts, but there is no joint to control", self._context.describe(),
                    self._robot_parameter, found)
        return NO_ROBOT

    # --- in the loop

    def _step(self) -> None:
        world = self._context.world
        if world.timestep != self._timestep:
            self._set_period()
        elapsed = world.tick - self._updated
        if elapsed >= self._steps:
            self._updated = world.tick
            self._hardware.read()
            self._manager.update(world.time, elapsed * self._timestep, self._restart)
            self._restart = False
        self._hardware.write(self._timestep)

    def _stop(self, on: bool) -> None:
        """Emergency stop; when it is released, running controllers are restarted."""
        self._restart = self._restart or (self._emergency and not on)
        self._emergency = on
        self._hardware.stop(on)

    def _reset(self) -> None:
        self._updated = self._context.world.tick
        self._hardware.reset()
