"""Laps that course_run drives, each with a start, camera noise and light of its own."""
