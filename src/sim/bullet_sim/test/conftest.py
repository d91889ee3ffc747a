"""A world, and a renderer."""

import pytest

from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.world import World


@pytest.fixture
def world():
    """Empty, with Gazebo's physics."""
    made = World()
    yield made
    made.close()


@pytest.fixture(scope="module")
def renderer():
    """One for all tests of a file."""
    opened = EglRenderer()
    yield opened
    opened.close()
