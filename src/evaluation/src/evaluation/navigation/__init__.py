"""`make navigate`: maps a house, starts again on that map, visits goals, and scores it all."""
