"""Gazebo plugins by library file name. A file here with `@plugin(...)` is all it takes."""

import importlib
import pkgutil

from bullet_sim_ros.plugins.registry import load_plugins, load_world_plugins, plugin

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")

__all__ = ["load_plugins", "load_world_plugins", "plugin"]
