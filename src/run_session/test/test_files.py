"""A file of results is whole, or the one of before."""

import errno
import resource
import signal

import pytest

from run_session.files import write_whole


@pytest.fixture
def short_files():
    """No file of this process may get longer than 1000 bytes: as on a full disk, writing ends."""
    before = resource.getrlimit(resource.RLIMIT_FSIZE)
    ignored = signal.signal(signal.SIGXFSZ, signal.SIG_IGN)  # else it ends the process
    resource.setrlimit(resource.RLIMIT_FSIZE, (1000, before[1]))
    yield
    resource.setrlimit(resource.RLIMIT_FSIZE, before)
    signal.signal(signal.SIGXFSZ, ignored)


def test_what_cannot_be_written_leaves_the_file_of_before(tmp_path, short_files):
    path = tmp_path / "report.json"
    write_whole(path, b"{}")
    with pytest.raises(OSError) as refused:
        write_whole(path, bytes(2000))
    assert (refused.value.errno, refused.value.filename) == (errno.EFBIG, str(path))
    assert path.read_bytes() == b"{}" and list(tmp_path.iterdir()) == [path]
