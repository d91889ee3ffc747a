"""A file of results is whole, or the one of before."""

import errno
import os
import re
import shlex
import subprocess
import sys
import textwrap
from pathlib import Path
from types import SimpleNamespace

import pytest

from run_session.files import check_space, world_argument, write_whole

# In a process of its own, whose files may get no longer than 1000 bytes: as on a full disk.
WRITE_TWICE = textwrap.dedent("""
    import resource, signal, sys
    from pathlib import Path
    from run_session.files import write_whole

    signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # else it ends the process
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, 1000))
    write_whole(Path(sys.argv[1]), b"{}")
    try:
        write_whole(Path(sys.argv[1]), bytes(2000))
    except OSError as refused:
        print(refused.errno, refused.filename)
""")


@pytest.mark.parametrize("path", ["/a/course.world", "/my runs/评分/it's.world"])
def test_a_worlds_path_stays_one_word_in_a_launch_file(path):
    name, _, value = world_argument(Path(path)).partition(":=")
    assert name == "world_name" and shlex.split(f"-e ode {value}") == ["-e", "ode", path]


def test_what_cannot_be_written_leaves_the_file_of_before(tmp_path):
    path = tmp_path / "report.json"
    done = subprocess.run([sys.executable, "-c", WRITE_TWICE, str(path)], capture_output=True,
                          text=True, timeout=60, check=False)
    assert done.stdout.split() == [str(errno.EFBIG), str(path)], done.stderr
    assert path.read_bytes() == b"{}" and list(tmp_path.iterdir()) == [path]


def test_an_interruption_leaves_nothing_beside_the_file(tmp_path, monkeypatch):
    def interrupt(*_):
        raise KeyboardInterrupt

    (tmp_path / "report.json").write_bytes(b"{}")
    monkeypatch.setattr(Path, "replace", interrupt)
    with pytest.raises(KeyboardInterrupt):
        write_whole(tmp_path / "report.json", b"[]")
    assert [path.read_bytes() for path in tmp_path.iterdir()] == [b"{}"]


def test_an_error_names_the_file_that_was_asked_for(tmp_path):
    (tmp_path / "out").write_bytes(b"")
    with pytest.raises(NotADirectoryError) as refused:
        write_whole(tmp_path / "out" / "report.json", b"{}")
    assert refused.value.filename == str(tmp_path / "out" / "report.json")


def test_a_full_disk_is_named_and_one_with_room_is_none(tmp_path, monkeypatch):
    check_space(tmp_path)
    full = SimpleNamespace(f_blocks=9, f_bavail=1, f_frsize=4096, f_files=0, f_favail=0)
    monkeypatch.setattr(os, "statvfs", lambda _folder: full)
    with pytest.raises(OSError, match=re.escape(str(tmp_path))) as said:
        check_space(tmp_path)
    assert said.value.errno == errno.ENOSPC
    no_more_files = SimpleNamespace(f_blocks=2**20, f_bavail=2**20, f_frsize=4096, f_files=100,
                                    f_favail=0)
    monkeypatch.setattr(os, "statvfs", lambda _folder: no_more_files)
    with pytest.raises(OSError):
        check_space(tmp_path)


def test_a_file_system_that_counts_no_blocks_is_not_full(tmp_path, monkeypatch):
    uncounted = SimpleNamespace(f_blocks=0, f_bavail=0, f_frsize=512, f_files=0, f_favail=0)
    monkeypatch.setattr(os, "statvfs", lambda _folder: uncounted)
    check_space(tmp_path)
