"""Finds the wheels of a base that have no ground contact."""

from collections.abc import Iterable, Mapping

from bullet_sim.physics.contacts import Contact

PATIENCE = 0.1  # s without contact: a wheel that hops over a threshold has not dropped


class WheelDrop:
    """Call `dropped` regularly: it remembers when each wheel last touched something."""

    def __init__(self, wheels: Mapping[str, str], time: float):
        """`wheels`: scoped names of the wheels' links by wheel name; `time` is now (s)."""
        self._wheels = wheels
        self._touched = dict.fromkeys(wheels, time)

    def dropped(self, contacts: Iterable[Contact], time: float) -> set[str]:
        """Names of the wheels without contact for a while, at `time` (s)."""
        touching = {link for contact in contacts for link in contact.links}
        for name, link in self._wheels.items():
            if link in touching or self._touched[name] > time:  # time was reset
                self._touched[name] = time
        return {name for name, last in self._touched.items() if time - last > PATIENCE}
