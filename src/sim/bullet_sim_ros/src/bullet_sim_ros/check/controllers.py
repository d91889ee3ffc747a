"""The joint controllers that a launch file configures: namespaces with a parameter `type`."""

import re
from collections.abc import Collection, Iterator, Mapping

from bullet_sim_ros.check.findings import Finding
from bullet_sim_ros.control import controllers, registry  # noqa: F401  (controllers register)
from bullet_sim_ros.interface import ABSENT, WORKS, Row

KIND = re.compile(r"\w+/\w+")
PACKAGE = re.compile(r"\w*controllers?(_\w+)?/")


def controller_findings(parameters: Mapping[str, object], spawned: Collection[str],
                        rows: Mapping[str, Row], where: str) -> Iterator[Finding]:
    """One for each controller.

    Other things have types as well. A type of a package that is not named after controllers only
    counts where a spawner was given the name, one of `spawned`.
    """
    known = rows["controllers"].tags
    for name, kind in parameters.items():
        namespace, _, last = name.rpartition("/")
        if last != "type" or not isinstance(kind, str) or not KIND.fullmatch(kind):
            continue
        part = f"controller {namespace} ({kind})"
        if registry.find(kind) is not None:
            row = known.get(kind)
            yield Finding(where, part, row.status if row else WORKS, row.how if row else "")
        elif PACKAGE.match(kind) or namespace.rpartition("/")[2] in spawned:
            yield Finding(where, part, ABSENT,
                          f"there is no such type of controller here{registry.hint(kind)}")
