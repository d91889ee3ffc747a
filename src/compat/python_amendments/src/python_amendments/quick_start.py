"""ROS's modules load without NumPy, catkin_pkg and pyparsing: half of a program's start.

genpy asks for NumPy only to know the names of its numbers, catkin for catkin_pkg only to look
through source folders, and that for pyparsing only where a package.xml has conditions.
"""

import sys
from types import SimpleNamespace


def _find_packages(*words, **more):
    from catkin_pkg.packages import find_packages

    return find_packages(*words, **more)


class _Pyparsing:
    @staticmethod
    def infixNotation(*words):
        from pyparsing import infixNotation

        return infixNotation(*words)

    def __getattr__(self, name):
        if name.startswith("__"):  # which an import asks for
            raise AttributeError(name)
        import pyparsing

        return getattr(pyparsing, name)


# A module, and what it finds in the place of one that it seldom needs; None is an ImportError.
IN_PLACE = {
    "catkin.find_in_workspaces": (
        "catkin_pkg.packages", SimpleNamespace(find_packages=_find_packages)),
    "catkin_pkg.condition": ("pyparsing", _Pyparsing()),
    "genpy.message": ("numpy", None)}


def load_without(load, module):
    """Load one of these modules, without what it seldom needs unless that is loaded already."""
    seldom, in_place = IN_PLACE[module.__name__]
    if seldom in sys.modules:
        load(module)
        return
    if seldom == "numpy":  # genpy.message loads in a moment then: another thread finds NumPy
        import genmsg  # noqa: F401
        import yaml  # noqa: F401
    sys.modules[seldom] = in_place
    try:
        load(module)
    except ImportError:  # another version needs it
        del sys.modules[seldom]
        load(module)
    finally:
        if seldom in sys.modules and sys.modules[seldom] is in_place:
            del sys.modules[seldom]


def amend_numpy(numpy):
    """Let genpy, if it was loaded before, take NumPy's numbers for a message's floats."""
    floats = getattr(sys.modules.get("genpy.message"), "_valid_float_types", None)
    if floats is not None and numpy.float64 not in floats:
        floats += [
            numpy.float32, numpy.float64, numpy.int8, numpy.int16, numpy.int32, numpy.int64,
            numpy.uint8, numpy.uint16, numpy.uint32, numpy.uint64]
