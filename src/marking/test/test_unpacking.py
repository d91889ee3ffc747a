"""Archives of strangers: what is unpacked, and what is refused in one line."""

import os
import zipfile
from hashlib import sha256

import made_up
import pytest
from marking.submissions import MOST_BYTES, UnpackError, digest, find_submissions, prepare, unpack

PATTERNS = ("follower.py", "*follow*.py", "main.py")
REFUSED = [name for name, (_, row, *_) in made_up.ARCHIVES.items() if row]
ACCEPTED = [name for name, (_, row, *_) in made_up.ARCHIVES.items() if not row]


@pytest.mark.parametrize("name", REFUSED)
def test_what_cannot_be_run_is_one_line_and_leaves_nothing_outside(tmp_path, name):
    expected = made_up.write(tmp_path / "in", {name})
    [submission] = find_submissions(tmp_path / "in")
    with pytest.raises(UnpackError) as refused:
        prepare(submission, tmp_path / "out" / "here", PATTERNS)
    assert expected[submission.student][0] in str(refused.value)
    assert "\n" not in str(refused.value)
    assert not list(tmp_path.glob("*.py"))


@pytest.mark.parametrize("name", ACCEPTED)
def test_the_program_of_an_archive_is_found(tmp_path, name):
    made_up.write(tmp_path / "in", {name})
    [submission] = find_submissions(tmp_path / "in")
    program = prepare(submission, tmp_path / "out", PATTERNS)
    assert "follower" in program.name
    assert (tmp_path / "out" / program).is_file()


def test_names_that_chinese_windows_wrote_are_read(tmp_path):
    archive = tmp_path / "a.zip"
    with zipfile.ZipFile(archive, "w") as made:
        made.writestr("AAAA.py", "")
    raw = archive.read_bytes().replace(b"AAAA", "小车".encode("gbk"))
    archive.write_bytes(raw)
    unpack(archive, tmp_path / "out")
    assert [path.name for path in (tmp_path / "out").iterdir()] == ["小车.py"]


def test_two_submissions_of_one_student_are_not_run(tmp_path):
    (tmp_path / "ann.py").write_text("")
    (tmp_path / "ann.zip").write_bytes(b"")
    [submission] = find_submissions(tmp_path)
    assert submission.fault == "ann.py and ann.zip are both ann's"


def test_a_link_in_a_folder_is_refused(tmp_path):
    (tmp_path / "in" / "ann").mkdir(parents=True)
    (tmp_path / "in" / "ann" / "follower.py").symlink_to("/etc/passwd")
    [submission] = find_submissions(tmp_path / "in")
    with pytest.raises(UnpackError, match="symbolic link"):
        prepare(submission, tmp_path / "out", PATTERNS)


def test_a_pipe_that_is_called_an_archive_is_not_waited_for(tmp_path):
    os.mkfifo(tmp_path / "a.zip")
    with pytest.raises(UnpackError, match=r"a\.zip: is not a file"):
        unpack(tmp_path / "a.zip", tmp_path / "out")


def test_what_is_more_than_can_be_unpacked_is_not_read_for_the_digest(tmp_path, monkeypatch):
    monkeypatch.setattr("hashlib.file_digest", lambda *_: pytest.fail("it was read"))
    with (tmp_path / "a.zip").open("wb") as file:
        file.truncate(2**36)  # takes no room on the disk
    assert digest(tmp_path / "a.zip")


def test_of_many_files_no_more_is_read_than_can_be_unpacked(tmp_path, monkeypatch):
    read = []
    monkeypatch.setattr("hashlib.file_digest", lambda file, _: read.append(file.name) or sha256())
    for name in "abc":
        with (tmp_path / name).open("wb") as file:
            file.truncate(MOST_BYTES // 2)
    assert digest(tmp_path) and len(read) == 2


def test_a_large_submission_that_has_changed_has_another_digest(tmp_path):
    """A tar of the same size: its files may be few enough to be unpacked."""
    tar = tmp_path / "a.tar"
    with tar.open("wb") as file:
        file.truncate(MOST_BYTES + 10240)
    before = digest(tar)
    assert digest(tar) == before
    with tar.open("r+b") as file:
        file.write(b"another")
    os.utime(tar, ns=(0, tar.stat().st_mtime_ns + 1))
    assert digest(tar) != before


def test_a_changed_submission_has_another_digest(tmp_path):
    folder = tmp_path / "ann"
    folder.mkdir()
    (folder / "a.py").write_text("1")
    first = digest(folder)
    assert digest(folder) == first
    (folder / "a.py").write_text("2")
    changed = digest(folder)
    (folder / "a.py").rename(folder / "b.py")
    (folder / "link").symlink_to("/etc/passwd")
    assert len({first, changed, digest(folder), digest(folder / "b.py")}) == 4
