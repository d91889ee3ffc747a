"""Runs apt-get, and reports a failure in one line; the names that apt knows."""

from __future__ import annotations

import contextlib
import os
import re
import shutil
import subprocess
import sys
from functools import cache
from pathlib import Path

from workspace_needs.places import kept_folder

NO_NETWORK = re.compile(
    r"Temporary failure|Could not (resolve|connect)|Unable to connect"
    r"|Cannot initiate the connection|Network is unreachable|Connection (refused|timed out|failed)"
    r"|Failed to fetch")
STALE = re.compile(r"Unable to locate package (\S+)|404 +Not Found|has no installation candidate")
SOURCES = (Path("/var/lib/apt/lists"), Path("/var/lib/dpkg/status"))  # of the names
OPTIONS = ("-y", "-qq", "--no-install-recommends", "-o", "Dpkg::Use-Pty=0",
           "-o", "DPkg::Lock::Timeout=600", "-o", "Acquire::Retries=1")
KEPT = ("http_proxy", "https_proxy", "no_proxy")  # environment variables that sudo must keep


class AptError(RuntimeError):
    """Not all packages were installed; the message is one line."""


def as_root(command: list[str]) -> list[str]:
    """The command, with sudo if needed; AptError if there is no sudo."""
    settings = ["DEBIAN_FRONTEND=noninteractive", "LC_ALL=C",
                *(f"{name}={os.environ[name]}" for name in KEPT if name in os.environ)]
    if os.geteuid() == 0:
        return ["env", *settings, *command]
    if shutil.which("sudo") is None:
        raise AptError("Debian packages are to be installed, you are not root and there is no "
                       f"sudo: type `apt-get {' '.join(command[1:])}` once as root")
    return ["sudo", "env", *settings, *command]


@cache
def names() -> frozenset[str]:
    """All packages in apt's lists, which it reads for a second where it keeps no index of them.

    The names are kept until apt's lists or the installed packages change.
    """
    kept = kept_folder("debian-names")
    with contextlib.suppress(OSError):
        if kept.stat().st_mtime > max(path.stat().st_mtime for path in SOURCES):
            return frozenset(kept.read_text("utf-8").split())
    try:
        listed = subprocess.run(["apt-cache", "pkgnames"], capture_output=True, text=True,
                                check=False).stdout
    except OSError:
        return frozenset()
    with contextlib.suppress(OSError):
        kept.write_text(listed, "utf-8")
    return frozenset(listed.split())


def install(packages: list[str]) -> None:
    """Installs Debian packages without recommended ones; AptError says why that failed.

    Updates apt's lists if apt does not know a package or cannot find its file.
    """
    code, said = _run(as_root(["apt-get", "install", *OPTIONS, *packages]))
    if code and STALE.search(said):
        code, fetched = _run(as_root(["apt-get", "update", *OPTIONS]))
        names.cache_clear()
        if code or NO_NETWORK.search(fetched):  # apt-get update only warns, and ends with 0
            raise AptError(_why(fetched, said))
        code, said = _run(as_root(["apt-get", "install", *OPTIONS, *packages]))
    if code:
        raise AptError(_why(said))


def _run(command: list[str]) -> tuple[int, str]:
    """Runs a command; returns exit code and output, which is also shown meanwhile."""
    with subprocess.Popen(command, stdout=subprocess.PIPE, stderr=subprocess.STDOUT, text=True,
                          errors="replace") as process:
        lines = []
        for line in process.stdout:
            if not line.startswith(("E: ", "W: ")):  # these are reported in the one line at the end
                sys.stdout.write(line)
                sys.stdout.flush()
            lines.append(line)
    return process.returncode, "".join(lines)


def _why(*outputs: str) -> str:
    """The first known reason in apt's output, in words."""
    for said in outputs:
        if NO_NETWORK.search(said) and not re.search(r"404 +Not Found", said):
            return "no network: apt cannot fetch the packages; connect and run this again"
    said = outputs[-1]
    if unknown := re.findall(r"Unable to locate package (\S+)", said):
        return (f"apt knows no package {unknown[0]}: /etc/apt/sources.list needs Debian's own "
                "archive (main)")
    if "a password is required" in said or "not in the sudoers" in said:
        return "sudo refused: run it once as root, or as a user who may use sudo"
    errors = re.findall(r"^E: (.+)$", said, re.MULTILINE)
    return f"apt-get failed: {errors[-1] if errors else said.strip().splitlines()[-1:]}"
