"""Parameters from a server that is made up; no master."""

import math

import pytest

from nav_nodes import parameters
from nav_nodes.parameters import Parameter, ParameterError, read_parameters

SCALE = Parameter("pdist_scale", "double", 0.6, min=0.0, also=("path_distance_bias",))


@pytest.fixture
def server(monkeypatch):
    """What is set, by name."""
    found = {}
    monkeypatch.setattr(parameters.rospy, "resolve_name", lambda name: name)
    monkeypatch.setattr(parameters.rospy, "has_param", found.__contains__)
    monkeypatch.setattr(parameters.rospy, "get_param", found.get)
    return found


@pytest.mark.parametrize("given, expected", [
    ({}, 0.6), ({"~pdist_scale": 1}, 1.0), ({"~path_distance_bias": 32.0}, 32.0),
    ({"~pdist_scale": 2.0, "~path_distance_bias": 32.0}, 2.0)])
def test_another_of_its_names_counts_where_its_own_is_not_set(server, given, expected):
    server.update(given)
    assert read_parameters([SCALE]) == {"pdist_scale": expected}


def test_a_wrong_value_is_blamed_on_the_name_that_it_has(server):
    server["~path_distance_bias"] = "32.0"
    with pytest.raises(ParameterError, match="~path_distance_bias is '32"):
        read_parameters([SCALE])


def test_a_whole_number_may_be_written_with_a_point():
    samples = Parameter("vx_samples", "int", 3, min=0, max=300)
    assert repr(samples.checked(20.0, "vx_samples")) == "20"
    for value in (20.5, math.inf, 301.0, True):
        with pytest.raises(ParameterError, match="vx_samples is"):
            samples.checked(value, "vx_samples")


@pytest.mark.parametrize("value", [True, "1", None, [1.0], -0.1, math.nan])
def test_what_is_no_such_number_is_refused(value):
    with pytest.raises(ParameterError, match="pdist_scale is"):
        SCALE.checked(value, "pdist_scale")


def test_a_list_is_text_where_text_is_wanted():
    """As in `footprint: [[0.1, 0.1], ...]` or `y_vels: [-0.3, 0.3]`."""
    outline = Parameter("footprint", "str", "[]")
    assert outline.checked([[0.1, 0.1], [-0.1, 0.1]], "x") == "[[0.1, 0.1], [-0.1, 0.1]]"
