"""How well amcl localises, relocalises and tracks a robot in the simulated house."""
