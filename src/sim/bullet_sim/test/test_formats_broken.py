"""Every file of formats_broken/ fails with the one line that its first comment expects."""

from pathlib import Path

import pybullet_data
import pytest

from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats import Resources, load_model

FOREIGN = [file for file in Path(pybullet_data.getDataPath()).rglob("*.urdf")
           if "random_urdfs" not in file.parts]
BROKEN = sorted((Path(__file__).parent / "formats_broken").iterdir())


@pytest.mark.parametrize("file", BROKEN, ids=lambda file: file.name)
def test_broken_model_says_what_is_wrong(file):
    text = file.read_text()
    first_line = text.partition("\n")[0]
    expected = first_line.removeprefix("<!-- expect: ").removesuffix(" -->")
    with pytest.raises(FormatError) as raised:
        load_model(text, Resources())
    assert str(raised.value).endswith(expected)
    assert "\n" not in str(raised.value)


def test_there_are_broken_files():
    assert len(BROKEN) > 20


def test_files_of_other_people_load_or_say_why_not():
    loaded = 0
    resources = Resources(find_package=lambda package: f"/nonexistent/{package}")
    for file in FOREIGN:
        try:
            loaded += bool(load_model(file.read_text(errors="replace"), resources).links)
        except SimulationError as error:
            assert "\n" not in str(error)
    assert loaded > 0.7 * len(FOREIGN) > 35
