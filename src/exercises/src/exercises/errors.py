"""What keeps a check from saying yes."""


class CannotCheck(Exception):
    """The check could not run: one line with what, where, and what to type next."""


class TimeUp(BaseException):
    """The check takes too long; no `except Exception` of the learner's catches it."""


class Mistake(Exception):
    """The learner's program does what no check can go on with; one line."""
