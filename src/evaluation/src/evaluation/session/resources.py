"""Files of packages, and YAML files with known keys."""

from __future__ import annotations

from collections.abc import Sequence
from pathlib import Path

import rospkg
import yaml

from evaluation.session.failure import RunError


def find_package(name: str) -> Path:
    """The folder of a package."""
    try:
        return Path(rospkg.RosPack().get_path(name))
    except rospkg.ResourceNotFound as error:
        raise RunError(f"package {name} not found: source devel/setup.bash") from error


def read_keys(path: Path, expected: Sequence[str]) -> dict:
    """A YAML file that has exactly these keys; RunError names file and key."""
    try:
        values = yaml.safe_load(path.read_text(encoding="utf-8"))
    except UnicodeDecodeError as error:
        raise RunError(f"{path}: no text file") from error
    except OSError as error:
        raise RunError(f"{path}: {error.strerror}") from error
    except yaml.YAMLError as error:
        raise RunError(f"{path}: no YAML: {' '.join(str(error).split())}") from error
    if not isinstance(values, dict) or set(values) != set(expected):
        given = set(values) if isinstance(values, dict) else set()
        wrong = sorted(given - set(expected), key=str) or sorted(set(expected) - given)
        kind = "unknown" if given - set(expected) else "missing"
        raise RunError(f"{path}: {kind} key {wrong[0]!r}; there are: {', '.join(expected)}")
    return values
