"""A plugin's context: its tags and scope, calls by the loop, and topics that end with it."""

import logging
import math
from collections.abc import Callable
from typing import TypeVar

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from rosgraph.names import is_legal_name

from bullet_sim.description import PluginDescription, SensorDescription, Visual
from bullet_sim.errors import PluginError
from bullet_sim.link import Link
from bullet_sim.model import Model
from bullet_sim.plugin_tags import PluginParameters
from bullet_sim.world import World
from bullet_sim_ros import convert
from bullet_sim_ros.drawing import DrawingThread
from bullet_sim_ros.errors import format_error
from bullet_sim_ros.inputs import Input, Inputs
from bullet_sim_ros.lockstep import Lockstep
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.scheduler import PeriodicTask, Scheduler, always
from bullet_sim_ros.topic_faults import Senders


class PluginHost:
    """Objects shared by all plugins of one simulation."""

    def __init__(self, world: World, mailbox: Mailbox, scheduler: Scheduler, drawing: DrawingThread,
                 lockstep: Lockstep):
        self.world = world
        self.mailbox = mailbox
        self.scheduler = scheduler
        self.drawing = drawing
        self.lockstep = lockstep
        self.senders = Senders()
        self.inputs = Inputs()
        self.warned: set[tuple[str, str]] = set()  # unknown plugins: model, file name
        self._broadcaster: tf2_ros.TransformBroadcaster | None = None

    def announce_transforms(self) -> None:
        """Advertise /tf, so that early subscribers miss nothing."""
        if self._broadcaster is None:
            self._broadcaster = tf2_ros.TransformBroadcaster()

    def send_transforms(self, transforms: list[TransformStamped]) -> None:
        """Publish on /tf, after `announce_transforms`."""
        self._broadcaster.sendTransform(transforms)

    def transforms_wanted(self) -> bool:
        """Whether anybody listens to /tf."""
        return bool(self._broadcaster and self._broadcaster.pub_tf.get_num_connections())


log = logging.getLogger("bullet_sim.plugins")

Part = TypeVar("Part")  # a model, sensor, visual or link


