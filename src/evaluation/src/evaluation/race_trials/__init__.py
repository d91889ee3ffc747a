"""Tests racecar followers over many laps, each with its own start, noise and light."""
