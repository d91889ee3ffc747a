"""Lap scoring on drives whose figures are known."""

import math

import pytest
from racecar_description.track.centre_line import Corner
from racecar_description.track.closed_line import Track, build_track
from racecar_description.track.track_file import TrackFile

from evaluation.course_run import marks_of
from evaluation.lap import LapScorer, Sample, Verdict

RATE_HZ = 25
SPEED = 0.15  # m/s


def circle(radius: float = 1.0) -> Track:
    """Counter-clockwise from (0, 0), heading +x: a square rounded until nothing is left of it."""
    xy = ((radius, 0.0), (radius, 2 * radius), (-radius, 2 * radius), (-radius, 0.0))
    corners = tuple(Corner(x, y, radius) for x, y in xy)
    return build_track(TrackFile("circle", 4.0, 0.0, 0.02, 0.3, (0.0, 0.0), corners))


def on_circle(angle: float, radius: float, time: float) -> Sample:
    """A car on a circle about (0, 1), `angle` after its lowest point."""
    return Sample(time, radius * math.sin(angle), 1.0 - radius * math.cos(angle), angle)


def drive_circle(scorer: LapScorer, radius: float, begin: float = 0.0, way: int = 1) -> Verdict:
    """Drive until a verdict at SPEED along the car's own circle, at most for five laps."""
    for i in range(round(5 * 2 * math.pi * radius / SPEED * RATE_HZ)):
        time = i / RATE_HZ
        angle = begin + way * time * SPEED / radius
        if scorer.add(on_circle(angle, radius, time)) is not Verdict.DRIVING:
            break
    return scorer.verdict


@pytest.mark.parametrize("radius", [0.9, 1.0, 1.1])
def test_a_lap_beside_a_circle_has_its_time_distance_and_error(radius):
    scorer = LapScorer(circle(), wanted_laps=3)
    assert drive_circle(scorer, radius) is Verdict.CLOSED
    around = 2 * math.pi * radius
    for lap in scorer.laps:
        assert lap.time == pytest.approx(around / SPEED, abs=1e-3)
        assert lap.distance == pytest.approx(around, abs=SPEED / RATE_HZ)
        assert lap.rms_lateral == pytest.approx(abs(1 - radius), abs=1e-6)
    assert len(scorer.laps) == 3
    assert scorer.total.max_lateral == pytest.approx(abs(1 - radius), abs=1e-9)
    assert scorer.lateral == pytest.approx(1 - radius)  # inside a left circle is left of it


def test_a_car_put_down_elsewhere_drives_to_the_start_first():
    scorer = LapScorer(circle())
    assert drive_circle(scorer, 1.0, begin=math.pi) is Verdict.CLOSED
    assert scorer.laps[0].time == pytest.approx(2 * math.pi / SPEED, abs=1e-3)
    assert scorer.total.distance == pytest.approx(3 * math.pi, abs=0.02)


def test_waiting_for_the_follower_is_not_lap_time():
    scorer = LapScorer(circle())
    for i in range(20 * RATE_HZ):
        scorer.add(on_circle(0.0, 1.0, i / RATE_HZ))
    for i in range(round(2.1 * math.pi / SPEED * RATE_HZ)):
        scorer.add(on_circle(i / RATE_HZ * SPEED, 1.0, 20 + i / RATE_HZ))
    assert scorer.verdict is Verdict.CLOSED
    assert scorer.laps[0].time == pytest.approx(2 * math.pi / SPEED, abs=0.1)


def test_leaving_the_course_says_where_and_when():
    scorer = LapScorer(circle())
    for i in range(1000):
        time = i / RATE_HZ
        if scorer.add(Sample(time, SPEED * time, 0.0, 0.0)) is not Verdict.DRIVING:
            break
    x = math.sqrt(1.25**2 - 1)  # straight on along the tangent until 0.25 m outside
    assert scorer.verdict is Verdict.LEFT
    assert scorer.samples[-1].x == pytest.approx(x, abs=2 * SPEED / RATE_HZ)
    assert f"x={scorer.samples[-1].x:.2f}, y=0.00" in scorer.why
    assert f"time {scorer.samples[-1].time:.1f} s" in scorer.why
    assert "right of the line" in scorer.why


def test_a_car_that_stops_on_its_way_has_stalled():
    scorer = LapScorer(circle())
    for i in range(1000):
        time = i / RATE_HZ
        if scorer.add(on_circle(min(time * SPEED, 1.0), 1.0, time)) is not Verdict.DRIVING:
            break
    assert scorer.verdict is Verdict.STALLED
    assert scorer.samples[-1].time == pytest.approx(1.0 / SPEED + 5.0, abs=0.25)


def test_a_car_that_never_moves_has_stalled_after_thirty_seconds():
    scorer = LapScorer(circle())
    for i in range(2000):
        if scorer.add(on_circle(0.0, 1.0, i / RATE_HZ)) is not Verdict.DRIVING:
            break
    assert scorer.verdict is Verdict.STALLED
    assert "never moved" in scorer.why
    assert scorer.samples[-1].time == pytest.approx(30.0, abs=0.1)


def test_a_car_that_creeps_has_not_stalled():
    scorer = LapScorer(circle())
    for i in range(40 * RATE_HZ):
        scorer.add(on_circle(i / RATE_HZ * 0.005, 1.0, i / RATE_HZ))
    assert scorer.verdict is Verdict.DRIVING


def test_the_wrong_way_is_found_and_is_no_lap():
    scorer = LapScorer(circle())
    assert drive_circle(scorer, 1.0, way=-1) is Verdict.REVERSED
    assert scorer.total.distance == pytest.approx(0.3, abs=0.02)
    assert not scorer.laps


def test_going_back_over_the_start_and_on_again_is_no_lap():
    scorer = LapScorer(circle())
    angles = [0.1 * math.sin(i / 10) for i in range(200)] + [0.0, 0.05, 0.1]
    for i, angle in enumerate(angles):
        scorer.add(on_circle(angle, 1.0, i / RATE_HZ))
    assert scorer.verdict is Verdict.DRIVING
    assert not scorer.laps


def test_marks_are_where_laps_end_and_where_it_was_farthest_and_lost():
    scorer = LapScorer(circle(), wanted_laps=2)
    drive_circle(scorer, 1.1)
    laps, largest = marks_of(scorer)[:2], marks_of(scorer)[2]
    around = 2 * math.pi * 1.1 / SPEED
    assert [mark.text for mark in laps] == ["1", "2"]
    assert [mark.time for mark in laps] == pytest.approx([around, 2 * around], abs=2 / RATE_HZ)
    assert (largest.name, largest.text) == ("largest", "-0.100 m")
    lost = LapScorer(circle())
    drive_circle(lost, 1.3)
    assert [(mark.name, mark.text) for mark in marks_of(lost)] == [
        ("largest", "-0.300 m"), ("lost", lost.why)]
    assert marks_of(LapScorer(circle())) == []


def test_who_stands_without_a_line_has_lost_it_where_it_began_to_stand():
    scorer = LapScorer(circle())
    angles = [min(i / RATE_HZ, 2.0) * SPEED for i in range(8 * RATE_HZ)]  # rad; stands from 2 s on
    for i, angle in enumerate(angles):
        scorer.add(on_circle(angle, 1.0, i / RATE_HZ))
    lost = marks_of(scorer)[-1]
    assert (lost.name, lost.text) == ("lost", scorer.why)
    assert lost.time == pytest.approx(2.0, abs=0.1) and "stalled" in scorer.why
