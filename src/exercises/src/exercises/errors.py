"""Exceptions that end a check early."""


class CannotCheck(Exception):
    """The check could not run: one line with what, where, and what to type next."""


class TimeUp(BaseException):
    """The check takes too long; a learner's `except Exception` does not catch it."""


class Mistake(Exception):
    """An error in the learner's program that the check cannot continue after; one line."""
