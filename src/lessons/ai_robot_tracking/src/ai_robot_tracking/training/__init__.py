"""The shipped detector: images with known boxes, a small network, its training, its scores."""

CLASSES = ("person", "cylinder", "cone", "stop sign", "traffic light")  # as the network's outputs


class TrainingError(Exception):
    """One line with the error and what to type instead."""
