"""What ends a roslaunch: at once, a refusal of ours or Ctrl-C; not a SIGHUP that nohup ignores."""

import signal
from types import SimpleNamespace

from node_basics.refusing import REFUSED


def amend_loader(loader):
    """Let the refusal of a <param>'s program end roslaunch with exit code 1.

    `loader` is the module roslaunch.loader. roslaunch itself would call it an invalid <param> tag,
    on three more lines.
    """
    value_of = loader.Loader.param_value

    def param_value(self, *words):
        try:
            return value_of(self, *words)
        except ValueError as error:
            if f"with code [{REFUSED}]" in str(error):
                raise SystemExit(1) from None
            raise

    loader.Loader.param_value = param_value


def amend_packages(packages):
    """Read many package.xml without a pool of processes; `packages`: catkin_pkg.packages.

    At a Ctrl-C each process of the pool prints a traceback, and roslaunch may wait for one for
    ever. 157 files take 0.05 s in one process and 0.09 in two.
    """
    def no_pool():
        raise OSError  # as where there can be none; it reads one after the other then

    packages.multiprocessing = SimpleNamespace(Pool=no_pool)


def amend_signals(pmon):
    """Let `nohup roslaunch` go on when its terminal closes; `pmon` is the module roslaunch.pmon.

    roslaunch itself would take back SIGHUP, which is ignored at its start then, and end.
    """
    if signal.getsignal(signal.SIGHUP) is signal.SIG_IGN:
        pmon._signal_list.remove(signal.SIGHUP)
