"""The lane course: people who cross the road, and trials of lane keeping methods."""
