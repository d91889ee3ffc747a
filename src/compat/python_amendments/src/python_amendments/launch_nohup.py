"""Lets `nohup roslaunch` go on when its terminal closes, as nohup does with any other program."""

import signal


def amend(pmon):
    """Leave SIGHUP ignored where it is at the start; `pmon` is the module roslaunch.pmon.

    roslaunch itself would take it back, and end.
    """
    if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
        pmon._signal_list.remove(signal.SIGHUP)
