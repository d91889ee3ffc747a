"""The node /sim_viewer: asyncio and the server in the main thread, rospy's threads beside it.

A learner leaves the page open and starts the course again: that is a new master, which does not
know this node. rospy cannot change masters, so the process restarts, with the parameters that the
old master had; browsers reconnect by themselves.
"""

import asyncio
import ctypes
import json
import os
import signal
import sys
import webbrowser
from dataclasses import asdict, replace

import rosgraph
import rospy
from rosgraph.network import get_local_addresses

from bullet_sim_ros.already_running import full_name, registering
from sim_viewer import registry
from sim_viewer.options import TOKEN, OptionError, Options, read_options
from sim_viewer.registry import Node
from sim_viewer.running_page import RUNS_ALREADY, running_page, why_another_port
from sim_viewer.rviz.config import ConfigError, read_config
from sim_viewer.server import NoPort, Server
from sim_viewer.urls import further_urls, page_url

M_MMAP_THRESHOLD = -3  # of glibc's malloc.h
LARGE = 1 << 20  # bytes
PERIOD = 2.0  # s between checks
RUN_ID = "/run_id"  # roslaunch gives each master a new one


def give_back_large_blocks() -> None:
    """From now on, return large blocks to the system as soon as they are freed.

    By default glibc raises this threshold to 32 MB when such a block is freed. Then each worker
    thread keeps the memory of its clouds and maps: 0.8 GB after some minutes.
    """
    ctypes.CDLL(None).mallopt(M_MMAP_THRESHOLD, LARGE)


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


def main(name: str = "sim_viewer", rviz: str = "") -> None:
    """Run until Ctrl-C, or until ROS ends the node of this name. `rviz`: a .rviz file.

    If a page of this master runs already, say where, and exit with 1 if it lacks what is asked for.
    """
    give_back_large_blocks()
    try:
        with registering(rosgraph.get_master_uri(), full_name(name)):
            said = running_page(name, rviz)
            if said:
                print(said[0] % said[1:], flush=True)
                sys.exit(0 if said[0] == RUNS_ALREADY else 1)
            # The loop handles the signals; roslaunch and Ctrl-C end this node with SIGINT.
            rospy.init_node(name, disable_signals=True)
        registry.load_all()
        asyncio.run(_serve(rviz))
    except (OptionError, ConfigError, NoPort) as error:
        rospy.signal_shutdown(str(error))
        sys.exit(f"{name}: {error}")
    except (KeyboardInterrupt, rospy.ROSInterruptException):
        pass  # before the loop handled the signals
    rospy.signal_shutdown("the page has ended")


async def _serve(rviz: str) -> None:
    loop = asyncio.get_running_loop()
    end = asyncio.Event()
    for number in (signal.SIGINT, signal.SIGTERM):
        loop.add_signal_handler(number, end.set)
    rospy.on_shutdown(lambda: loop.is_closed() or loop.call_soon_threadsafe(end.set))
    options = read_options()
    if rviz:
        options = replace(options, rviz=rviz)
    if options.rviz:
        read_config(options.rviz)
    node = Node(options, loop)
    server = Server(node)
    try:
        port = await server.start()
        await _announce(node, port)
        ended = asyncio.create_task(end.wait())
        renewed = asyncio.create_task(wait_for_other_master(node))
        await asyncio.wait([ended, renewed], return_when=asyncio.FIRST_COMPLETED)
        renewed.cancel()
    finally:
        await server.close()
        node.close()
    if not end.is_set():
        print("viewer: there is another ROS master; starting again", flush=True)
        restart(options, port)


async def _announce(node: Node, port: int) -> None:
    """Print the page's address, set it as the parameter `~url`, and open it if that is wanted."""
    tab = "#rviz" if node.options.rviz else ""
    if port != node.options.port:
        print(await node.run_in_thread(why_another_port, node.options, port))
    url = page_url(node.options, port) + tab
    print(f"viewer: {url}", flush=True)
    for further in further_urls(node.options, port, get_local_addresses()):
        print(f"viewer, from other machines: {further}{tab}", flush=True)
    # For those who missed the line; without the token, since anybody can read parameters.
    public = page_url(replace(node.options, token=""), port)
    await node.run_in_thread(rospy.set_param, "~url", public)
    if node.options.open:
        await node.run_in_thread(webbrowser.open, url)
