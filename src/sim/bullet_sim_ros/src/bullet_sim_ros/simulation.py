"""The simulated world together with its ROS side, and the loop that drives both."""

from collections import Counter
from collections.abc import Callable

import rospy
from rosgraph_msgs.msg import Clock

from bullet_sim.description import ModelDescription
from bullet_sim.model import Model
from bullet_sim.physics.quiet import EngineError
from bullet_sim.pose import Pose
from bullet_sim.world import World
from bullet_sim_ros import convert, names
from bullet_sim_ros.drawing import DrawingThread
from bullet_sim_ros.lockstep import Lockstep
from bullet_sim_ros.mailbox import Mailbox
from bullet_sim_ros.pacer import Pacer
from bullet_sim_ros.params import NodeParameters
from bullet_sim_ros.plugin_host.context import PluginContext
from bullet_sim_ros.plugin_host.registry import load_plugins, load_world_plugins
from bullet_sim_ros.plugin_host.shared_by_plugins import SharedByPlugins
from bullet_sim_ros.real_time_factor import RealTimeFactorMonitor
from bullet_sim_ros.scheduler import Scheduler

IDLE = 0.05  # s, wall: how long to wait for a call before looking whether all is to end


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
        self._services = SharedByPlugins(
            world, self.mailbox, self.scheduler, self._drawing, self.lockstep
        )
        self._plugins: dict[str, list[PluginContext]] = {}
        world.each_removal.append(self._close_plugins)
        self._clock = rospy.Publisher(names.CLOCK, Clock, queue_size=10)
        self.scheduler.add(parameters.pub_clock_frequency, self._publish_clock)
        self.set_pace()
        self.each_turn: list[Callable[[], None]] = []  # called by the loop, paused or not
        self.state_calls: Counter[str] = Counter()  # of get_model_state, by model: its header's seq
        for model in world.models.values():
            self._load_plugins(model)
        self._world_plugins = load_world_plugins(self._services)
        self.lockstep.listen()

    # --- the loop

    def run(self, iterations: int = 0) -> None:
        """Step until `stop` or until ROS shuts down, or for so many steps."""
        self._publish_clock()
        left = iterations or float("inf")
        while left and not self._stopped():
            self._wait()
            try:
                for function in self.each_turn:
                    function()
                if not self.world.paused and not self._stopped():
                    left -= self._advance(left)
            except EngineError as error:  # of a topic with poses
                self.world.delete_lost_models(error)

    def stop(self) -> None:
        """From a signal handler: end the loop soon."""
        self._stop_requested = True

    def _stopped(self) -> bool:
        return self._stop_requested or rospy.is_shutdown()

    def _wait(self) -> None:
        """Answer calls until what comes next is due by the wall clock; at least those that wait."""
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
        """Simulated time, s, of what is to be done next."""
        return self.scheduler.next_tick() * self.world.timestep

    def _advance(self, most: float) -> int:
        """Step up to what is due next, and do it; returns how many steps that took."""
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
        """One step and what is due then; afterwards the world is paused, /clock published."""
        self.world.paused = False
        try:
            self._advance(1)
        finally:
            self.world.paused = True
        self._publish_clock()

    def _publish_clock(self) -> None:
        now = convert.stamp(self.world.time)
        # This node needs no /clock: its log stamps get the time directly. Nobody here sleeps by it.
        rospy.rostime._rostime_current = now
        self._clock.publish(Clock(now))

    # --- pace

    def set_pace(self) -> None:
        """Real-time factor as the world's physics says: step times real_time_update_rate."""
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
        """Put a model in and load its plugins."""
        model = self.world.spawn(description, pose, name)
        try:
            self._load_plugins(model)
        except Exception:
            self.world.delete(name)
            raise
        self.lockstep.listen()
        return model

    def delete(self, name: str) -> None:
        """Take a model out; its topics disappear."""
        self.world.delete(name)
        self.lockstep.listen()

    def reset(self) -> None:
        """Time and models back to the start; plugins are reset."""
        self._drawing.settle()  # no picture of the time before comes after it
        self.lockstep.cancel()
        self.world.reset_simulation()
        self.scheduler.restart()
        for contexts in (*self._plugins.values(), self._world_plugins):
            for context in contexts:
                context.reset()
        self._publish_clock()
        self._restart_pace()

    def sensors(self) -> list[PluginContext]:
        """The plugins that work for a sensor."""
        return [context for contexts in self._plugins.values() for context in contexts
                if context.kind == "sensor"]

    def close(self) -> None:
        """Answer calls that still wait; release renderer and engine."""
        self.mailbox.close()
        self._drawing.close()
        self.real_time_factor.close()
        self.world.close()

    def _close_plugins(self, model: str) -> None:
        for context in self._plugins.pop(model, ()):
            context.close()

    def _load_plugins(self, model: Model) -> None:
        self._plugins[model.name] = load_plugins(self._services, model)
