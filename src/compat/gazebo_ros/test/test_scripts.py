"""The shell scripts beside the server: remappings to the end, and what gdbrun asks for."""

import subprocess
from pathlib import Path

SCRIPTS = Path(__file__).resolve().parents[1] / "scripts"


def shell(command: str, **options) -> subprocess.CompletedProcess:
    return subprocess.run(["sh", "-c", command], capture_output=True, text=True, **options)


def test_remappings_are_moved_to_the_end():
    # conforms: libcommon.sh
    moved = shell(f'. {SCRIPTS}/libcommon.sh; relocate_remappings -u __name:=gazebo -e ode a:=b w')
    assert moved.stdout == "-u -e ode w __name:=gazebo a:=b\n"


def test_gdbrun_hands_the_program_to_gdb(tmp_path):
    # conforms: gdbrun, gdbrun/--break-main
    (tmp_path / "gdb").write_text('#!/bin/sh\nprintf "%s|" "$@"\n')
    (tmp_path / "gdb").chmod(0o755)
    path = {"PATH": f"{tmp_path}:/usr/bin:/bin"}
    assert shell(f"{SCRIPTS}/gdbrun prog -x 1", env=path).stdout == "-ex|run|--args|prog|-x|1|"
    assert shell(f"{SCRIPTS}/gdbrun --break-main prog", env=path).stdout == \
        "-ex|break main|-ex|run|--args|prog|"


def test_gdbrun_says_what_is_missing(tmp_path):
    without = shell(f"{SCRIPTS}/gdbrun", env={"PATH": "/usr/bin:/bin"})
    assert without.returncode == 2 and "gdbrun [--break-main] PROGRAM" in without.stderr
    for tool in ("env", "bash"):
        (tmp_path / tool).symlink_to(f"/usr/bin/{tool}")
    no_gdb = subprocess.run(["/bin/bash", SCRIPTS / "gdbrun", "prog"], capture_output=True,
                            text=True, env={"PATH": str(tmp_path)})
    assert no_gdb.returncode == 1 and "sudo apt-get install gdb" in no_gdb.stderr
