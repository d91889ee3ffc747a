"""What a world may ask of the engine: outside of it, time would stand still or be no physics."""

from __future__ import annotations

from bullet_sim.description import PhysicsDescription
from bullet_sim.errors import SimulationError

SHORTEST_STEP = 1e-5  # s; with shorter ones 10 ms of time, and with it an answer, take a second
LONGEST_STEP = 0.1  # s; with longer ones things pass through each other
MOST_ITERATIONS = 10_000  # a step; upstream's bound in dynamic_reconfigure
HIGHEST_RATE = 1e6  # Hz


def check_physics(physics: PhysicsDescription) -> None:
    """A SimulationError that says what is outside, and what is possible."""
    if not SHORTEST_STEP <= physics.max_step_size <= LONGEST_STEP:
        raise SimulationError(f"a time step of {physics.max_step_size:g} s is not possible; "
                              f"{SHORTEST_STEP:g} to {LONGEST_STEP:g} is")
    if not 0 <= physics.real_time_update_rate <= HIGHEST_RATE:
        raise SimulationError(f"an update rate of {physics.real_time_update_rate:g} Hz is not "
                              f"possible; 0 (as fast as it goes) to {HIGHEST_RATE:g} is")
    if not 0 <= physics.iterations <= MOST_ITERATIONS:
        raise SimulationError(f"{physics.iterations} solver iterations a step are not possible; "
                              f"0 to {MOST_ITERATIONS} are")
