"""The sandbox of a submission: bubblewrap, and limits of the kernel's.

Inside there are the system and the workspace, read-only, the submission, and an empty home. Of
processes it sees its own; the network is the case's own loopback (see `namespace`).
"""

from __future__ import annotations

import contextlib
import enum
import os
import shutil
import signal
import subprocess
import threading
import time
from collections.abc import Mapping
from dataclasses import fields
from pathlib import Path

from evaluation.session.failure import RunError
from evaluation.session.processes import descendants
from marking.rules import Limits
from marking.text import one_line

SYSTEM = ("/usr",)
# What Python, ROS, OpenCV and the dynamic linker read there, and no more.
ETC = ("alternatives", "fonts", "group", "hosts", "ld.so.cache", "ld.so.conf", "ld.so.conf.d",
       "localtime", "nsswitch.conf", "passwd", "python3", "python3.11", "python3.13", "ros",
       "ssl/openssl.cnf")
WORKSPACE = ("src", "devel", ".venv")
HOME, SUBMISSION = "/home/student", "/home/submission"
KEPT_OUTPUT = 64 * 1024  # bytes of the student's output that are kept
FIRST_UID = 2_000_000_000  # of users that nobody has
OPEN_FILES = 512
GUARD_PERIOD, END_TIME = 0.1, 2.0  # s, wall
LONGEST_REASON = 200  # characters


class Kind(enum.Enum):
    """How a sandbox is made, for want of one way that works everywhere."""

    ROOT = "root"  # root mounts, then gives up everything
    USER = "user"  # a user namespace
    NONE = "none"  # only limits: --no-sandbox


def available() -> Kind:
    """The kind that this machine allows; RunError if none, with what to do."""
    kind = Kind.ROOT if os.getuid() == 0 else Kind.USER
    if not shutil.which("bwrap"):
        raise RunError("no sandbox: bubblewrap is not installed: apt-get install bubblewrap")
    limits = Limits(*[64.0] * len(fields(Limits)))
    probe = [*namespace(kind), "bwrap", *_view(kind, limits, None, None),
             *_limited(kind, limits), "true"]
    done = subprocess.run(probe, capture_output=True, text=True, timeout=20, check=False)
    if done.returncode:
        why = done.stderr.strip().splitlines()[-1:] or ["no reason given"]
        raise RunError(f"no sandbox: this machine allows no namespaces ({why[0]}); in Docker give "
                       "--privileged; --no-sandbox runs submissions unprotected")
    return kind


def namespace(kind: Kind) -> list[str]:
    """What a case's own program is started with: a network of its own, with loopback alone."""
    if kind is Kind.NONE:
        return []
    return ["unshare", "--net", *(["--user", "--map-root-user"] if kind is Kind.USER else [])]


class Box:
    """One submission's program, running; its output goes to a file, bounded."""

    def __init__(self, kind: Kind, folder: Path, program: Path, workspace: Path, limits: Limits,
                 environment: Mapping[str, str], output: Path):
        """Start it. `folder` holds the submission, `program` is relative to it."""
        self._limits = limits
        if kind is Kind.NONE:
            where, python, view = str(folder), str(workspace / ".venv/bin/python3"), []
        else:
            where, python = SUBMISSION, str(workspace / ".venv/bin/python3")
            view = ["bwrap", *_view(kind, limits, workspace, folder)]
        path = environment.get("PYTHONPATH", "")
        own = {"PYTHONPATH": f"{where}/src:{path}" if (folder / "src").is_dir() else path,
               "PYTHONUNBUFFERED": "1", "PYTHONDONTWRITEBYTECODE": "1"}
        if kind is not Kind.NONE:
            own |= {"HOME": HOME, "ROS_LOG_DIR": HOME, "ROS_HOME": HOME}
        command = [*view, *_limited(kind, limits), python, f"{where}/{program}"]
        self._process = subprocess.Popen(
            command, cwd=folder if kind is Kind.NONE else "/", env={**environment, **own},
            stdin=subprocess.DEVNULL, stdout=subprocess.PIPE, stderr=subprocess.STDOUT,
            start_new_session=True)
        self._output, self._printed, self._excess = output, 0, ""
        self._threads = [threading.Thread(target=each, daemon=True)
                         for each in (self._read, self._guard)]
        for thread in self._threads:
            thread.start()

    def fault(self) -> str:
        """Why it has ended, in one line; "": it runs."""
        if self._process.poll() is None:
            return ""
        for thread in self._threads:
            thread.join(END_TIME)
        return self._excess or (
            f"the program ended ({_describe(self._process.returncode)}){self._last_words()}")

    def end(self) -> None:
        """Kill it with all that it started."""
        self._kill()
        self._process.wait()
        for thread in self._threads:
            thread.join(END_TIME)

    def _kill(self) -> None:
        below = [pid for pid, _ in descendants(self._process.pid)]
        for pid in (self._process.pid, *below):
            with contextlib.suppress(ProcessLookupError):
                os.kill(pid, signal.SIGKILL)

    def _guard(self) -> None:
        """End it where it uses too much: what the kernel limits only for each process."""
        limits = self._limits
        while self._process.poll() is None and not self._excess:
            used_mb = sum(_resident_bytes(pid)
                          for pid, _ in descendants(self._process.pid)) / 1e6
            if self._printed > limits.output_mb * 1e6:
                self._excess = f"it printed more than {limits.output_mb:g} MB"
            elif used_mb > limits.memory_mb:
                self._excess = f"it used more than {limits.memory_mb:g} MB of memory"
            time.sleep(GUARD_PERIOD)
        if self._excess:
            self._kill()

    def _read(self) -> None:
        with self._output.open("wb") as file:
            while block := self._process.stdout.read1(65536):
                file.write(block[:max(0, KEPT_OUTPUT - self._printed)])
                self._printed += len(block)

    def _last_words(self) -> str:
        text = self._output.read_text(encoding="utf-8", errors="replace")
        lines = [line for line in map(one_line, text.splitlines()) if line]
        return f": {lines[-1][:LONGEST_REASON]}" if lines else ""


