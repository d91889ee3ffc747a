"""What the tests of all exercises share."""

import io
import subprocess
import tarfile

import pytest

from exercises.catalogue import MODULES, find_exercises


def pytest_generate_tests(metafunc):
    """`exercise`: each whose check starts no master; `node_exercise`: each other."""
    for argument, nodes in ("exercise", False), ("node_exercise", True):
        if argument in metafunc.fixturenames:
            metafunc.parametrize(argument, [
                pytest.param(exercise, id=name) for name, exercise in find_exercises().items()
                if (exercise.check in MODULES["nodes"]) == nodes])


@pytest.fixture
def begun(tmp_path):
    """Copies a starting file as git has it: a learner may have solved it in place. None: no git."""
    def copied(exercise):
        name = exercise.start.name
        done = subprocess.run(["git", "archive", "HEAD", name], cwd=exercise.start.parent,
                              capture_output=True)
        if done.returncode:
            return None
        with tarfile.open(fileobj=io.BytesIO(done.stdout)) as archive:
            archive.extract(name, tmp_path)
        return tmp_path / name
    return copied
