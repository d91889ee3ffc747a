"""`make navigate`: maps a house, restarts with that map, visits goals, and scores it all."""
