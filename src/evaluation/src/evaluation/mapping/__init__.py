"""Maps and paths of navigation against the truth that the simulator knows."""
