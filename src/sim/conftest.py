"""Ends the worlds that a test leaves open: each holds some 20 MB of the engine's."""

import pytest

from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.quiet import pybullet


@pytest.fixture(autouse=True)
def worlds_are_closed(monkeypatch):
    """After each test, whatever it opened."""
    opened = []
    make = PhysicsClient.__init__

    def note(self, *args, **options):
        make(self, *args, **options)
        opened.append(self)

    monkeypatch.setattr(PhysicsClient, "__init__", note)
    yield
    for client in opened:
        if pybullet.isConnected(client._id):
            client.close()
