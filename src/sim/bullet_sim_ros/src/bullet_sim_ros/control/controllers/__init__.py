"""Joint controllers by type. To add one, put a file with `@controller(...)` here.

They follow the packages of the same names in ros_controllers; C++ files named here are in those.
"""

import importlib
import pkgutil

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")
