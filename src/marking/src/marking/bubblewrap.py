"""The sandbox of a submission: bubblewrap, and the kernel's resource limits.

Inside there are the system and the workspace, read-only, the submission, and an empty home. It
sees only its own processes; the network is the case's own loopback (see `namespace`).
"""

from __future__ import annotations

import enum
import os
import shutil
import subprocess
import sys
from dataclasses import fields
from pathlib import Path

from marking.rules import Limits
from run_session.failure import RunError
from run_session.files import find_package

# The entries of /etc that Python, ROS, OpenCV and the dynamic linker read.
ETC = ("alternatives", "fonts", "group", "hosts", "ld.so.cache", "ld.so.conf", "ld.so.conf.d",
       "localtime", "nsswitch.conf", "passwd", "python3", "python3.11", "python3.13", "ros",
       "ssl/openssl.cnf")
HOME, SUBMISSION = "/home/student", "/home/submission"
FIRST_UID = 2_000_000_000  # user ids from here on are not in use
OPEN_FILES = 512


class Kind(enum.Enum):
    """How a sandbox is made; no single way works everywhere."""

    ROOT = "root"  # root mounts, then gives up everything
    USER = "user"  # a user namespace
    NONE = "none"  # only limits: --no-sandbox


def available() -> Kind:
    """The kind that this machine allows; a RunError says what to do if there is none."""
    kind = Kind.ROOT if os.getuid() == 0 else Kind.USER
    if not shutil.which("bwrap"):
        raise RunError("no sandbox: bubblewrap is not installed: apt-get install bubblewrap")
    probe = [*namespace(kind), *sandbox(kind, Limits(*[64.0] * len(fields(Limits)))),
             sys.executable, "-c", ""]
    done = subprocess.run(probe, capture_output=True, text=True, timeout=60, check=False)
    if done.returncode:
        why = done.stderr.strip().splitlines()[-1:] or ["no reason given"]
        who, way = (("root", "") if kind is Kind.ROOT else
                    ("this user", "as root it may be: sudo make mark SUBMISSIONS=DIR; "))
        raise RunError(f"no sandbox: this machine allows {who} no namespaces ({why[0]}); {way}in "
                       "Docker give --privileged; scripts/mark.sh --no-sandbox --submissions DIR "
                       "runs them unprotected")
    return kind


def namespace(kind: Kind) -> list[str]:
    """Command prefix of the case's own process: a network of its own, with only loopback."""
    if kind is Kind.NONE:
        return []
    return ["unshare", "--net", *(["--user", "--map-root-user"] if kind is Kind.USER else [])]


def shown() -> list[Path]:
    """Folders visible to a submission besides the system: the workspace, or its install folder."""
    prefix = Path(sys.prefix)
    beside = (prefix.parent / name for name in ("src", "devel"))
    return [prefix, *(path for path in beside if path.is_dir())]


def hidden() -> list[Path]:
    """Folders within these that a submission sees empty: the shipped rules."""
    return [find_package("marking") / "config"]


def sandbox(kind: Kind, limits: Limits, folder: Path | None = None) -> list[str]:
    """Command prefix of a sandboxed program, which sees `folder` as SUBMISSION."""
    memory, disk = int(limits.memory_mb * 1e6), int(limits.disk_mb * 1e6)
    limited = ["prlimit", f"--cpu={max(1, int(limits.cpu_s))}", f"--data={memory}",
               f"--fsize={disk}", f"--nofile={OPEN_FILES}", "--core=0"]
    if kind is Kind.NONE:
        return limited
    limited.append(f"--nproc={int(limits.processes) * 2}")  # includes threads; Box limits the rest
    if kind is Kind.ROOT:  # the kernel counts processes per user: one user per sandbox
        user = str(FIRST_UID + os.getpid())
        limited = ["setpriv", "--reuid", user, "--regid", user, "--clear-groups",
                   "--inh-caps=-all", "--no-new-privs", *limited]
    return ["bwrap", *_namespaces(kind), *_view(limits, folder), *limited]


def _namespaces(kind: Kind) -> list[str]:
    user = (["--unshare-user", "--uid", "1000", "--gid", "1000"] if kind is Kind.USER else
            ["--cap-add", "CAP_SETUID", "--cap-add", "CAP_SETGID"])  # setpriv drops these, too
    return ["--unshare-pid", "--unshare-ipc", "--unshare-uts", "--die-with-parent",
            "--new-session", "--cap-drop", "ALL", *user]


def _view(limits: Limits, folder: Path | None) -> list[str]:
    size = ["--size", str(int(limits.disk_mb * 2**20))]
    above = {str(each): None for path in shown() for each in reversed(path.parents)}
    return [
        # Parent folders of a mount are not readable by others unless created before it.
        *_each(("--perms", "755", "--dir"), ["/etc", "/etc/ssl", "/home"]),
        "--proc", "/proc", "--dev", "/dev",
        *_each(("--perms", "1777", *size, "--tmpfs"), ["/tmp", "/dev/shm", HOME]),
        *_each(("--perms", "755", "--dir"), list(above)[1:]),  # the workspace may lie in /tmp
        "--ro-bind", "/usr", "/usr",
        *[word for name in ("bin", "lib", "lib64", "sbin") if os.path.islink(f"/{name}")
          for word in ("--symlink", f"usr/{name}", f"/{name}")],
        *[word for path in (*(f"/etc/{name}" for name in ETC), *map(str, shown()))
          for word in ("--ro-bind-try", path, path)],
        *_each(("--perms", "755", "--tmpfs"), list(map(str, hidden()))),
        *_each(("--remount-ro",), list(map(str, hidden()))),
        *(["--ro-bind", str(folder), SUBMISSION] if folder else []),
        "--remount-ro", "/dev", "--remount-ro", "/", "--chdir", HOME,
    ]


def _each(options: tuple[str, ...], paths: list[str]) -> list[str]:
    return [word for path in paths for word in (*options, path)]
