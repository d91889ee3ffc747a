"""Starts the node anew when the ROS master is another one.

A learner leaves the page open and starts the course again: that is a new master, which knows
nothing of this node. rospy cannot change masters, so the process begins again, with the parameters
that the old master had; browsers connect again by themselves.
"""

import asyncio
import json
import os
import sys
from dataclasses import asdict, replace

import rosgraph

from sim_viewer.context import Node
from sim_viewer.options import TOKEN, Options

PERIOD = 2.0  # s between looks
RUN_ID = "/run_id"  # roslaunch gives each master another one


async def wait_for_other_master(node: Node) -> None:
    """Returns when there is one; while there is none it waits."""
    first = await node.run_in_thread(_run_id)
    while True:
        await asyncio.sleep(PERIOD)
        now = await node.run_in_thread(_run_id)
        if first is None:
            first = now
        if now not in (None, first):
            return


def restart(options: Options, port: int) -> None:
    """Does not return. Page and token stay where they are."""
    words = parameter_words(replace(options, port=port, open=False))
    kept = [word for word in sys.argv if not word.startswith("_") or word.startswith("__")]
    os.execve(sys.executable, [sys.executable, *kept, *words],
              {**os.environ, TOKEN: options.token})


def parameter_words(options: Options) -> list[str]:
    """The options as words of a command line, `_port:=8080`; all but the token."""
    values = {**asdict(options), "hosts": ",".join(options.hosts)}
    return [f"_{name}:={json.dumps(value)}" for name, value in values.items() if name != "token"]


def _run_id() -> str | None:
    try:
        return rosgraph.Master("/sim_viewer").getParam(RUN_ID)
    except (OSError, rosgraph.MasterException):
        return None
