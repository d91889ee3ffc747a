"""Runs that begin together take turns, and a lock that cannot be had is one line."""

import pytest

from run_session.failure import RunError
from run_session.master import take_turn


def test_a_turn_is_waited_for_no_longer_than_the_limit(tmp_path):
    path = tmp_path / "run.lock"
    held = take_turn(path)
    with pytest.raises(RunError, match="is held by another run"):
        take_turn(path, 0.1)
    held.close()
    take_turn(path, 0.1).close()


def test_a_lock_that_leads_elsewhere_is_refused(tmp_path):
    """Another user may have put a link where everybody writes."""
    path = tmp_path / "run.lock"
    path.symlink_to(tmp_path / "precious")
    with pytest.raises(RunError, match="export TMPDIR="):
        take_turn(path)
    assert not (tmp_path / "precious").exists()
