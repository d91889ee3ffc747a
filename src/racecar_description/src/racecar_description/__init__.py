"""The racecar's tools: its tracks."""
