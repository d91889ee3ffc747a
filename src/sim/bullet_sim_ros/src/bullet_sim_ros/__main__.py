"""The node's entry point; a Ctrl-C while modules load, or at the end, prints no traceback."""

import ctypes
import signal
import sys

PR_SET_NAME = 15  # of prctl(2)


def main() -> int:
    """Run the node; returns the exit code, 130 after a Ctrl-C before the loop runs."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
    ctypes.CDLL(None).prctl(PR_SET_NAME, b"gzserver")  # Gazebo's name, for killall and pgrep
    from bullet_sim_ros import node
    signal.signal(signal.SIGINT, signal.default_int_handler)
    try:
        return node.main()
    except KeyboardInterrupt:
        return 130
    finally:
        signal.signal(signal.SIGINT, signal.SIG_DFL)


if __name__ == "__main__":
    sys.exit(main())
