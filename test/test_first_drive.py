"""docs/first-drive.ipynb: its cells run in order, with short training, and it has no outputs.

They run by exec, as Jupyter's kernel would: that is 39 more packages, of 90 MB.
"""

import json
import os
import subprocess
import sys
from pathlib import Path

ROOT = Path(__file__).resolve().parent.parent
NOTEBOOK = json.loads((ROOT / "docs/first-drive.ipynb").read_text(encoding="utf-8"))
SHORT = "GENERATIONS, SECONDS, LAP_SECONDS = 1, 1.0, 2.0"
RUN = """
import json, sys
for name, source in json.load(sys.stdin):
    exec(compile(source, name, "exec"))
assert path[-1][1] - path[0][1] > 0.1 or abs(path[-1][0] - path[0][0]) > 0.1
assert picture.shape == (1080, 1920, 3) and picture.std() > 10
print(len(best), policy.course, min(by_hand[0][-1], learned[0][-1]) > 0.02)
"""


def cells(kind: str) -> list[dict]:
    return [cell for cell in NOTEBOOK["cells"] if cell["cell_type"] == kind]


def test_the_cells_run_one_after_the_other(tmp_path):
    code = []
    for cell in cells("code"):
        code.append((cell["id"], "".join(cell["source"])))
        if "parameters" in cell["metadata"].get("tags", ()):
            code.append(("short", SHORT))
    assert len(code) == len(cells("code")) + 1
    done = subprocess.run([sys.executable, "-c", RUN], cwd=tmp_path, input=json.dumps(code),
                          text=True, capture_output=True, check=False,
                          env={**os.environ, "MPLBACKEND": "agg"})
    assert done.returncode == 0, done.stderr
    assert done.stdout.splitlines()[-1] == "1 line_follow True"
    assert not done.stderr, done.stderr


def test_it_is_committed_as_it_is_before_it_runs():
    assert (NOTEBOOK["nbformat"], len(NOTEBOOK["cells"])) == (4, 10)
    for cell in cells("code"):
        assert cell["outputs"] == [] and cell["execution_count"] is None


def test_each_sentence_is_there_in_both_languages():
    for cell in cells("markdown"):
        lines = [line for line in "".join(cell["source"]).partition("```")[0].splitlines() if line]
        texts = [line for line in lines if not line.startswith("## ")]
        assert len(texts) % 2 == 0
        for english, chinese in zip(texts[::2], texts[1::2], strict=True):
            assert english.isascii() and not chinese.isascii(), english
