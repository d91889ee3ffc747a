"""Every file of formats_broken/ fails with the one line that its first comment expects.

Those of formats_mended/ load, and give it as their one error line.
"""

import logging
from pathlib import Path

import pybullet_data
import pytest

from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources

FOREIGN = [file for file in Path(pybullet_data.getDataPath()).rglob("*.urdf")
           if "random_urdfs" not in file.parts]
HERE = Path(__file__).parent
BROKEN = sorted((HERE / "formats_broken").iterdir())
MENDED = sorted((HERE / "formats_mended").iterdir())


def expectation(text: str) -> str:
    """What the first comment of a file says."""
    return text.partition("\n")[0].removeprefix("<!-- expect: ").removesuffix(" -->")


@pytest.mark.parametrize("file", BROKEN, ids=lambda file: file.name)
def test_broken_model_says_what_is_wrong(file):
    text = file.read_text()
    expected = expectation(text)
    with pytest.raises(FormatError) as raised:
        load_model(text, Resources())
    assert str(raised.value).endswith(expected)
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("file", MENDED, ids=lambda file: file.name)
def test_one_wrong_thing_is_one_error_line_and_the_rest_loads(file, caplog):
    text = file.read_text()
    assert load_model(text, Resources()).links
    said = [record.getMessage() for record in caplog.records if record.levelno == logging.ERROR]
    assert said == [expectation(text)]


def test_there_are_such_files():
    assert len(BROKEN) > 20 and len(MENDED) > 30


def test_files_of_other_people_load_or_say_why_not():
    loaded = 0
    resources = Resources(find_package=lambda package: f"/nonexistent/{package}")
    for file in FOREIGN:
        try:
            loaded += bool(load_model(file.read_text(errors="replace"), resources).links)
        except SimulationError as error:
            assert "\n" not in str(error)
    assert loaded > 0.7 * len(FOREIGN) > 35
