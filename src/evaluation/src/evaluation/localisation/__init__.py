"""How well amcl tracks, finds and finds again a robot in the simulated house."""
