"""Errors that end the training of a detector."""


class TrainingError(Exception):
    """One line with the error and what to type instead."""
