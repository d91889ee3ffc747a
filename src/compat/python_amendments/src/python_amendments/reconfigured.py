"""`dynparam set` says which values the node has not taken, and which it could take."""

import os
import sys

from terminal_language import translated

PROGRAM = "dynparam"  # upstream's command; other programs look at the answer themselves
NUMBERS = {"double": float, "int": int}
UNKNOWN = "%s has no parameter %s; there are: %s"
NO_NUMBER = "%s must be a number from %s to %s, not %s"
OTHER_VALUE = "%s is now %s, not %s: it must be from %s to %s"
REFUSED = "%s is still %s: the node refuses %s, and says in its own terminal why"


def amend_client(client):
    """Let it end with a line and exit code 1; `client` is the module dynamic_reconfigure.client."""
    if os.path.basename(sys.argv[0]) != PROGRAM:
        return
    kind = client.Client
    update = kind.update_configuration

    def update_configuration(caller, changes):
        known = {each["name"]: each for each in caller.get_parameter_descriptions() or ()}
        wanted = {name: value for name, value in changes.items() if name != "groups"}
        for name, value in wanted.items():
            if known and name not in known:
                sys.exit(translated(UNKNOWN % (caller.name, name, ", ".join(sorted(known)))))
            if known and not is_fit(value, known[name]):
                sys.exit(translated(NO_NUMBER % (name, *bounds(known[name]), value)))
        now = update(caller, changes)  # which makes numbers of the texts in `changes`
        lines = [translated(not_taken(name, value, changes[name], now[name], *bounds(known[name])))
                 for name, value in wanted.items() if name in known and now[name] != changes[name]]
        if lines:
            sys.exit("\n".join(lines))
        return now

    update_configuration.__doc__ = update.__doc__
    kind.update_configuration = update_configuration


def is_fit(value, description):
    """Whether a value as it was typed can be one of the parameter's type."""
    kind = NUMBERS.get(description["type"])
    if kind is None or description["edit_method"]:  # a text, a switch, or one of a few names
        return True
    try:
        kind(value)
    except (TypeError, ValueError):
        return False
    return True


def bounds(description):
    """The least and the greatest value that a parameter may have."""
    return description["min"], description["max"]


def not_taken(name, typed, asked, now, least, greatest):
    """The line on a parameter that has another value than was asked for, as it was typed."""
    if least <= asked <= greatest:
        return REFUSED % (name, now, typed)
    return OTHER_VALUE % (name, now, typed, least, greatest)
