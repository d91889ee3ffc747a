"""Laps driven by course_run, each with its own start, camera noise and light."""
