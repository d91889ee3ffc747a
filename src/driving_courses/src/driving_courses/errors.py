"""What can be wrong with courses and options."""


class CourseError(ValueError):
    """One line that says what is wrong and which values are possible."""
