"""Joint controllers by type. A file here with `@controller(...)` is all it takes.

"Upstream" is the package of the type's name in ros_controllers.
"""

import importlib
import pkgutil

for _module in pkgutil.iter_modules(__path__):
    importlib.import_module(f"{__name__}.{_module.name}")
