#!/usr/bin/env python3
"""A node that lives as the spawner does; its work swallows interruptions, as a library may."""

import sys
import time

from controller_manager.lifetime import live


def work():
    try:
        print("at work", flush=True)
        time.sleep(60.0)
    except BaseException:  # (as rospy's logging has it)
        print("swallowed", flush=True)


sys.exit(live("swallower", work, lambda: print("undone", flush=True)))
