"""Checks this terminal's ROS_MASTER_URI, ROS_HOSTNAME and ROS_IP; what a fault is told by."""

from __future__ import annotations

import re
from collections.abc import Callable, Mapping
from dataclasses import dataclass
from urllib.parse import urlsplit

MASTER_PORT = 11311
ADDRESS = re.compile(r"\d{1,3}(\.\d{1,3}){3}")
SAMPLE = f"export ROS_MASTER_URI=http://localhost:{MASTER_PORT}"


@dataclass(frozen=True)
class Finding:
    """`wrong`: the error; `remedy`: what to type, and on which machine if not on this one."""

    wrong: str
    remedy: str

    def __str__(self) -> str:
        return f"WRONG  {self.wrong}. Type: {self.remedy}"


def is_loopback(address: str) -> bool:
    """Whether an IPv4 address leads every machine to itself."""
    return address.startswith("127.")


@dataclass(frozen=True)
class Surroundings:
    """What the checks need to know about this machine."""

    addresses_of: Callable[[str], list[str]]  # IPv4 addresses of a name; empty if unknown
    is_mine: Callable[[str], bool]            # whether an address is this machine's
    address_towards: Callable[[str], str]     # this machine's address on the route to another one
    own_name: str                             # as printed by `hostname`


def split_uri(uri: str) -> tuple[str, int] | None:
    """Host and port of "http://HOST:PORT/", or None for anything else."""
    try:
        parts = urlsplit(uri.strip())
        host, port = parts.hostname, parts.port
    except ValueError:
        return None
    if parts.scheme != "http" or not host or not port or parts.path not in ("", "/"):
        return None
    return host, port


def check_master(environment: Mapping[str, str], around: Surroundings) -> list[Finding]:
    """Check ROS_MASTER_URI, before any call to the master."""
    uri = environment.get("ROS_MASTER_URI", "")
    if not uri:
        return [Finding("ROS_MASTER_URI is not set: no node finds the master", SAMPLE)]
    place = split_uri(uri)
    if place is None:
        return [Finding(f"ROS_MASTER_URI is {uri!r}, and not of the form http://HOST:PORT", SAMPLE)]
    host = place[0]
    if not around.addresses_of(host):
        return [Finding(f"ROS_MASTER_URI names {host!r}, and this machine knows no address of it",
                        f"echo 'ADDRESS {host}' | sudo tee -a /etc/hosts, with the master's "
                        f"address, or export ROS_MASTER_URI=http://ADDRESS:{place[1]}")]
    return []


def advertised_name(environment: Mapping[str, str], own_name: str) -> tuple[str, str]:
    """The name by which other machines reach this terminal's nodes, and its source.

    ROS_HOSTNAME takes precedence over ROS_IP, and that over the machine's name, as in rosgraph.
    """
    for variable in ("ROS_HOSTNAME", "ROS_IP"):
        if environment.get(variable):
            return environment[variable], variable
    return own_name, "hostname"


def check_own_name(environment: Mapping[str, str], around: Surroundings) -> list[Finding]:
    """Check ROS_HOSTNAME and ROS_IP, after check_master has found no error."""
    host = split_uri(environment["ROS_MASTER_URI"])[0]
    master = around.addresses_of(host)[0]
    own = around.address_towards(master)
    remedy = f"export ROS_IP={own}; unset ROS_HOSTNAME"
    if is_loopback(own) and not around.is_mine(master):
        remedy = f"ip route, and connect this machine to the network of {host}"
    name, source = advertised_name(environment, around.own_name)
    found = []
    hostname, ip = environment.get("ROS_HOSTNAME"), environment.get("ROS_IP")
    if hostname and ip and hostname != ip:
        found.append(Finding(f"ROS_HOSTNAME is {hostname!r} and ROS_IP {ip!r}: the second has no "
                             f"effect", "unset ROS_IP"))
    if source == "ROS_IP" and not ADDRESS.fullmatch(name):
        return [*found, Finding(f"ROS_IP is {name!r}, and that is no IP address", remedy)]
    if "/" in name or ":" in name:
        return [*found, Finding(f"{source} is {name!r}: only a name or an address belongs there, "
                                f"no http:// and no port", remedy)]
    addresses = around.addresses_of(name)
    if not addresses:
        wrong = f"{source} is {name!r}, and not even this machine knows its address"
    elif is_loopback(addresses[0]) and not around.is_mine(master):
        wrong = (f"{source} is {name!r}, which is {addresses[0]}: the master is on another machine "
                 f"({host}), and there that name leads to itself")
    elif not around.is_mine(addresses[0]):
        wrong = f"{source} is {name!r}, which is {addresses[0]}, no address of this machine"
    else:
        return found
    return [*found, Finding(wrong, remedy)]
