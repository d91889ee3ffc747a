"""The node's parameters."""

import ipaddress
import os
import secrets
from dataclasses import dataclass, replace

import rospy

PORTS = range(1, 65536)
TOKEN = "SIM_VIEWER_TOKEN"  # environment variable: `ps` and the master show it to nobody else


class OptionError(ValueError):
    """A parameter whose value cannot be used."""


@dataclass(frozen=True)
class Options:
    """The node's options, named as the arguments of viewer.launch."""

    port: int = 8080
    address: str = "127.0.0.1"
    control: bool = False
    token: str = ""  # empty: none is asked for
    hosts: tuple[str, ...] = ()  # further names by which browsers reach this machine
    bags: str = ""  # folder of recorded bags; empty: ~/bags
    open: bool = False
    rviz: str = ""  # a .rviz file, whose displays the tab RViz shows

    @property
    def loopback(self) -> bool:
        """Whether only this machine itself can reach the page."""
        if self.address == "localhost":
            return True
        try:
            return ipaddress.ip_address(self.address).is_loopback
        except ValueError:
            return False


def read_options() -> Options:
    """Read the node's private parameters; if a token is needed and none is set, one is generated.

    OptionError if a value is of another type, or the port is invalid.
    """
    options = Options(
        port=_read("port", int, Options.port),
        address=_read("address", str, Options.address),
        control=_read("control", bool, Options.control),
        token=str(rospy.get_param("~token", "")) or os.environ.get(TOKEN, ""),
        hosts=tuple(name.strip().lower() for name in _read("hosts", str, "").split(",")
                    if name.strip()),
        bags=str(rospy.get_param("~bags", "")).strip(),
        open=_read("open", bool, Options.open),
        rviz=str(rospy.get_param("~rviz", "")).strip(),
    )
    if options.port not in PORTS:
        raise OptionError(f"port is {options.port}; give one from 1 to 65535, such as port:=8080")
    if not options.loopback and not options.token:
        return replace(options, token=secrets.token_urlsafe(12))
    return options


def _read(name: str, kind: type, default):
    value = rospy.get_param(f"~{name}", default)
    if type(value) is not kind:
        raise OptionError(f"{name} is {value!r}, which is not of type {kind.__name__}; "
                          f"the default is {name}:={str(default).lower()}")
    return value
