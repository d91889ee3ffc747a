"""Runs a program once an editor's debugger has attached to it, by debugpy."""

from __future__ import annotations

import argparse
import os
import runpy
import socket
import sys
from typing import NoReturn

PORT = 5678  # as debugpy's own, and .vscode/launch.json's
HERE = "127.0.0.1"
REFUSED, INTERRUPTED = 2, 130


class _Parser(argparse.ArgumentParser):
    def error(self, message: str) -> NoReturn:
        """Print one line only; --help shows the usage."""
        if "required" in message:
            message = "name a program: rosrun node_basics debug FILE [ARGUMENTS]"
        self.exit(REFUSED, f"debug: {message} (see: rosrun node_basics debug --help)\n")


def main(arguments: list[str]) -> int:
    """Wait for a debugger, then run the program in this process; the exit code if it is refused."""
    parser = _Parser(prog="debug", description=__doc__)
    parser.add_argument("--port", type=int, default=PORT, help=f"where it waits ({PORT})")
    parser.add_argument("file", help="a program in Python")
    parser.add_argument("arguments", nargs=argparse.REMAINDER, help="its own")
    given = parser.parse_args(arguments)
    if not 1 <= given.port <= 65535:
        parser.error(f"--port must be 1 to 65535, got {given.port}")
    if fault := fault_of(given.file) or taken(given.port):
        print(f"debug: {fault}", file=sys.stderr)
        return REFUSED
    # debugpy's warning that it cannot stop in the modules that Python itself is started with
    os.environ.setdefault("PYDEVD_DISABLE_FILE_VALIDATION", "1")
    try:
        import debugpy
    except ImportError:
        print("debug: debugpy is not installed: type scripts/setup.sh --debugging in the "
              "workspace's folder", file=sys.stderr)
        return REFUSED
    try:
        debugpy.listen((HERE, given.port))
        print(f"debug: {os.path.basename(given.file)} waits for a debugger at {HERE}:{given.port}; "
              'in Visual Studio Code: Run and Debug, "Attach"; Ctrl-C ends it',
              file=sys.stderr, flush=True)
        debugpy.wait_for_client()
    except KeyboardInterrupt:
        return INTERRUPTED
    except RuntimeError as error:  # between our look at the port and debugpy's, it was taken
        print(f"debug: {error}", file=sys.stderr)
        return REFUSED
    sys.argv = [given.file, *given.arguments]
    sys.path[0] = os.path.dirname(os.path.abspath(given.file))
    runpy.run_path(given.file, run_name="__main__")
    return 0


def fault_of(file: str) -> str:
    """Why a file is no program in Python, in a line; empty: it is one."""
    try:
        with open(file, "rb") as source:
            compile(source.read(), file, "exec", dont_inherit=True)
    except OSError as error:
        return f"{file}: {error.strerror}"
    except SyntaxError as error:
        return f"{file}:{error.lineno}: {error.msg}: {(error.text or '').strip()}"
    except ValueError as error:  # null bytes
        return f"{file} is no program in Python: {error}"
    return ""


def taken(port: int) -> str:
    """Why nobody can listen at a port, in a line; empty: it is free."""
    with socket.socket() as trial:
        trial.setsockopt(socket.SOL_SOCKET, socket.SO_REUSEADDR, 1)
        try:
            trial.bind((HERE, port))
        except PermissionError:
            return f"port {port} is root's: choose one from 1024, as {PORT} without --port"
        except OSError:
            return (f"port {port} is taken, perhaps by another program that is debugged: end that "
                    f"one, or choose a port: rosrun node_basics debug --port {port % 65535 + 1}")
    return ""
