"""What a plugin is given: its tags, its model, and ROS topics that are closed together."""

from __future__ import annotations

import logging
import math
from collections.abc import Callable
from concurrent.futures import Future

import rospy
import tf2_ros
from geometry_msgs.msg import TransformStamped
from rosgraph.names import is_legal_name

from bullet_sim.description import PluginDescription, SensorDescription, Visual
from bullet_sim.model import Link, Model
from bullet_sim.world import World
from bullet_sim_ros.agenda import Agenda, Duty, always
from bullet_sim_ros.drawing import DrawingThread
from bullet_sim_ros.errors import PluginError, told
from bullet_sim_ros.lockstep import Lockstep
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.plugins.parameters import PluginParameters

log = logging.getLogger("bullet_sim.plugins")


class Shared:
    """What all plugins of one simulation use together."""

    def __init__(self, world: World, mailbox: Mailbox, agenda: Agenda, drawing: DrawingThread,
                 lockstep: Lockstep):
        self.world = world
        self.mailbox = mailbox
        self.agenda = agenda
        self.drawing = drawing
        self.lockstep = lockstep
        self.warned: set[tuple[str, str]] = set()  # unknown plugins: where they are, file name
        self._broadcaster: tf2_ros.TransformBroadcaster | None = None

    def announce_transforms(self) -> None:
        """Make /tf known, so that who is there before time begins misses nothing."""
        if self._broadcaster is None:
            self._broadcaster = tf2_ros.TransformBroadcaster()

    def send_transforms(self, transforms: list[TransformStamped]) -> None:
        """Publish on /tf, after `announce_transforms`."""
        self._broadcaster.sendTransform(transforms)

    def transforms_wanted(self) -> bool:
        """Whether anybody listens to /tf."""
        return bool(self._broadcaster and self._broadcaster.pub_tf.get_num_connections())