class PluginContext:
    """One plugin's view of the simulation. Made and used in the loop's thread.

    PluginError if a part around it is asked for (`model`, `sensor`, ...) that it is not in.
    """

    def __init__(self, host: PluginHost, model: Model | None,
                 description: PluginDescription, sensor: SensorDescription | None = None,
                 link: Link | None = None, visual: Visual | None = None):
        self.host = host
        self.world = host.world
        self.description = description
        self._model, self._sensor, self._link, self._visual = model, sensor, link, visual
        self.parameters = PluginParameters(model.name if model else "(world)", description)
        self._closers: list[Callable[[], None]] = []
        self._resets: list[Callable[[], None]] = []
        self.closed = False  # whether the plugin has ended; for any thread
        self._task: PeriodicTask | None = None  # that of the last `every`

    @property
    def updates(self) -> int:
        """How often the plugin's last periodic task has run."""
        return self._task.count if self._task else 0

    # --- where it is

    @property
    def model(self) -> Model:
        """The model that the plugin is in; PluginError if it is in the world."""
        return _inside(self._model, "a <model>, not in the world")

    @property
    def kind(self) -> str:
        """What the plugin is in: `visual`, `sensor`, `model` or `world`."""
        if self._visual is not None:
            return "visual"
        if self._sensor is not None:
            return "sensor"
        return "world" if self._model is None else "model"

    @property
    def visual(self) -> Visual:
        """The visual that the plugin is in; PluginError if it is in none."""
        return _inside(self._visual, "a <visual>")

    @property
    def sensor(self) -> SensorDescription:
        """The sensor that the plugin is in; PluginError if it is in none."""
        return _inside(self._sensor, "a <sensor>, not in the model")

    @property
    def link(self) -> Link:
        """The link that the sensor or visual is on; PluginError if the plugin is in none."""
        return _inside(self._link, "a <sensor>, not in the model")

    @property
    def sensor_name(self) -> str:
        """`model::link::sensor`."""
        return f"{self.link.scoped_name}::{self.sensor.name}"

    def describe(self) -> str:
        """Model, sensor or visual, and plugin, for log lines."""
        sensor = f" sensor {self._sensor.name}:" if self._sensor else ""
        if self._visual is not None:
            sensor = f" visual {self._visual.name}:"
        name = self.description.name or "(no name)"
        place = f"model {self._model.name}:" if self._model else \
            f"world {self.world.description.name}:"
        return f"{place}{sensor} plugin {name} ({self.description.filename})"

    # --- when the loop calls

    def every(self, rate_hz: float, action: Callable[[], None],
              wanted: Callable[[], bool] = always, whole_steps: bool = False) -> None:
        """Call `action` at a rate of simulated time, while `wanted` is true; 0: every step.

        `whole_steps` is for plugins that count the period from their last call (see `TickRate`). A
        rate below zero means every step, too (gazebo_ros_diff_drive.cpp, Load).
        """
        scheduler = self.host.scheduler
        self._task = task = scheduler.add(
            max(rate_hz, 0.0), self._guarded(action), wanted, whole_steps)
        self._closers.append(lambda: scheduler.remove(task))

    def change_rate(self, rate_hz: float) -> None:
        """Run the task of the last `every` at another rate from now on."""
        if self._task is not None and not self.closed:
            self.host.scheduler.change_rate(self._task, rate_hz)

    def every_reading(self, rate_hz: float, action: Callable[[], None],
                      wanted: Callable[[], bool] = always) -> None:
        """Call `action` at the sensor's own rate, thinned to `rate_hz`; 0: at each reading.

        Readings are skipped until a period has passed since the last one that was taken, so 100 Hz
        thinned to 30 Hz is 25 Hz (gazebo_ros_imu_sensor.cpp, UpdateChild).
        """
        sensor_rate = self.sensor.update_rate
        if sensor_rate <= 0 or rate_hz <= 0:
            self.every(max(sensor_rate, rate_hz), action, wanted, whole_steps=sensor_rate <= 0)
        else:
            every = max(1, math.ceil(sensor_rate / rate_hz - 1e-9))
            self.every(sensor_rate / every, action, wanted)

    def each_step(self, action: Callable[[], None]) -> None:
        """Call `action` after each single physics step."""
        guarded = self._guarded(action)
        world = self.world
        world.each_step = [*world.each_step, guarded]

        def forget() -> None:
            world.each_step = [other for other in world.each_step if other is not guarded]

        self._closers.append(forget)

    def on_reset(self, action: Callable[[], None]) -> None:
        """Call `action` after reset_simulation."""
        self._resets.append(self._guarded(action))

    def reset(self) -> None:
        """Call the actions of `on_reset`: time is back at the start."""
        for action in self._resets:
            action()

    def _guarded(self, action: Callable[[], None]) -> Callable[[], None]:
        def run() -> None:
            if self.closed:
                return
            try:
                action()
            except Exception as error:  # a plugin's failure must not end the simulation
                log.error("%s failed and is switched off: %s", self.describe(), format_error(error))
                self.close()
        return run

    # --- ROS

    def advertise(self, topic: str, kind: type, **options) -> rospy.Publisher:
        """A publisher that ends with the plugin; PluginError if the topic's name is illegal."""
        publisher = rospy.Publisher(_legal(topic), kind, **options)
        self._closers.append(publisher.unregister)
        return publisher

    def subscribe(self, topic: str, kind: type, take: Callable, **options) -> rospy.Subscriber:
        """A subscriber; `take(message)` returns a function for the loop to call, or None.

        PluginError if the topic's name is illegal.
        """
        lockstep = self.host.lockstep
        resolved = rospy.resolve_name(_legal(topic))
        answers = resolved in lockstep.topics
        number = self.host.inputs.add(resolved, kind, take)
        self._closers.append(lambda: self.host.inputs.remove(resolved, number))

        def receive(message) -> None:
            self.host.senders.note(resolved, message)
            function = take(message)
            if function is not None:
                self.host.mailbox.post(function, Input(resolved, number, message))
            if answers:
                lockstep.receive(resolved, self)

        if answers:
            lockstep.subscribe(resolved, self)
            self._closers.append(lambda: lockstep.unsubscribe(resolved, self))
        subscriber = rospy.Subscriber(_legal(topic), kind, receive, **options)
        self._closers.append(subscriber.unregister)
        return subscriber

    def refuses(self, what: str, *messages) -> bool:
        """Whether numbers in these messages are not finite or far too large; if so, logs a warning.
        """
        if convert.is_sane(*messages):
            return False
        log.warning("%s: a %s that is not finite, or beyond %g, is ignored", self.describe(), what,
                    convert.LARGEST)
        return True

    def serve(self, name: str, kind: type, handler: Callable) -> None:
        """Advertise a service; a name that is taken is a warning.

        PluginError if the name is illegal.
        """
        def answer(request):
            self.host.mailbox.announce(rospy.resolve_name(name), request)
            return handler(request)

        try:
            service = rospy.Service(_legal(name), kind, answer)
        except rospy.ServiceException as error:
            log.warning("%s: service %s is not offered: %s", self.describe(), name, error)
            return
        self._closers.append(lambda: service.shutdown("the model was deleted"))

    def on_close(self, action: Callable[[], None]) -> None:
        """Call `action` when the plugin ends, before the topics opened so far are closed."""
        self._closers.append(action)

    def close(self) -> None:
        """End all topics and services of the plugin."""
        self.closed = True
        self.host.lockstep.cancel(self)
        while self._closers:
            self._closers.pop()()
        # These are reference cycles: the plugin's arrays would wait for the garbage collector.
        self._task = None
        self._resets.clear()


def _legal(name: str) -> str:
    if not is_legal_name(name):
        raise PluginError(f"{name!r} is not a legal topic name: letters, digits, _ and / only")
    return name


def _inside(part: Part | None, what: str) -> Part:
    if part is None:
        raise PluginError(f"it belongs inside {what}")
    return part
