"""The judge of encounters on made-up drives; recordings, options, and reports of lane trials."""

import json
import math
from dataclasses import replace

import numpy as np
import pytest
from lane_keeping.world.scenery import load_crossings

from evaluation.lane_encounters import (
    CAR,
    Encounter,
    Moment,
    distance,
    judge,
    last,
    line_of,
    nearest_ever,
    read_recording,
)
from evaluation.lane_trials import (
    BOUNDS,
    PEOPLE,
    LaneComparison,
    LaneTrial,
    encounter_table,
    from_report,
    known_methods,
    lane_case,
    lap_table,
)
from evaluation.lap import draw
from evaluation.report import write_json
from evaluation.trial import run_trial
from run_session.failure import RunError

CROSSINGS = load_crossings()
FIRST = CROSSINGS.zebras[0]  # heading east, so metres along it are metres of x
NEAR_EDGE = FIRST.x - CROSSINGS.length / 2


def drive(car, person):
    """A recording of 10 s from functions of time: the car's x, and metres left of the lane."""
    times = np.arange(0, 10, 0.02)
    speeds = np.gradient([car(time) for time in times], times)
    return {
        CAR: [Moment(t, car(t), 0.0, 0.0, v) for t, v in zip(times, speeds, strict=True)],
        "pedestrian_1": [Moment(t, FIRST.x, person(t), 0.0, 1.0) for t in times],
    }


def walks(time):
    """From right to left at 1 m/s; in the lane from 1 to 1.84 s."""
    return min(time - 1.42, 1.4)


def stops(front_gap, goes_on):
    """A car that stands `front_gap` m before the zebra at 1 s, and drives again at `goes_on` s."""
    stand = NEAR_EDGE - 0.2 - front_gap
    return lambda time: stand - max(1 - time, 0) * 0.8 + max(time - goes_on, 0) * 0.8


def judged(car, person=walks):
    found = judge(drive(car, person), CROSSINGS, 0.3)
    assert len(found) == 1
    return found[0]


def test_a_car_that_stops_and_goes_on_passes():
    met = judged(stops(0.4, 2.5))
    assert (met.zebra, met.person, met.must_move) == (1, "pedestrian_1", True)
    assert met.entered == pytest.approx(1.0, abs=0.03) and met.left == pytest.approx(1.84, abs=0.03)
    assert met.stopped_before == pytest.approx(0.4, abs=0.02)
    assert met.moved_after == pytest.approx(0.66, abs=0.06)
    assert met.passed


def test_what_is_not_kept_is_said():
    assert judged(stops(0.2, 2.5)).stood_off is False
    late = judged(stops(0.4, 4.5))
    assert (late.stood_off, late.moved_on, late.passed) == (True, False, False)
    assert judged(stops(0.4, 99)).moved_on is False


def test_a_car_that_drives_into_the_person_touches():
    met = judged(lambda time: FIRST.x - 1.4 + 0.8 * time)
    assert met.touched and met.nearest == 0 and not met.stood_off and not met.passed


def test_a_person_who_is_through_before_a_far_car_is_no_encounter():
    far = drive(lambda time: FIRST.x - 6 + 0.5 * time, walks)
    assert judge(far, CROSSINGS, 0.3) == []
    behind = drive(lambda time: FIRST.x + 1.5 + 0.5 * time, walks)
    assert judge(behind, CROSSINGS, 0.3) == []


def test_distance_is_from_outline_to_body():
    car = Moment(0, 1.0, 2.0, math.pi / 2, 0.0)
    assert distance(car, Moment(0, 1.0, 2.0 + 0.2 + 0.5 + 0.12, 0, 0)) == pytest.approx(0.5)
    assert distance(car, Moment(0, 1.0 - 0.15 - 0.3 - 0.12, 2.0, 0, 0)) == pytest.approx(0.3)
    assert distance(car, Moment(0, 1.0, 2.1, 0, 0)) == 0


def test_nearest_ever_also_counts_who_is_beside_the_lane():
    passing = drive(lambda time: FIRST.x - 4 + 0.8 * time, lambda _time: -0.5)
    assert nearest_ever(passing) == pytest.approx(0.5 - 0.15 - 0.12, abs=0.01)


def test_a_recording_is_read_as_it_was_written(tmp_path):
    path = tmp_path / "poses.txt"
    moments = [Moment(0.02 * i, 0.5 * i, -1.0, 0.25, 0.75) for i in range(3)]
    path.write_text("".join(line_of(CAR, each) for each in moments) + "car 0.06 1.")
    found = read_recording(path)
    assert found == {CAR: moments}
    assert last(moments, 0.03) == moments[1] and last(moments, -1) is None
    path.write_text("car one two\n")
    with pytest.raises(RunError, match="no recording"):
        read_recording(path)


def test_seeds_differ_within_the_bounds():
    drawn = [draw(seed, BOUNDS) for seed in range(40)]
    lights = [each.light for each in drawn]
    assert 0.6 <= min(lights) < 0.7 and 1.3 < max(lights) <= 1.4
    assert draw(7, BOUNDS) == drawn[7]


