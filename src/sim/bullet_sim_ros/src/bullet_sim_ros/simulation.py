"""The simulated world together with its ROS side, and the loop that drives both."""

from collections import Counter
from collections.abc import Callable

import rospy
from rosgraph_msgs.msg import Clock

from bullet_sim.description import ModelDescription
from bullet_sim.model import Model
from bullet_sim.physics.engine import EngineError
from bullet_sim.pose import Pose
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.drawing import DrawingThread
from bullet_sim_ros.lockstep import Lockstep
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.pacer import Pacer
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.host import PluginHost
from bullet_sim_ros.plugin_host.registry import load_plugins, load_world_plugins
from bullet_sim_ros.real_time_factor import RealTimeFactorMonitor
from bullet_sim_ros.rospy_patches import set_time
from bullet_sim_ros.scheduler import Scheduler

IDLE = 0.05  # s, wall clock: how long to wait for a call before checking for shutdown


class Simulation:
    """Owned by the loop's thread; other threads reach it through the mailbox."""

    def __init__(self, world: World, parameters: NodeParameters):
        self.world = world
        self.mailbox = Mailbox()
        self.scheduler = Scheduler(world)
        self.pacer = Pacer()
        self.real_time_factor = RealTimeFactorMonitor(world.profiler, parameters.profile)
        self._stop_requested = False
        self._drawing = DrawingThread(world.profiler)
        self.lockstep = Lockstep(parameters.lockstep, parameters.lockstep_timeout, self.mailbox,
                                 parameters.lockstep_sensor)
        self._host = PluginHost(
            world, self.mailbox, self.scheduler, self._drawing, self.lockstep
        )
        self.senders = self._host.senders
        self._plugins: dict[str, list[PluginContext]] = {}
        world.each_removal.append(self._close_plugins)
        self._clock = rospy.Publisher(names.CLOCK, Clock, queue_size=10)
        self.scheduler.add(parameters.pub_clock_frequency, self._publish_clock)
        self.set_pace()
        self.each_turn: list[Callable[[], None]] = []  # called by the loop, paused or not
        self.state_calls: Counter[str] = Counter()  # get_model_state calls by model: header.seq
        for model in world.models.values():
            self._load_plugins(model)
        self._world_plugins = load_world_plugins(self._host)
        self.lockstep.listen()

    # --- the loop

    def run(self, iterations: int = 0) -> None:
        """Step until `stop` or ROS shutdown, or for `iterations` steps (0: no limit)."""
        self._publish_clock()
        left = iterations or float("inf")
        while left and not self._stopped():
            self._wait()
            try:
                for function in self.each_turn:
                    function()
                if not self.world.paused and not self._stopped():
                    left -= self._advance(left)
            except EngineError as error:  # from a topic that publishes poses
                self.world.delete_lost_models(error)

    def stop(self) -> None:
        """End the loop soon; may be called by a signal handler."""
        self._stop_requested = True

    def _stopped(self) -> bool:
        return self._stop_requested or rospy.is_shutdown()

    def _wait(self) -> None:
        """Answer calls until the next tick is due by the wall clock; at least the pending calls."""
        if self.world.paused:
            self.mailbox.run_pending(IDLE)
            self._restart_pace()
            return
        while (ahead := self.pacer.ahead(self._due())) > 0 and not self._stopped():
            self.mailbox.run_pending(min(ahead, IDLE))
            if self.world.paused:
                return
        self.mailbox.run_pending()

    def _due(self) -> float:
        """Simulated time, s, of the next scheduled job."""
        return self.scheduler.next_tick() * self.world.timestep

    def _advance(self, most: float) -> int:
        """Step to the next scheduled jobs and run them; returns the number of steps taken."""
        world = self.world
        steps = int(min(self.scheduler.next_tick() - world.tick, most))
        world.step(steps)
        with world.profiler.measure("plugins"):
            self.scheduler.run()
        with world.profiler.measure("lockstep"):
            self.lockstep.wait(self._stopped)
        self.real_time_factor.update(world.time, self.pacer.factor)
        return steps

    def step(self) -> None:
        """Take one step and run the jobs due then; afterwards pause and publish /clock."""
        self.world.paused = False
        try:
            self._advance(1)
        finally:
            self.world.paused = True
        self._publish_clock()

    def _publish_clock(self) -> None:
        now = convert.stamp(self.world.time)
        set_time(now)
        self._clock.publish(Clock(now))

    # --- pace

    def set_pace(self) -> None:
        """Set the real-time factor to the world's step size times real_time_update_rate."""
        physics = self.world.description.physics
        self.pacer.factor = physics.max_step_size * physics.real_time_update_rate
        self.scheduler.set_pace(self.pacer.factor)
        self._restart_pace()

    def configure_physics(self, **changes) -> None:
        """Change the world's physics; rates and pace follow the new step."""
        self.world.configure_physics(**changes)
        self.scheduler.restart()
        self.set_pace()

    def _restart_pace(self) -> None:
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
        self._publish_clock()
        self._restart_pace()

    def sensors(self) -> list[PluginContext]:
        """The plugins of sensors."""
        return [context for contexts in self._plugins.values() for context in contexts
                if context.kind == "sensor"]

    def close(self) -> None:
        """Refuse pending calls; release renderer and engine."""
        self.mailbox.close()
        self._drawing.close()
        self.real_time_factor.close()
        self.world.close()

    def _close_plugins(self, model: str) -> None:
        for context in self._plugins.pop(model, ()):
            context.close()

    def _load_plugins(self, model: Model) -> None:
        self._plugins[model.name] = load_plugins(self._host, model)
