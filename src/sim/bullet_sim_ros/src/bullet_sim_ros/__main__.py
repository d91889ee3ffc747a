"""The process of the node; a Ctrl-C while its modules load, or at its end, prints nothing."""

import signal
import sys


def main() -> int:
    """The exit code; 130 after a Ctrl-C before there is a loop."""
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
