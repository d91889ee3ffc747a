"""Why a package or module is not here, and how it is had."""

from functools import cache

from workspace_needs.tables import DEBIAN, Tables


@cache
def tables() -> Tables:
    """The tables of who has what, read once."""
    return Tables()


def why_absent(name: str, *debian_names: str) -> str:
    """Why there is no `name`, or how it is had, perhaps by one of Debian's other names for it."""
    for key in (name, *debian_names):
        answer = tables().answer(key)
        if answer.kind == DEBIAN:
            return f"sudo apt-get install {' '.join(answer.packages)}"
    return tables().answer(name).why or "source devel/setup.bash of its workspace first"
