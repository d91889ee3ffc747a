"""Which wheels of a base have no ground contact."""

from collections.abc import Iterable, Mapping

from bullet_sim.physics.contacts import Contact

PATIENCE = 0.1  # s without contact: a wheel that hops over a threshold has not dropped


class WheelDrop:
    """Call `dropped` again and again: it remembers when each wheel was last on something."""

    def __init__(self, wheels: Mapping[str, str], time: float):
        """Scoped names of the wheels' links by what they are called; `time` is now (s)."""
        self._wheels = wheels
        self._touched = dict.fromkeys(wheels, time)

    def dropped(self, contacts: Iterable[Contact], time: float) -> set[str]:
        """Names of the wheels that have touched nothing for a while, at `time` (s)."""
        touching = {link for contact in contacts for link in contact.links}
        for name, link in self._wheels.items():
            if link in touching or self._touched[name] > time:  # time was reset
                self._touched[name] = time
        return {name for name, last in self._touched.items() if time - last > PATIENCE}
