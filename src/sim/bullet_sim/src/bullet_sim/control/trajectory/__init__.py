"""Joint trajectories: splines, joining a new one to the current one, tolerances, following."""
