"""Controllers from YAML files: their parameters, and the names to load."""

from pathlib import Path

import rosparam
import rospy
import yaml


class ConfigurationError(Exception):
    """One line that says which file cannot be taken and why."""


def is_file_name(word: str) -> bool:
    """Whether an argument means a YAML file; a controller's name has no such ending."""
    return Path(word).exists() or word.endswith((".yaml", ".yml"))


def load(path: str) -> list[str]:
    """Sets a file's content as parameters below this node's namespace; returns its top-level keys.

    Raises ConfigurationError.
    """
    try:
        documents = rosparam.load_file(path, rospy.get_namespace())
        for content, namespace in documents:
            if not isinstance(content, dict):
                raise TypeError
            rosparam.upload_params(namespace, content)
    except yaml.MarkedYAMLError as error:
        place = error.problem_mark
        line = f", line {place.line + 1}" if place else ""
        raise ConfigurationError(f"{path}{line}: {error.problem or error}") from None
    except TypeError:  # also rosparam's, for an empty document or value
        raise ConfigurationError(
            f"{path}: at the top there must be controllers' names, each with its parameters below, "
            "and no empty value anywhere") from None
    except (OSError, UnicodeError, yaml.YAMLError, rosparam.RosParamException) as error:
        raise ConfigurationError(f"{path}: {error}") from None
    names = [key for content, _ in documents for key in content]
    if not names:
        raise ConfigurationError(f"{path}: the file is empty, there must be controllers in it")
    return names
