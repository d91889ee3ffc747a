"""A traceback shows the script's lines and the libraries', and none of the amendments'."""

import subprocess
import sys
from pathlib import Path

SOURCE = Path(__file__).resolve().parents[1] / "src"
LANGUAGE = SOURCE.parents[2] / "interfaces/terminal_language/src"


def error_of(tmp_path, code):
    script = tmp_path / "typed.py"
    script.write_text(code)
    (tmp_path / "devel").mkdir()
    (tmp_path / "devel/usercustomize.py").symlink_to(SOURCE / "usercustomize.py")
    done = subprocess.run(
        [sys.executable, script], text=True, capture_output=True, timeout=100,
        env={"PYTHONPATH": f"{tmp_path}/devel:{SOURCE}:{LANGUAGE}"})
    assert done.returncode == 1
    return done.stderr


def test_half_typed_yaml_is_upstreams_text_alone(tmp_path):
    said = error_of(tmp_path, "import yaml\nyaml.safe_load('{a: [1')\n")
    assert "typed.py\", line 2" in said and "yaml/parser.py" in said
    assert "python_amendments" not in said and "usercustomize" not in said


def test_nor_in_the_error_that_it_comes_from(tmp_path):
    said = error_of(tmp_path, "import yaml\ntry: yaml.load('{a: [1', yaml.SafeLoader)\n"
                              "except yaml.YAMLError as error:\n"
                              "    raise ValueError('mine') from error\n")
    assert "ValueError: mine" in said and "the direct cause" in said
    assert "python_amendments" not in said


def test_a_script_that_cannot_be_read_is_shown_as_ever(tmp_path):
    assert "SyntaxError" in error_of(tmp_path, "import yaml\nif\n")
