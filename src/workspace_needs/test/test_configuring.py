"""The environment in which packages are configured."""

import runpy
import sys

import pytest
from workspace_needs.workspace import Package
from workspaces import add_plain

from workspace_needs import configuring


@pytest.mark.parametrize("version, words", [
    ((3, 11, 9), {"SETUPTOOLS_USE_DISTUTILS": "stdlib"}), ((3, 12, 0), {}), ((3, 13, 1), {})])
def test_cmake_asks_python_s_own_distutils_where_it_has_one(tmp_path, monkeypatch, version, words):
    with monkeypatch.context() as patch:
        patch.setattr(sys, "version_info", version)
        chosen = runpy.run_path(configuring.__file__)["OWN_DISTUTILS"]
    assert chosen == words
    monkeypatch.setattr(configuring, "OWN_DISTUTILS", chosen)
    monkeypatch.delenv("SETUPTOOLS_USE_DISTUTILS", raising=False)
    monkeypatch.setenv("ROS_HOME", str(tmp_path / "ros_home"))
    folder = add_plain(tmp_path, "asks",
                       cmake='message(FATAL_ERROR "it is <$ENV{SETUPTOOLS_USE_DISTUTILS}>")')
    found = configuring.configure([Package("asks", folder)])["asks"]
    assert f"it is <{''.join(words.values())}>" in found.error
