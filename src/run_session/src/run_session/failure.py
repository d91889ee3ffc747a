"""The error that ends a run before it could be scored."""


class RunError(Exception):
    """The run could not start, or a process that it needs died; has one line, and details."""

    def __init__(self, message: str, details: str = ""):
        super().__init__(message)
        self.details = details
