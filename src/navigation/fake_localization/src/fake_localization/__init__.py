"""The simulator's truth in place of a localisation."""
