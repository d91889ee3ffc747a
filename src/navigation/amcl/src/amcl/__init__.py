"""The node amcl: nav_algorithms' Monte Carlo localisation with upstream's interface."""
