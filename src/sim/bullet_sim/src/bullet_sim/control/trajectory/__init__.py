"""Trajectories of joints: splines, how a new one joins the present one, tolerances, following."""
