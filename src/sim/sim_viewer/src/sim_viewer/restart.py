"""Restarts the node when there is a new ROS master.

A learner leaves the page open and starts the course again: that is a new master, which does not
know this node. rospy cannot change masters, so the process restarts, with the parameters that the
old master had; browsers reconnect by themselves.
"""

import asyncio
import json
import os
import sys
from dataclasses import asdict, replace

import rosgraph

from sim_viewer.context import Node
from sim_viewer.options import TOKEN, Options

PERIOD = 2.0  # s between checks
RUN_ID = "/run_id"  # roslaunch gives each master a new one


async def wait_for_other_master(node: Node) -> None:
    """Return when there is another master than at first; waits while there is none at all."""
    first = await node.run_in_thread(_run_id)
    while True:
        await asyncio.sleep(PERIOD)
        now = await node.run_in_thread(_run_id)
        if first is None:
            first = now
        if now not in (None, first):
            return


def restart(options: Options, port: int) -> None:
    """Replace this process; does not return. The page's address and token stay the same."""
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
