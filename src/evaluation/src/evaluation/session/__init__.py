"""The video of a run, and the course files."""
