"""The terminals in which the tests type."""

import importlib.util
import os
from pathlib import Path

import pytest

pytestmark = pytest.mark.processes
_spec = importlib.util.spec_from_file_location(
    "terminals", Path(__file__).resolve().with_name("terminals.py"))
terminals = importlib.util.module_from_spec(_spec)
_spec.loader.exec_module(terminals)


def test_a_port_for_a_master_is_none_that_a_socket_may_be_given():
    first = int(Path("/proc/sys/net/ipv4/ip_local_port_range").read_text().split()[0])
    assert all(1024 < terminals.free_port() < first for _ in range(20))


def test_a_terminal_is_read_while_nobody_waits_for_it(tmp_path):
    """As a real one: otherwise a command blocks as soon as the kernel's buffer is full."""
    writes = "for i in $(seq 20000); do echo a line of some length; done; echo > done; echo end"
    terminal = terminals.Terminal(writes, tmp_path, dict(os.environ))
    other = terminals.Terminal(
        "while [ ! -e done ]; do sleep 0.05; done; echo seen", tmp_path, dict(os.environ)
    )
    try:
        assert other.wait_until_shown("seen") is None
        assert terminal.wait_until_shown("end") is None
        assert terminal.shown.count("a line") == 20000
    finally:
        terminal.close()
        other.close()


def test_letters_of_several_bytes_stay_whole(tmp_path):
    terminal = terminals.Terminal(
        "printf '\\344'; sleep 0.3; printf '\\275\\240\\n'", tmp_path, dict(os.environ)
    )
    try:
        assert terminal.wait_until_shown("你") is None
    finally:
        terminal.close()


def test_a_colour_that_comes_in_two_parts_is_none_of_the_text(tmp_path):
    terminal = terminals.Terminal(
        "printf 'a\\033[3'; sleep 0.3; printf '1mb\\033]2;ti'; sleep 0.3; printf 'tle\\007c\\n'",
        tmp_path, dict(os.environ)
    )
    try:
        assert terminal.wait_until_shown("abc") is None
    finally:
        terminal.close()


def test_a_terminal_that_is_still_read_keeps_its_file(tmp_path, monkeypatch):
    """Else the reader takes what comes to the next file of that number."""
    monkeypatch.setattr(terminals, "IMPATIENCE", 0.1)
    stays = "echo in a session of its own; while [ ! -e done ]; do sleep 0.1; done"
    terminal = terminals.Terminal(f'setsid sh -c "{stays}" &', tmp_path, dict(os.environ))
    try:
        assert terminal.wait_until_shown("its own") is None
        terminal.close(limit=0.2)
        os.fstat(terminal._keyboard)  # an OSError of one that is closed
    finally:
        (tmp_path / "done").touch()
