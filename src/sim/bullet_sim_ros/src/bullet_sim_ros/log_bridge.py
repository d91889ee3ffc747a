"""Forwards the core's log to rosout, so that one console shows everything."""

import logging


class _ToRosout(logging.Handler):
    def emit(self, record: logging.LogRecord) -> None:
        logging.getLogger("rosout").log(record.levelno, "%s", record.getMessage())


def forward_core_log(verbose: bool) -> None:
    """Forward it; to be called once, after init_node."""
    core = logging.getLogger("bullet_sim")
    core.setLevel(logging.INFO if verbose else logging.WARNING)
    core.addHandler(_ToRosout())
    core.propagate = False