class Host:
    """One plugin's view of the simulation. Made and used in the loop's thread."""

    def __init__(self, shared: Shared, model: Model | None, description: PluginDescription,
                 sensor: SensorDescription | None = None, link: Link | None = None,
                 visual: Visual | None = None):
        self.shared = shared
        self.world = shared.world
        self.description = description
        self.parameters = PluginParameters(model.name if model else "(world)", description)
        self._model = model
        self._sensor = sensor
        self._link = link
        self._visual = visual
        self._closers: list[Callable[[], None]] = []
        self._resets: list[Callable[[], None]] = []
        self._drawn: Future | None = None
        self._closed = False
        self._expects_answers = False
        self._duty: Duty | None = None  # the last that `every` was asked for

    @property
    def model(self) -> Model:
        """The model that the plugin is in."""
        if self._model is None:
            raise PluginError("it belongs inside a <model>, not in the world")
        return self._model

    @property
    def in_world(self) -> bool:
        """Whether the plugin is in the world itself."""
        return self._model is None

    @property
    def has_sensor(self) -> bool:
        """Whether the plugin is in a sensor."""
        return self._sensor is not None

    @property
    def in_visual(self) -> bool:
        """Whether the plugin is in a visual."""
        return self._visual is not None

    @property
    def visual(self) -> Visual:
        """The visual that the plugin is in; `link` is the one that it is on."""
        if self._visual is None:
            raise PluginError("it belongs inside a <visual>")
        return self._visual

    @property
    def updates(self) -> int:
        """How often the plugin has done what it does at a rate."""
        return self._duty.count if self._duty else 0

    @property
    def sensor(self) -> SensorDescription:
        """The sensor that the plugin is in."""
        if self._sensor is None:
            raise PluginError("it belongs inside a <sensor>, not in the model")
        return self._sensor

    @property
    def link(self) -> Link:
        """The link that the sensor is on."""
        if self._link is None:
            raise PluginError("it belongs inside a <sensor>, not in the model")
        return self._link

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
        """Call `action` at a rate of simulated time, while `wanted` says so; 0: every step.

        `whole_steps` is for plugins that count the period from the last time (see `Schedule`). As
        upstream has it, a rate below zero is none, too.
        """
        agenda = self.shared.agenda
        self._duty = duty = agenda.add(
            max(rate_hz, 0.0), self._guarded(action), wanted, whole_steps)
        self._closers.append(lambda: agenda.remove(duty))

    def change_rate(self, rate_hz: float) -> None:
        """Do what `every` was last asked for at another rate, from now on."""
        if self._duty is not None and not self._closed:
            self.shared.agenda.change_rate(self._duty, rate_hz)

    def every_reading(self, rate_hz: float, action: Callable[[], None],
                      wanted: Callable[[], bool] = always) -> None:
        """Call `action` at the sensor's own rate, thinned to `rate_hz`; 0: at each reading.

        As upstream has it, a reading is left out until so much time has gone by since the last one
        that was taken, so 100 Hz thinned to 30 Hz is 25 Hz.
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
        """Time is back at the start."""
        for action in self._resets:
            action()

    def draw(self, job: Callable[[], None]) -> None:
        """Have `job` done by the drawing thread; first waits for this plugin's job before it.

        What that one failed with is raised here. In lockstep the world waits for the picture anyway
        and the job is done at once.
        """
        if self.shared.lockstep.topics:
            self.shared.drawing.settle()  # the renderer does one thing at a time
            job()
            return
        if self._drawn is not None and not self._drawn.done():
            with self.world.stages.measure("wait"):
                self._drawn.exception()
        if self._drawn is not None:
            self._drawn.result()
        self._drawn = self.shared.drawing.submit(job)

    def expect_answer(self) -> None:
        """A frame is about to go to somebody: in lockstep the world then waits for the answer."""
        self._expects_answers = True
        self.shared.lockstep.expect()

    def _guarded(self, action: Callable[[], None]) -> Callable[[], None]:
        def run() -> None:
            if self._closed:
                return
            try:
                action()
            except Exception as error:  # a plugin's fault must not take the simulation with it
                log.error("%s failed and is switched off: %s", self.describe(), told(error))
                self.close()
        return run

    # --- ROS

    def advertise(self, topic: str, kind: type, **options) -> rospy.Publisher:
        """A publisher that lives as long as the plugin."""
        publisher = rospy.Publisher(_legal(topic), kind, **options)
        self._closers.append(publisher.unregister)
        return publisher

    def subscribe(self, topic: str, kind: type, take: Callable, **options) -> rospy.Subscriber:
        """A subscriber; `take(message)` returns what the loop is to do, or None."""
        lockstep = self.shared.lockstep
        resolved = rospy.resolve_name(_legal(topic))
        answers = resolved in lockstep.topics

        def leave(message) -> None:
            function = take(message)
            if function is not None:
                self.shared.mailbox.leave(function)
            if answers:
                lockstep.hear(resolved, self)

        if answers:
            lockstep.join(resolved, self)
            self._closers.append(lambda: lockstep.leave(resolved, self))
        subscriber = rospy.Subscriber(_legal(topic), kind, leave, **options)
        self._closers.append(subscriber.unregister)
        return subscriber

    def serve(self, name: str, kind: type, handler: Callable) -> None:
        """A service; a name that is taken is a warning, as upstream has it."""
        try:
            service = rospy.Service(_legal(name), kind, handler)
        except rospy.ServiceException as error:
            log.warning("%s: service %s is not offered: %s", self.describe(), name, error)
            return
        self._closers.append(lambda: service.shutdown("the model was deleted"))

    def on_close(self, action: Callable[[], None]) -> None:
        """Call `action` when the plugin ends, before the topics that it has now are closed."""
        self._closers.append(action)

    def close(self) -> None:
        """End all topics and services of the plugin."""
        self._closed = True
        if self._expects_answers:
            self.shared.lockstep.cancel()
        if self._drawn is not None:
            self._drawn.exception()  # waits: its topics are still needed
        while self._closers:
            self._closers.pop()()


def _legal(name: str) -> str:
    if not is_legal_name(name):
        raise PluginError(f"{name!r} is no legal topic name: letters, digits, _ and / only")
    return name
