"""Filters of package `filters` over the last scans, within LaserArrayFilter."""

from collections import deque

import numpy as np


class Observations:
    """Median or mean of the last values of each beam, one stage after the other."""

    def __init__(self, stages: tuple[tuple[str, int], ...] = ()):
        """`stages`: each "median" or "mean", and of how many scans."""
        self._stages = [(kind, deque(maxlen=count)) for kind, count in stages]

    def combined(self, values: np.ndarray) -> np.ndarray:
        """Values (N,) after all stages; a scan of another length begins anew."""
        for kind, last in self._stages:
            if last and len(last[-1]) != len(values):
                last.clear()
            last.append(values)
            stack = np.array(last)
            # of an even number the lower one in the middle, as upstream
            values = (np.sort(stack, axis=0)[(len(stack) - 1) // 2] if kind == "median"
                      else stack.mean(axis=0))
        return values
