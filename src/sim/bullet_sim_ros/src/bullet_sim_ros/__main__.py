"""The node's entry point; a Ctrl-C while modules load, or at the end, prints no traceback."""

import signal
import sys


def main() -> int:
    """Run the node; returns the exit code, 130 after a Ctrl-C before the loop runs."""
    signal.signal(signal.SIGINT, signal.SIG_DFL)
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
