"""The simulated world together with its ROS side, and the loop that drives both."""

from __future__ import annotations

import rospy
from rosgraph_msgs.msg import Clock

from bullet_sim.description import ModelDescription
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.rendering.renderer import Renderer, open_renderer
from bullet_sim.schedule import Schedule
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.pacer import Pacer
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.plugins import load_plugins
from bullet_sim_ros.plugins.host import Shared
from bullet_sim_ros.plugins.registry import Loaded
from bullet_sim_ros.state_topics import StateTopics

IDLE = 0.02  # s, wall: how long to wait for a call while paused


class Simulation:
    """Owned by the loop's thread; other threads reach it through the mailbox."""

    def __init__(self, world: World, parameters: NodeParameters):
        self.world = world
        self.mailbox = Mailbox()
        self.pacer = Pacer()
        self.set_pace()
        self._told_to_stop = False
        self._renderer: Renderer | None = None
        self._shared = Shared(world, self.mailbox, self._open_renderer)
        self._plugins: dict[str, list[Loaded]] = {}
        self._clock = rospy.Publisher(names.CLOCK, Clock, queue_size=10)
        self._clock_schedule = Schedule(parameters.pub_clock_frequency, world.timestep)
        self._states = StateTopics(self, parameters) if parameters.enable_ros_network else None
        for model in world.models.values():
            self._load_plugins(model)

    # --- the loop

    def run(self, iterations: int = 0) -> None:
        """Step until told to stop or ROS shuts down, or for so many steps."""
        self._publish_clock()
        steps = 0
        while not self._told_to_stop and not rospy.is_shutdown():
            self.mailbox.run_pending(IDLE if self.world.paused else 0.0)
            if self.world.paused:
                self.pacer.restart()
                continue
            self._step()
            self.pacer.wait(self.world.time)
            steps += 1
            if steps == iterations:
                break

    def stop(self) -> None:
        """From a signal handler: end the loop after this step."""
        self._told_to_stop = True

    def _step(self) -> None:
        self.world.step()
        if self._clock_schedule.due(self.world.tick):
            self._publish_clock()
        if self._states:
            self._states.update()
        for name, plugins in self._plugins.items():
            for plugin in plugins:
                if not plugin.update():
                    self._plugins[name] = [other for other in plugins if other is not plugin]

    def _publish_clock(self) -> None:
        now = convert.stamp(self.world.time)
        # This node needs no /clock: it tells rospy the time directly, for its log stamps.
        rospy.rostime._set_rostime(now)
        self._clock.publish(Clock(now))

    def set_pace(self) -> None:
        """Real-time factor as the world's physics says: step times real_time_update_rate."""
        physics = self.world.description.physics
        self.pacer.factor = physics.max_step_size * physics.real_time_update_rate
        self.pacer.restart()

    # --- contents

    def spawn(self, description: ModelDescription, pose: Pose, name: str) -> Model:
        """Put a model in and load its plugins."""
        model = self.world.spawn(description, pose, name)
        self._load_plugins(model)
        return model

    def delete(self, name: str) -> None:
        """Take a model out; its topics disappear."""
        self.world.delete(name)
        for plugin in self._plugins.pop(name, ()):
            plugin.close()

    def reset(self) -> None:
        """Time and models back to the start; plugins are told."""
        self.world.reset_simulation()
        for name, plugins in self._plugins.items():
            self._plugins[name] = [plugin for plugin in plugins if plugin.reset()]
        self._publish_clock()
        self.pacer.restart()

    def close(self) -> None:
        """Answer whoever still waits; let go of renderer and engine."""
        self.mailbox.close()
        if self._renderer:
            self._renderer.close()
        self.world.close()

    def _load_plugins(self, model: Model) -> None:
        self._plugins[model.name] = load_plugins(self._shared, model)

    def _open_renderer(self) -> Renderer:
        if self._renderer is None:
            self._renderer = open_renderer()
            rospy.loginfo("Cameras are drawn by %s", self._renderer.name)
        return self._renderer
