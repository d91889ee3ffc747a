"""Checks a learner's file by what it does."""
