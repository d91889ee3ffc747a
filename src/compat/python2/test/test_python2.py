"""Scripts that ask for Python 2, by each of its names."""

import subprocess

import pytest


@pytest.fixture(params=["python2", "python2.7"])
def script(request, tmp_path):
    """Writes an executable script with that name in its first line; runs it."""
    path = tmp_path / "node.py"

    def run(body: str) -> subprocess.CompletedProcess:
        path.write_text(f"#!/usr/bin/env {request.param}\n{body}\n", encoding="utf-8")
        path.chmod(0o755)
        return subprocess.run([path, "a b"], capture_output=True, text=True, timeout=60,
                              check=False)
    return run


def test_what_python_3_understands_runs(script):
    done = script("import sys; print(sys.argv[1])")
    assert (done.returncode, done.stdout, done.stderr) == (0, "a b\n", "")


def test_what_it_does_not_is_named_with_its_line(script):
    done = script("x = 1\nprint 'hello'")
    assert (done.returncode, done.stdout) == (1, "")
    assert "node.py, line 3: Missing parentheses" in done.stderr and done.stderr.count("\n") == 1
