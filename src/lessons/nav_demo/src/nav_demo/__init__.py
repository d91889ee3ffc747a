"""What the lessons of nav_demo need besides scripts and launch files."""
