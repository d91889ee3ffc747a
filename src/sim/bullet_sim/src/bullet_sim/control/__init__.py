"""Joint control: hardware with handles, limits, PID, and the laws of joint controllers."""
