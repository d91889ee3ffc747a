"""Joint controllers by type. A file here with `@controller(...)` is all it takes.

They follow the packages of the types' names in ros_controllers; files named here are theirs.
"""

import importlib
import pkgutil

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")
