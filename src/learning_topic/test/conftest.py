"""Loads a lesson as a module (their names start with a digit) and draws roads for it."""

import importlib.util
import pathlib

import pytest

SCRIPTS = pathlib.Path(__file__).resolve().parents[1] / "scripts"


@pytest.fixture(scope="session")
def lesson():
    """lesson(5) is the module of scripts/05….py, loaded without a master."""
    loaded = {}

    def load(number):
        if number not in loaded:
            (path,) = SCRIPTS.glob(f"{number:02}follower*.py")
            spec = importlib.util.spec_from_file_location(f"lesson_{number:02}", path)
            loaded[number] = importlib.util.module_from_spec(spec)
            spec.loader.exec_module(loaded[number])
        return loaded[number]

    return load
