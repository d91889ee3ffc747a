"""A single drive, with nothing that drives: what is kept when it is interrupted."""

from argparse import Namespace
from types import SimpleNamespace

import pytest

from evaluation.trial import live


class Drive(live.LiveDrive):
    """Ends at once; `reports` has what it wrote."""

    program, writes = "drive", ("report.json",)
    was_seen = True

    def __init__(self, out):
        super().__init__(Namespace(out=out))
        self.reports = []

    def add_options(self, parser): ...
    def bring_up(self, launched): ...
    def end(self): ...

    def watch(self, launched):
        return "passed", ""

    def figures(self, outcome, log):
        return {"outcome": outcome[0]}

    def write(self, report):
        self.reports.append(report)
        return []

    def faults(self, outcome):
        return []


class Ending:
    """A session while whose processes end Ctrl-C is typed."""

    def __init__(self, out):
        self.out, self.family = out, SimpleNamespace(spared=None)

    def __enter__(self):
        return self

    def __exit__(self, *_):
        raise KeyboardInterrupt

    def launched(self, *_):
        return SimpleNamespace(start_roscore=lambda: None, master_uri="", log_folder=self.out)


def test_ctrl_c_after_the_drive_does_not_lose_its_report(tmp_path, monkeypatch):
    monkeypatch.setattr(live, "Session", Ending)
    drive = Drive(tmp_path)
    with pytest.raises(KeyboardInterrupt):
        live.run_live(drive)
    assert [report["outcome"] for report in drive.reports] == ["passed"]
