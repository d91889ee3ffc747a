"""`make bench`: benchmarks the simulator against PyBullet's renderers and its bare engine."""
