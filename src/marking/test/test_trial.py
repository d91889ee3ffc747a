"""Which drives a case takes, and which earlier marks stay, without a simulator."""

import json

import made_up
import pytest
from marking.case_files import read_case
from marking.drive_report import BY_TIME
from marking.trial import TIMED, MarkingTrial

from run_session.failure import RunError

CLOSED = {"outcome": "closed", "violations": [], "fault": "", "why": "", "laps_wanted": 1,
          "laps_closed": 1, "driven_share": 1.0, "rms_lateral_m": 0.03, "mean_speed_m_s": 0.2}


class FakeSession:
    """Its drives bring these reports, or raise them; it keeps what each was asked to drive."""

    def __init__(self, *reports):
        self._reports, self.cases = iter(reports), []

    def start_drive(self, _command, folder, _environment):
        self.cases.append(read_case(folder))
        return self

    def report(self, _limit, _what):
        report = next(self._reports)
        if isinstance(report, Exception):
            raise report
        return report


@pytest.fixture()
def marking(tmp_path):
    """A trial of one submission, and its options."""
    made_up.write(tmp_path / "in", {"good"})
    rules = made_up.write_rules(tmp_path / "marking.yaml")
    trial = MarkingTrial()
    return trial, trial.parse(["--submissions", str(tmp_path / "in"), "--rules", str(rules),
                               "--out", str(tmp_path / "out"), "--no-sandbox"])


def mark(marking, session):
    trial, options = marking
    [case] = trial.cases(options)
    trial.setup(session, case)
    return trial.score(trial.run())


def test_what_answers_each_image_drives_once(marking):
    session = FakeSession(CLOSED)
    found = mark(marking, session)
    assert (found.points, found.note) == (100, "")
    assert [case.timed for case in session.cases] == [False]


def test_what_does_not_drives_again_in_real_time(marking):
    session = FakeSession({**CLOSED, "outcome": BY_TIME}, CLOSED)
    found = mark(marking, session)
    assert (found.points, found.note) == (100, TIMED)
    first, second = session.cases
    assert {"real_time_factor:=0", "lockstep_timeout:=5"} <= set(first.launch_args)
    assert {"real_time_factor:=1", "lockstep_timeout:=0.05"} <= set(second.launch_args)
    assert len(first.launch_args) == len(second.launch_args)


def test_a_course_that_did_not_come_up_is_tried_again(marking):
    session = FakeSession(RunError("no roscore"), CLOSED)
    assert mark(marking, session).points == 100
    assert len(session.cases) == 2


def test_a_changed_submission_is_marked_again(marking, tmp_path, capsys):
    trial, options = marking
    found = mark(marking, FakeSession(CLOSED))
    (options.out / "report.json").write_text(json.dumps(trial.values([found])))
    assert trial.earlier(options) == [found]
    (tmp_path / "in" / "good.py").write_text("changed")
    assert trial.earlier(options) == []
    assert capsys.readouterr().out == "good: the submission has changed, it is marked again\n"
