"""Judges the answers of the master and the nodes."""

from __future__ import annotations

from dataclasses import dataclass

from nav_demo.network.settings import Finding, is_loopback, split_uri

SLOW_MS = 100.0   # median of the calls
CLOCKS_APART = 2  # s; an HTTP date has a resolution of 1 s


@dataclass(frozen=True)
class Node:
    """A node as registered. `address`: its host's address, resolved here; "" if unknown."""

    name: str
    uri: str
    address: str
    answer: str  # "yes", "refused" (nothing listens there), "silence"


def check_nodes(nodes: list[Node], master_is_here: bool) -> list[Finding]:
    """Wrong or unreachable addresses; one line for all nodes with the same error."""
    wrong: dict[tuple[str, str], list[str]] = {}
    for node in nodes:
        judged = _judged(node, master_is_here)
        if judged:
            wrong.setdefault(judged, []).append(node.name)
    return [Finding(f"{_names(names)}: {sentence}", remedy)
            for (sentence, remedy), names in wrong.items()]


def _judged(node: Node, master_is_here: bool) -> tuple[str, str] | None:
    """A node's error and its remedy."""
    place = split_uri(node.uri)
    if place is None:
        return f"registered at {node.uri!r}, and that is no address", "rosnode cleanup"
    host, port = place
    there = "(on the machine where it runs; then start it again)"
    if not node.address:
        return (f"registered as {host!r}, and this machine knows no address of it",
                f"echo 'ADDRESS {host}' | sudo tee -a /etc/hosts, with that machine's address; or "
                f"export ROS_IP=ADDRESS {there}")
    if node.answer == "yes":
        return None
    if is_loopback(node.address) and not master_is_here:
        return (f"registered as {host!r}, which leads each machine to itself",
                f"export ROS_IP=ADDRESS; unset ROS_HOSTNAME {there}")
    if node.answer == "refused":
        return f"registered at {host}:{port}, but nobody listens there any more", "rosnode cleanup"
    return (f"no answer at {host}:{port} ({node.address})",
            f"ping -c 3 {node.address}; if that answers, a firewall is between: sudo ufw allow "
            f"from ADDRESS_OF_THIS_MACHINE, there")


def _names(names: list[str]) -> str:
    listed = ", ".join(names[:3])
    return f"{listed} and {len(names) - 3} more nodes" if len(names) > 3 else listed


def check_master_answer(answer: str, host: str, port: int) -> list[Finding]:
    """Whether there is a master at ROS_MASTER_URI; `answer` as in Node, or "other"."""
    place = f"{host}:{port}"
    alone = "" if host == "localhost" else ", or it listens to its own machine alone"
    wrong, remedy = {
        "yes": ("", ""),
        "refused": (f"nobody listens at {place}: there is no master{alone}",
                    f"on {host}: export ROS_HOSTNAME={host}; roscore"),
        "silence": (f"no answer from {place}: the address is wrong, or a firewall is between",
                    f"ping -c 3 {host}"),
        "other": (f"what listens at {place} is not a ROS master",
                  f"roscore -p OTHER_PORT, on {host}, and that port in ROS_MASTER_URI"),
    }[answer]
    return [Finding(wrong, remedy)] if wrong else []


def check_callback(came: bool, name: str, host: str, address: str) -> list[Finding]:
    """Whether the master's machine can call this one by its registered name."""
    if came:
        return []
    return [Finding(f"the master on {host} cannot call this machine by {name!r}: nodes there will "
                    f"not hear nodes here",
                    f"export ROS_IP={address}; unset ROS_HOSTNAME")]


def check_latency(calls_ms: list[float], host: str) -> list[Finding]:
    """Whether calls to the master, ms each, are slow."""
    median = sorted(calls_ms)[len(calls_ms) // 2]
    if median <= SLOW_MS:
        return []
    return [Finding(f"a call to the master takes {median:.0f} ms: images and scans will come late",
                    f"ping -c 10 {host}, and use a cable instead of wireless")]


def check_clock(use_sim_time: bool, has_clock: bool, ahead_s: float | None,
                host: str) -> list[Finding]:
    """Clocks. `ahead_s`: the master's clock minus this one's, s; None if unknown."""
    if use_sim_time:
        return [] if has_clock else [Finding(
            "nobody publishes /clock, and /use_sim_time is true: every node waits for time to pass",
            "rosparam set /use_sim_time false, or start the simulator")]
    found = [] if not has_clock else [Finding(
        "somebody publishes /clock, but /use_sim_time is not true: nodes go by the wall's clock",
        "rosparam set /use_sim_time true, and start the nodes again")]
    if ahead_s is not None and abs(ahead_s) > CLOCKS_APART:
        wrong = (f"the clock of {host} is {ahead_s:.0f} s ahead of this one: transforms will be in "
                 f"the future" if ahead_s > 0 else
                 f"the clock of {host} is {-ahead_s:.0f} s behind this one: transforms will be too "
                 f"old")
        found.append(Finding(wrong, "sudo timedatectl set-ntp true, on both machines"))
    return found
