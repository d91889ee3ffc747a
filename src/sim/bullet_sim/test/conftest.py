"""Lets the tests import prop_models.py, rigs.py and snapshots.py; a world, and a renderer."""

import sys
from pathlib import Path

import pytest

from bullet_sim.rendering.egl import EglRenderer
from bullet_sim.world import World

sys.path.insert(0, str(Path(__file__).parent))


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