def _view(kind: Kind, limits: Limits, workspace: Path | None, folder: Path | None) -> list[str]:
    """bubblewrap's options: what there is to see, and which namespaces are its own."""
    size = ["--size", str(int(limits.disk_mb * 2**20))]
    return [
        *(["--unshare-user", "--uid", "1000", "--gid", "1000"] if kind is Kind.USER else []),
        "--unshare-pid", "--unshare-ipc", "--unshare-uts", "--die-with-parent", "--new-session",
        "--cap-drop", "ALL", *(_kept_capabilities() if kind is Kind.ROOT else []),
        # Folders above a mount are closed to others unless they are made before it.
        *[word for above in ("/etc", "/etc/ssl", str(Path(HOME).parent), *_folders_above(workspace))
          for word in ("--perms", "755", "--dir", above)],
        *[word for path in SYSTEM for word in ("--ro-bind", path, path)],
        *[word for name in ("bin", "lib", "lib64", "sbin") if os.path.islink(f"/{name}")
          for word in ("--symlink", f"usr/{name}", f"/{name}")],
        *[word for name in ETC for word in ("--ro-bind-try", f"/etc/{name}", f"/etc/{name}")],
        *[word for name in WORKSPACE if workspace
          for word in ("--ro-bind", str(workspace / name), str(workspace / name))],
        *(["--ro-bind", str(folder), SUBMISSION] if folder else []),
        "--proc", "/proc", "--dev", "/dev",
        *[word for path in ("/tmp", "/dev/shm", HOME)
          for word in ("--perms", "1777", *size, "--tmpfs", path)],
        "--remount-ro", "/dev", "--remount-ro", "/", "--chdir", HOME,
    ]  # fmt: skip


def _folders_above(workspace: Path | None) -> list[str]:
    """The workspace's own folder, and all above it but /."""
    if workspace is None:
        return []
    return [str(each) for each in (*reversed(workspace.parents), workspace)][1:]


def _kept_capabilities() -> list[str]:
    """To become another user, which drops these, too."""
    return ["--cap-add", "CAP_SETUID", "--cap-add", "CAP_SETGID"]


def _limited(kind: Kind, limits: Limits) -> list[str]:
    """Commands that set the kernel's limits and go on as a user who is nobody else."""
    # The kernel counts processes by user: for each sandbox another.
    user = str(FIRST_UID + os.getpid())
    change = ["setpriv", "--reuid", user, "--regid", user, "--clear-groups", "--inh-caps=-all",
              "--no-new-privs"] if kind is Kind.ROOT else []
    memory, disk = int(limits.memory_mb * 1e6), int(limits.disk_mb * 1e6)
    return [
        *change, "prlimit", f"--nproc={int(limits.processes)}" if kind is not Kind.NONE else
        "--core=0", f"--cpu={max(1, int(limits.cpu_s))}", f"--data={memory}", f"--fsize={disk}",
        f"--nofile={OPEN_FILES}", "--core=0",
    ]  # fmt: skip


def _resident_bytes(pid: int) -> int:
    try:
        return int(Path(f"/proc/{pid}/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")
    except (OSError, IndexError):
        return 0  # it has just ended


def _describe(code: int) -> str:
    number = -code if code < 0 else code - 128  # bubblewrap adds 128 to a signal
    try:
        return f"killed by {signal.Signals(number).name}" if number > 0 else f"exit code {code}"
    except ValueError:
        return f"exit code {code}"
