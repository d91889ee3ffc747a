"""Ends the worlds that a test leaves open, and shows what only the garbage collector would free."""

import gc

import pytest

from bullet_sim.physics.client import PhysicsClient
from bullet_sim.physics.engine import pybullet


@pytest.fixture(autouse=True)
def worlds_are_closed(monkeypatch):
    """After each test, whatever it opened: each world holds some 20 MB of the engine's."""
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


@pytest.fixture
def no_collector():
    """Objects go when their last reference does, or not at all."""
    gc.collect()
    gc.disable()
    yield
    gc.enable()
