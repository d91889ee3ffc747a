"""Every model of formats_broken.yaml fails with the one line that it expects.

Those of formats_mended.yaml load, and give it as their one error line.
"""

import logging
from pathlib import Path

import pybullet_data
import pytest
import yaml

from bullet_sim.errors import FormatError, SimulationError
from bullet_sim.formats.loading import load_model
from bullet_sim.formats.resources import Resources

FOREIGN = [file for file in Path(pybullet_data.getDataPath()).rglob("*.urdf")
           if "random_urdfs" not in file.parts]
HERE = Path(__file__).parent
BROKEN, MENDED = (yaml.safe_load((HERE / name).read_text(encoding="utf-8"))
                  for name in ("formats_broken.yaml", "formats_mended.yaml"))


@pytest.mark.parametrize("name", BROKEN)
def test_broken_model_says_what_is_wrong(name):
    with pytest.raises(FormatError) as raised:
        load_model(BROKEN[name]["text"], Resources())
    assert str(raised.value).endswith(BROKEN[name]["expect"])
    assert "\n" not in str(raised.value)


@pytest.mark.parametrize("name", MENDED)
def test_one_wrong_thing_is_one_error_line_and_the_rest_loads(name, caplog):
    assert load_model(MENDED[name]["text"], Resources()).links
    said = [record.getMessage() for record in caplog.records if record.levelno == logging.ERROR]
    assert said == [MENDED[name]["expect"]]


def test_files_of_other_people_load_or_say_why_not():
    loaded = 0
    resources = Resources(find_package=lambda package: f"/nonexistent/{package}")
    for file in FOREIGN:
        try:
            loaded += bool(load_model(file.read_text(errors="replace"), resources).links)
        except SimulationError as error:
            assert "\n" not in str(error)
    assert loaded > 0.7 * len(FOREIGN) > 35
