"""Checks a learner's file by running it."""
