"""Maps from a laser and odometry, with gmapping's interface."""
