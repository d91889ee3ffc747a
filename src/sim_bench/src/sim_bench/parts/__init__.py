"""What is measured: a file a part, each with a function `measure(settings) -> list[Figure]`."""
