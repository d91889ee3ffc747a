"""pdb for a node's threads: what breakpoint() asks with; imported at the first one."""

import atexit
import os
import pdb
import signal
import sys
import termios
import threading

ENDING = 5.0  # s, wall, for rospy's handler to end the node, in another thread
ONE_AT_A_TIME = threading.Lock()
# A thread that is asking while the node ends leaves the terminal as a line is edited in it.
atexit.register(termios.tcsetattr, sys.stdin, termios.TCSANOW, termios.tcgetattr(sys.stdin))


class Asking(pdb.Pdb):
    """One thread at a time; to quit it, or Ctrl-C, ends the node."""

    def __init__(self, core):
        super().__init__(nosigint=True)  # Ctrl-C stays rospy's, also after `continue`
        self._core = core
        self._has_turn = False

    def interaction(self, *words):
        if not self._has_turn:
            ONE_AT_A_TIME.acquire()
            self._has_turn = True
        if self._core.is_shutdown():
            self.set_quit()
            return
        if threading.current_thread() is not threading.main_thread():
            super().interaction(*words)
            return
        rospys = signal.getsignal(signal.SIGINT)

        def interrupt(number, at):
            rospys(number, at)
            raise SystemExit(0)  # pdb goes on asking after a KeyboardInterrupt

        signal.signal(signal.SIGINT, interrupt)
        try:
            super().interaction(*words)
        finally:
            signal.signal(signal.SIGINT, rospys)

    def set_continue(self):
        super().set_continue()
        self._give_turn()

    def set_quit(self):
        """End the node as Ctrl-C does; nothing of the frame that was left is run any more."""
        super().set_quit()
        self._give_turn()
        if not self._core.is_shutdown():
            os.kill(os.getpid(), signal.SIGINT)
            for _ in range(int(ENDING / 0.01)):
                if self._core.is_shutdown():
                    break
                threading.Event().wait(0.01)
        raise SystemExit(0)  # rospy shows a traceback for pdb's own

    def _give_turn(self):
        if self._has_turn:
            self._has_turn = False
            ONE_AT_A_TIME.release()
