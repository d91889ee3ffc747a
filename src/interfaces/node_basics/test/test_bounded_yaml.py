"""Short texts that mean too much, or that would keep a reader busy."""

import time

import pytest
import yaml
from node_basics.bounded_yaml import DEEPEST, BoundedLoader, PlainLoader


@pytest.mark.parametrize("bracket", ["[", "{a: "])
def test_what_is_open_too_deep_is_refused_before_it_takes_time(bracket):
    began = time.process_time()
    with pytest.raises(yaml.scanner.ScannerError, match=f"more than {DEEPEST} brackets are open"):
        yaml.load(bracket * 100_000, BoundedLoader)
    assert time.process_time() - began < 2.0  # SafeLoader takes this much for 3,000


def test_what_is_just_deep_enough_is_read():
    found = yaml.load("[" * DEEPEST + "]" * DEEPEST, BoundedLoader)
    for _ in range(DEEPEST - 1):
        (found,) = found
    assert found == []


@pytest.mark.parametrize("digits", [":1" * 100_000, "0" * 200_000, ":1" * 100_000 + ".5"])
def test_a_number_of_thousands_of_digits_is_refused_before_it_takes_time(digits):
    began = time.process_time()
    with pytest.raises(yaml.constructor.ConstructorError, match="a number of more than 1000"):
        yaml.load(f"resolution: 1{digits}", BoundedLoader)
    assert time.process_time() - began < 2.0
    assert yaml.load("resolution: 1:30", BoundedLoader) == {"resolution": 90}


def test_merge_keys_are_refused():
    with pytest.raises(yaml.constructor.ConstructorError, match="merge"):
        yaml.load("a: &a {x: 1}\nb: {<<: *a}\n", BoundedLoader)


@pytest.mark.parametrize("text", ["a: &a [1]\nb: *a\n", "a: &a [1]\n"])
def test_names_of_values_are_refused_where_none_belong(text):
    assert yaml.load(text, BoundedLoader)["a"] == [1]
    with pytest.raises(yaml.composer.ComposerError, match="are not allowed here") as refused:
        yaml.load(text, PlainLoader)
    assert refused.value.problem_mark.line == 0