def test_the_command_line_of_a_drive_with_people_records_them(tmp_path):
    people = lane_case("skeleton", 3, PEOPLE)
    outing = LaneTrial().outing(tmp_path, people)
    words = outing.arguments(3, tmp_path / "w")
    assert f"record:={outing.out / 'poses.txt'}" in words and "near:=3" in words
    assert words[words.index("--follower") + 1] == "skeleton.py"
    alone = LaneTrial().outing(tmp_path, lane_case("skeleton", 3)).arguments(3, tmp_path / "w")
    assert "lane_empty" in alone and "--launch" not in alone


REPORT = {
    "outcome": "closed", "why": None, "laps_wanted": 1, "laps_closed": 1, "simulated_s": 63.0,
    "distance_m": 40.5, "rms_lateral_m": 0.03, "max_lateral_m": 0.05, "frames_dropped": 0,
    "laps": [{"time_s": 60.0, "distance_m": 39.0}],
}


def test_speed_is_that_of_closed_laps_and_the_limits_hold():
    good = from_report(REPORT, "skeleton", 1, draw(1, BOUNDS), people=False)
    assert good.mean_speed == 0.65 and good.within_limits
    assert not from_report(REPORT | {"rms_lateral_m": 0.051}, "skeleton", 1, draw(1, BOUNDS), False
                           ).within_limits
    left = from_report(REPORT | {"outcome": "left the course", "laps": [], "laps_closed": 0},
                       "skeleton", 2, draw(2, BOUNDS), people=False)
    rows = lap_table([good, left], {"skeleton": 4.2}).splitlines()
    assert rows[0].endswith("ms a frame") and "1 of 2" in rows[1] and rows[1].endswith("4.2")


def test_a_report_is_gone_on_with(tmp_path):
    met = tuple(judge(drive(stops(0.4, 2.5), walks), CROSSINGS, 0.3))
    plain = from_report(REPORT, "skeleton", 1, draw(1, BOUNDS), people=True)
    one = type(plain)(**{**vars(plain), "nearest_person": 0.6, "encounters": met})
    trial = LaneTrial()
    write_json(trial.values([one]), tmp_path / "report.json")
    assert trial.from_values(json.loads((tmp_path / "report.json").read_text())) == [one]
    assert "1 of 1" in encounter_table([one])
    passing = tuple(replace(each, stopped_before=None, moved_after=None) for each in met)
    assert "stood nowhere" in encounter_table([replace(one, encounters=passing)])
    (tmp_path / "report.json").write_text("{}")
    with pytest.raises(RunError, match="no report of lane_trials"):
        trial.earlier(trial.parse(["--out", str(tmp_path)]))


@pytest.mark.parametrize("nearest, clear", [(0.6, True), (0.003, False), (None, False)])
def test_who_was_touched_outside_of_encounters_counts_too(nearest, clear):
    plain = from_report(REPORT, "skeleton", 1, draw(1, BOUNDS), people=True)
    assert type(plain)(**{**vars(plain), "nearest_person": nearest}).kept_clear is clear


def test_going_on_with_another_method_is_refused(tmp_path, capsys):
    drove = from_report(REPORT, "skeleton", 0, draw(0, BOUNDS), people=False)
    write_json({**LaneTrial().values([drove]), "options": {"method": "skeleton"}},
               tmp_path / "report.json")
    arguments = ["--seeds", "1", "--crossings", "0", "--resume", "--out", str(tmp_path)]
    assert run_trial(LaneTrial(), arguments) == 2
    assert "report.json: is of --method skeleton;" in capsys.readouterr().err


@pytest.mark.parametrize("arguments, said", [
    (["--method", "magic"], "no method 'magic'"),
    (["--seeds", "few"], r"--seeds \(SEEDS=\) must be a whole number"),
    (["--seeds", "0", "--crossings", "0"], "nothing to drive"),
    (["--speed", "3"], "lane_trials.py --help"),
])
def test_a_mistake_on_the_command_line_is_one_line(arguments, said):
    with pytest.raises(RunError, match=said):
        LaneTrial().parse(arguments)


def test_the_bench_takes_all_methods_and_the_pages_own_first():
    assert known_methods()[0] == "sliding_windows" and len(known_methods()) == 7
    trial = LaneComparison()
    assert [each.driver for each in trial.cases(trial.parse(["--seeds", "1"]))] == known_methods()


def with_people(seed, encounters):
    """A good drive in which so many people were met."""
    good = Encounter("pedestrian_1", 1, 1.0, 2.0, 0.5, None, None, must_move=False)
    return replace(from_report(REPORT, "sliding_windows", seed, draw(seed, BOUNDS), people=True),
                   nearest_person=0.5, encounters=(good,) * encounters)


@pytest.mark.parametrize(("met", "code", "driven"), [
    ((1, 1), 0, 2), ((2, 9), 0, 1), ((0, 1), 2, 2)])
def test_it_drives_until_enough_people_were_met(tmp_path, capsys, met, code, driven):
    class Driven(LaneTrial):
        def drive(self, _session, case):
            return case

        def judge(self, record):
            return with_people(record.seed, met[record.seed - 500])

    arguments = ["--seeds", "0", "--crossings", "2", "--out", str(tmp_path)]
    assert run_trial(Driven(), arguments) == code
    assert ("fewer than 2 people" in capsys.readouterr().err) is (code == 2)
    assert len(json.loads((tmp_path / "report.json").read_text())["drives"]) == driven
