"""The simulated world together with its ROS side: what the loop (`loop.py`) drives."""

from collections import Counter
from collections.abc import Callable

import rospy
from rosgraph_msgs.msg import Clock

from bullet_sim.description import ModelDescription
from bullet_sim.formats.resources import Resources
from bullet_sim.model import Model
from bullet_sim.pose import Pose
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.drawing import DrawingThread
from bullet_sim_ros.lockstep import Lockstep
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.plugin_host.context import PluginContext, PluginHost
from bullet_sim_ros.plugin_host.registry import load_plugins, load_world_plugins
from bullet_sim_ros.real_time_factor import RealTimeFactorMonitor
from bullet_sim_ros.rospy_patches import admit_subscribers, set_time
from bullet_sim_ros.scheduler import Pacer, Scheduler


class Simulation:
    """Owned by the loop's thread; other threads reach it through the mailbox."""

    def __init__(self, world: World, parameters: NodeParameters, resources: Resources):
        self.world = world
        self.resources = resources  # the files of models that are spawned
        self.mailbox = Mailbox()
        self.scheduler = Scheduler(world)
        self.pacer = Pacer()
        self.real_time_factor = RealTimeFactorMonitor(world.profiler, parameters.profile)
        self._stop_requested = False
        self._drawing = DrawingThread(world.profiler)
        self.lockstep = Lockstep(parameters.lockstep, parameters.lockstep_timeout, self.mailbox,
                                 parameters.lockstep_sensor)
        if self.lockstep.endless:
            admit_subscribers("sensor_msgs/", self.lockstep.admit)
        self._host = PluginHost(
            world, self.mailbox, self.scheduler, self._drawing, self.lockstep
        )
        self.senders, self.inputs = self._host.senders, self._host.inputs
        self._plugins: dict[str, list[PluginContext]] = {}
        world.each_removal.append(self._close_plugins)
        self._clock = rospy.Publisher(names.CLOCK, Clock, queue_size=10)
        self.scheduler.add(parameters.pub_clock_frequency, self.publish_clock)
        self.set_pace()
        self.each_turn: list[Callable[[], None]] = []  # called by the loop, paused or not
        self.at_close: list[Callable[[], None]] = []  # called when the loop has ended
        self.state_calls: Counter[str] = Counter()  # get_model_state calls by model: header.seq
        for model in world.models.values():
            self._load_plugins(model)
        self._world_plugins = load_world_plugins(self._host)
        self.lockstep.listen()

    # --- for the loop

    def stop(self) -> None:
        """End the loop soon; may be called by a signal handler."""
        self._stop_requested = True

    def stopped(self) -> bool:
        """Whether the loop is to end."""
        return self._stop_requested or rospy.is_shutdown()

    def due(self) -> float:
        """Simulated time, s, of the next scheduled task."""
        return self.scheduler.next_tick() * self.world.timestep

    def publish_clock(self) -> None:
        """Publish the simulated time, which this process's log lines have, too."""
        now = convert.stamp(self.world.time)
        set_time(now)
        self._clock.publish(Clock(now))

    # --- pace

    def set_pace(self) -> None:
        """Set the real-time factor to the world's step size times real_time_update_rate."""
        physics = self.world.description.physics
        self.pacer.factor = physics.max_step_size * physics.real_time_update_rate
        self.scheduler.set_pace(self.pacer.factor)
        self.restart_pace()

    def configure_physics(self, **changes) -> None:
        """Change the world's physics; rates and pace follow the new step."""
        self.world.configure_physics(**changes)
        self.scheduler.restart()
        self.set_pace()

    def restart_pace(self) -> None:
        """Count wall time from here: after a pause, a reset or a change of pace."""
        self.pacer.restart()
        self.real_time_factor.restart(self.world.time)

    # --- contents

    def spawn(self, description: ModelDescription, pose: Pose, name: str) -> Model:
        """Add a model and load its plugins."""
        model = self.world.spawn(description, pose, name)
        try:
            self._load_plugins(model)
        except Exception:
            self.world.delete(name)
            raise
        self.lockstep.listen()
        return model

    def delete(self, name: str) -> None:
        """Delete a model; its topics disappear."""
        self.world.delete(name)
        self.lockstep.listen()

    def reset(self) -> None:
        """Set time and models back to the start; reset the plugins."""
        self._drawing.settle()  # so that no image from before the reset is published after it
        self.lockstep.cancel()
        self.world.reset_simulation()
        self.scheduler.restart()
        for contexts in (*self._plugins.values(), self._world_plugins):
            for context in contexts:
                context.reset()
        self.publish_clock()
        self.restart_pace()

    def sensors(self) -> list[PluginContext]:
        """The plugins of sensors."""
        return [context for contexts in self._plugins.values() for context in contexts
                if context.kind == "sensor"]

    def close(self) -> None:
        """Refuse pending calls; release renderer and engine."""
        self.mailbox.close()
        for end in self.at_close:
            end()
        self._drawing.close()
        self.real_time_factor.close()
        self.world.close()

    def _close_plugins(self, model: str) -> None:
        for context in self._plugins.pop(model, ()):
            context.close()

    def _load_plugins(self, model: Model) -> None:
        self._plugins[model.name] = load_plugins(self._host, model)
