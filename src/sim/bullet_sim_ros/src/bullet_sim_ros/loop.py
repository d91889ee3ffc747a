"""The node's loop: read, step, update, write, publish, wait. All physics runs in its thread."""

from bullet_sim.physics.engine import EngineError
from bullet_sim_ros.simulation import Simulation

IDLE = 0.05  # s, wall clock: how long to wait for a call before checking for shutdown


def run(simulation: Simulation, iterations: int = 0) -> None:
    """Step until `stop` or ROS shutdown, or for `iterations` steps (0: no limit)."""
    simulation.publish_clock()
    left = iterations or float("inf")
    while left and not simulation.stopped():
        wait(simulation)
        try:
            for publish in simulation.each_turn:
                publish()
            if not simulation.world.paused and not simulation.stopped():
                left -= advance(simulation, left)
        except EngineError as error:  # from a topic that publishes poses
            simulation.world.delete_lost_models(error)


def wait(simulation: Simulation) -> None:
    """Read commands and answer calls until the next tick is due by the wall clock, at least once.
    """
    mailbox, world = simulation.mailbox, simulation.world
    if world.paused:
        mailbox.run_pending(IDLE)
        simulation.restart_pace()
        return
    due = simulation.due()
    while (ahead := simulation.pacer.ahead(due)) > 0 and not simulation.stopped():
        if mailbox.run_pending(min(ahead, IDLE)):
            if world.paused:
                return
            due = simulation.due()
    mailbox.run_pending()


def advance(simulation: Simulation, most: float = 1) -> int:
    """Step to the next scheduled tasks and run them; returns the number of steps taken.

    Drives and controllers are updated and write to their joints, sensors and states are published,
    in the order in which they were loaded. In lockstep the world then waits for the answer.
    """
    world = simulation.world
    steps = int(min(simulation.scheduler.next_tick() - world.tick, most))
    world.step(steps)
    with world.profiler.measure("plugins"):
        simulation.scheduler.run()
    with world.profiler.measure("lockstep"):
        stood = simulation.lockstep.wait(simulation.stopped)
    if stood:  # at a breakpoint: neither to catch up with, nor slow
        simulation.restart_pace()
    simulation.real_time_factor.update(world.time, simulation.pacer.factor)
    return steps
