"""Maps from a laser and odometry, under gmapping's names."""
