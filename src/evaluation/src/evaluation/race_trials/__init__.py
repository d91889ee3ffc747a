"""Many laps of the racecar, each with its own start, noise and light: is its follower any good?"""
