"""A node's process, and how long processors worked for it: on a busy machine no more than else."""

import time
import xmlrpc.client

import rosgraph


def process_of(node: str) -> int:
    """Its number."""
    return xmlrpc.client.ServerProxy(rosgraph.Master("/test").lookupNode(node)).getPid("/test")[2]


def processor_time(process: int) -> float:
    """s, of all its threads since it began."""
    return time.clock_gettime(~process << 3 | 2)  # Linux's number of another process's clock
