"""Compiles every inner loop before a node needs it: `python3 -m nav_algorithms.warm_up`."""

from __future__ import annotations

import importlib
import pkgutil

import nav_algorithms


def main() -> None:
    """Import every module; each compiles and caches what is missing."""
    for module in pkgutil.walk_packages(nav_algorithms.__path__, "nav_algorithms."):
        if module.name != __spec__.name:
            importlib.import_module(module.name)


if __name__ == "__main__":
    main()
