"""What lies in folders beside the tests."""

import importlib
from collections.abc import Callable
from pathlib import Path
from types import ModuleType

import pytest


@pytest.fixture(scope="session")
def modules() -> Callable[..., dict[str, ModuleType]]:
    """Those of a folder of programs that find each other by name, by their names."""

    def load(folder: str, *names: str) -> dict[str, ModuleType]:
        with pytest.MonkeyPatch.context() as patch:
            patch.syspath_prepend(Path(__file__).parent / folder)
            return {name: importlib.import_module(name) for name in names}

    return load
