"""From a drive to points, with the reason for each loss."""

from marking.marks import mean, points_of
from marking.rules import Points

POINTS = Points(60, 25, 0.03, 0.15, 15, 0.2, 0.05)
DRIVE = {"violations": [], "fault": "", "why": "", "laps_wanted": 1, "laps_closed": 1,
         "driven_share": 1.0, "rms_lateral_m": 0.03, "mean_speed_m_s": 0.2}


def test_a_perfect_drive_loses_nothing():
    assert points_of(DRIVE, POINTS) == (100, [])


def test_beside_the_line_and_slow():
    points, lost = points_of({**DRIVE, "rms_lateral_m": 0.09, "mean_speed_m_s": 0.125}, POINTS)
    assert points == 60 + 12.5 + 7.5
    assert [each.split(":")[0] for each in lost] == ["12.5 points", "7.5 points"]


def test_a_part_of_the_way_counts_as_that_part():
    points, lost = points_of({**DRIVE, "laps_closed": 0, "driven_share": 0.25,
                              "why": "the car left the course"}, POINTS)
    assert points == 25
    assert lost[0] == "45.0 points: the car left the course"


def test_what_is_not_allowed_takes_all():
    points, lost = points_of({**DRIVE, "violations": ["it called /x", "it published /y"]}, POINTS)
    assert points == 0
    assert lost == ["100 points: it called /x, it published /y"]


def test_the_mean_of_the_cases():
    assert mean([100, 50.5]) == 75.25
