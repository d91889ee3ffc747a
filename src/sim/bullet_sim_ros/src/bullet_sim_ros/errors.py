"""Errors of the ROS side, and the log line of any error."""

from bullet_sim.errors import SimulationError


def format_error(error: Exception) -> str:
    """One line for the terminal, with the error's type if it is not a SimulationError."""
    text = " ".join(str(error).split())
    return text if isinstance(error, SimulationError) else f"{type(error).__name__}: {text}"
