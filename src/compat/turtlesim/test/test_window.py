"""The window on a machine without Tk; under Xvfb it is in window_story.py. Needs no master."""

import sys

import pytest
from turtlesim.window import NoScreen, Window


def test_without_tk_it_is_said_what_to_install(monkeypatch):
    monkeypatch.setitem(sys.modules, "tkinter", None)  # importing it is an ImportError now
    with pytest.raises(NoScreen, match="sudo apt-get install python3-tk"):
        Window()
