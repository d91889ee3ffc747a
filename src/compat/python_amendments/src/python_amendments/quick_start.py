"""ROS's modules load without NumPy and catkin_pkg, which are half of a program's start.

genpy asks for NumPy only to know the names of its numbers, catkin for catkin_pkg only to look
through source folders.
"""

import sys
from types import SimpleNamespace


def _find_packages(*words, **more):
    from catkin_pkg.packages import find_packages

    return find_packages(*words, **more)


# A module, and what it finds in the place of one that it seldom needs; None is an ImportError.
IN_PLACE = {"catkin.find_in_workspaces": (
    "catkin_pkg.packages", SimpleNamespace(find_packages=_find_packages)),
            "genpy.message": ("numpy", None)}


def load_without(load, module):
    """Load one of these modules, without what it seldom needs unless that is loaded already."""
    seldom, in_place = IN_PLACE[module.__name__]
    if seldom in sys.modules:
        load(module)
        return
    import genmsg  # noqa: F401  genpy.message loads in a moment then: another thread finds NumPy
    import yaml  # noqa: F401

    sys.modules[seldom] = in_place
    try:
        load(module)
    finally:
        del sys.modules[seldom]


def amend_numpy(numpy):
    """Let genpy, if it was loaded before, take NumPy's numbers for a message's floats."""
    floats = getattr(sys.modules.get("genpy.message"), "_valid_float_types", None)
    if floats is not None and numpy.float64 not in floats:
        floats += [
            numpy.float32, numpy.float64, numpy.int8, numpy.int16, numpy.int32, numpy.int64,
            numpy.uint8, numpy.uint16, numpy.uint32, numpy.uint64]
