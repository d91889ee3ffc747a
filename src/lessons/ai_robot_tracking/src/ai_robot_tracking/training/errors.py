"""What ends the making of a detector."""


class TrainingError(Exception):
    """One line that says what is wrong, and what to type instead."""
