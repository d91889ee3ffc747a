"""What ends a run before it could be scored."""


class RunError(Exception):
    """The run could not start, or something it needs died; one line, and details."""

    def __init__(self, message: str, details: str = ""):
        super().__init__(message)
        self.details = details
