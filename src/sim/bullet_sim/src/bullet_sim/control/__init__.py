"""Joint control: hardware with handles, limits, PID, and joint controllers."""
