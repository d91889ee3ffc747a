"""The defaults of our parameter tables are upstream's; what is ours alone is off."""

from pathlib import Path

import pytest
import yaml

from nav_nodes.parameters import load_table

NAVIGATION = Path(__file__).resolve().parents[2]
GROUPS = yaml.safe_load(Path(__file__).with_name("upstream_defaults.yaml").read_text("utf-8"))
OFF = (0, 0.0, False)
OURS_ALONE = {"hybrid_astar.yaml", "pure_pursuit.yaml", "escape_recovery.yaml"}
NOT_POLICIES = {"lost_share_max": 1.0, "lost_forgets": True, "thin_wall": 0.3,
                "command_type": "twist", "wheelbase": 0.325}  # with these values it is upstream's
ROBUST = sorted(NAVIGATION.glob("*/config/robust.yaml"))


def entries_of(file):
    return {entry.name: entry for entry in load_table(NAVIGATION / file)}


@pytest.mark.parametrize("group", GROUPS, ids=lambda group: group["table"])
def test_defaults_are_upstream_s(group):
    entries = entries_of(group["table"])
    ours = {name: entry.default for name, entry in entries.items() if entry.ours}
    theirs = {name: entry.default for name, entry in entries.items() if not entry.ours}
    assert theirs == group["defaults"], group["source"]
    for name, default in ours.items():
        assert default == NOT_POLICIES[name] if name in NOT_POLICIES else default in OFF, name


def test_no_table_is_left_out():
    found = {str(file.relative_to(NAVIGATION)) for file in NAVIGATION.glob("*/params/*.yaml")
             if file.name not in OURS_ALONE}
    assert found == {group["table"] for group in GROUPS}


@pytest.mark.parametrize("file", ROBUST, ids=lambda file: file.parts[-3])
def test_what_our_launch_files_switch_on_is_ours(file):
    package = file.parts[-3]
    entries = entries_of(f"{package}/params/{package}.yaml")
    values = yaml.safe_load(file.read_text("utf-8"))
    for name, value in values.items():
        assert entries[name].ours and entries[name].checked(value, name) == value
    ours = {name for name, entry in entries.items() if entry.ours}
    assert ours - values.keys() <= {"command_type", "wheelbase", "seed"}
