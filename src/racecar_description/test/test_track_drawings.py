"""Drawings with known answers: where their middle is, how wide and long they are."""

import cv2
import drawn_tracks as drawn
import numpy as np
import pytest
from racecar_description.track.errors import DrawingError, TrackError
from racecar_description.track.from_drawing import from_drawing
from racecar_description.track.wishes import Wishes

PX = 0.01  # m: the drawings are 1200 x 800 px, and 12 x 8 m


@pytest.fixture
def course_of(tmp_path):
    """course_of(picture, **wishes) is the course of a drawing."""

    def read(picture, **wishes):
        path = tmp_path / "drawing.png"
        cv2.imwrite(str(path), picture)
        return from_drawing(path, Wishes("drawing", **wishes))[0]

    return read


def drawn_points(course):
    """(n, 2) points of the centre line in m of the drawing's frame."""
    return course.line.points() + course.origin


def in_metres(points_px):
    """Pixel coordinates in m of the drawing's frame."""
    x, y = np.asarray(points_px, float).T
    return np.column_stack((x + 0.5, drawn.HEIGHT_PX - y - 0.5)) * PX


def farthest(points, others):
    """m, the largest distance of a point from the nearest of the others."""
    apart = np.hypot(*(points[:, None] - others[None]).transpose(2, 0, 1))
    return apart.min(axis=1).max()


@pytest.mark.parametrize("radius_px, width_px", [(300, 80), (200, 60), (300, 5)])
def test_a_circle_gives_its_own_radius_and_length(course_of, radius_px, width_px):
    course = course_of(drawn.circle(radius_px, width_px=width_px))
    centre = in_metres([(600, 400)])[0]
    radii = np.hypot(*(drawn_points(course) - centre).T)
    assert np.abs(radii - radius_px * PX).max() < 1 * PX
    assert course.line.length == pytest.approx(2 * np.pi * radius_px * PX, rel=0.005)
    assert course.line.tightest()[0] == pytest.approx(radius_px * PX, rel=0.05)


def test_the_road_is_as_wide_as_it_is_drawn(course_of):
    for width_px in (60, 80, 120):
        course = course_of(drawn.circle(260, width_px=width_px))
        assert 2 * course.half_road == pytest.approx(width_px * PX, abs=1.5 * PX)


def test_an_ellipse_keeps_its_axes_and_circumference(course_of):
    course = course_of(drawn.ellipse((450, 280)))
    angle = np.linspace(0, 2 * np.pi, 3000, endpoint=False)
    true = in_metres(np.column_stack((600 + 450 * np.cos(angle), 400 + 280 * np.sin(angle))))
    assert farthest(drawn_points(course), true) < 1 * PX
    around = np.hypot(*(np.roll(true, -1, axis=0) - true).T).sum()
    assert course.line.length == pytest.approx(around, rel=0.005)


@pytest.mark.parametrize("seed", [1, 2, 3])
def test_coffee_crumbs_shadow_and_gaps_change_nothing(course_of, seed):
    clean, noisy = course_of(drawn.bean()), course_of(drawn.by_hand(seed))
    assert farthest(drawn_points(noisy), drawn_points(clean)) < 0.02
    assert noisy.lane_width == pytest.approx(clean.lane_width, abs=0.02)


def test_the_bean_is_followed_in_its_bends(course_of):
    true = in_metres(drawn.closed_curve(drawn.BEAN))
    assert farthest(drawn_points(course_of(drawn.bean())), true) < 0.02


def test_a_stain_as_dark_as_half_the_ink_is_no_road(course_of):
    picture = drawn.blank()
    cv2.circle(picture, (430, 520), 150, (110, 110, 110), 14)
    drawn.stroke(picture, drawn.closed_curve(drawn.BEAN))
    assert farthest(
        drawn_points(course_of(picture)), drawn_points(course_of(drawn.bean()))
    ) < 0.02


def test_a_line_painted_on_the_road_is_part_of_it(course_of):
    curve = drawn.closed_curve(drawn.BEAN)
    picture = drawn.stroke(drawn.bean(), curve, 5, (40, 220, 250))
    assert farthest(drawn_points(course_of(picture)), in_metres(curve)) < 0.02


def test_the_named_colour_is_the_road(course_of):
    picture = drawn.stroke(drawn.blank(), drawn.closed_curve(drawn.BEAN), 60, (40, 30, 200))
    drawn.stroke(picture, [(100, 750), (1100, 60)], 20, (20, 20, 20), closed=False)
    for colour in ("red", "#c81e28"):
        course = course_of(picture, colour=colour)
        assert farthest(drawn_points(course), in_metres(drawn.closed_curve(drawn.BEAN))) < 0.05


def test_the_largest_of_two_rings_is_the_road(course_of):
    picture = drawn.circle(320)
    cv2.circle(picture, (600, 400), 120, drawn.INK, 30)
    assert course_of(picture).line.length == pytest.approx(2 * np.pi * 3.2, rel=0.005)


def test_a_picture_keeps_its_shape_in_a_size_of_another(tmp_path):
    path = tmp_path / "drawing.png"
    cv2.imwrite(str(path), drawn.circle())
    course, remarks = from_drawing(path, Wishes("drawing", size=(12.0, 4.0)))
    assert course.line.length == pytest.approx(2 * np.pi * 1.5, rel=0.005)
    assert (course.plane.width, course.plane.height) == (6.0, 4.0)
    assert any("keep its shape" in remark for remark in remarks)


def test_the_start_is_the_worlds_origin_and_leads_along_x(course_of):
    for backwards in (False, True):
        course = course_of(drawn.bean(), backwards=backwards)
        assert course.start == pytest.approx((0.0, 0.0, 0.0), abs=1e-6)
    ahead = course_of(drawn.bean(), start=(10.6, 4.0))
    assert farthest(np.array([ahead.origin]), np.array([(10.4, 4.0)])) < 0.3
    assert ahead.start[:2] == pytest.approx((0, 0), abs=1e-6)
    assert ahead.start[2] == pytest.approx(np.pi / 2, abs=0.3)


def test_reverse_runs_clockwise(course_of):
    def turned(course):
        x, y = course.line.points().T
        return np.sign(np.sum(x * np.roll(y, -1) - y * np.roll(x, -1)))

    assert turned(course_of(drawn.bean())) == 1
    assert turned(course_of(drawn.bean(), backwards=True)) == -1


BAD = [
    (drawn.blank, "nothing dark in it", []),
    (drawn.open_road, "no closed road", [(657, 642), (167, 477)]),
    (drawn.figure_eight, "crosses itself", [(600, 400)]),
    (drawn.side_road, "the road forks", [(600, 590)]),
    (drawn.short_cut, "crosses itself", [(293, 231), (276, 554)]),
]


@pytest.mark.parametrize("draw, message, places", BAD)
def test_a_bad_drawing_says_what_and_where(course_of, draw, message, places):
    with pytest.raises(DrawingError, match=message) as caught:
        course_of(draw())
    marks = [(mark.x_px, mark.y_px) for mark in caught.value.marks]
    assert len(marks) == len(places)
    for place in places:
        assert min(np.hypot(x - place[0], y - place[1]) for x, y in marks) < 40


def test_light_roads_on_a_dark_ground_need_their_colour(course_of):
    ground = drawn.blank(colour=(40, 40, 40))
    picture = drawn.stroke(ground, drawn.closed_curve(drawn.BEAN), colour=(240, 240, 240))
    with pytest.raises(DrawingError, match="--road white"):
        course_of(picture)
    assert course_of(picture, colour="white").line.length > 20


def test_a_road_that_would_touch_itself_says_how_wide_it_may_be(course_of):
    slot = [(150, 300), (1050, 300), (1050, 500), (150, 500)]
    picture = drawn.stroke(drawn.blank(), slot, 60)
    with pytest.raises(DrawingError, match=r"touches itself.*--width 1\.\d\d at most"):
        course_of(picture, width=2.5)


def test_files_that_are_no_pictures(tmp_path):
    for name, data, message in [
        ("empty.png", b"", "is empty"),
        ("text.png", b"hello", "not a picture that can be read"),
        ("small.png", cv2.imencode(".png", drawn.blank((40, 40)))[1].tobytes(), "too small"),
    ]:
        (tmp_path / name).write_bytes(data)
        with pytest.raises(TrackError, match=message):
            from_drawing(tmp_path / name, Wishes("bad"))
    with pytest.raises(TrackError, match="No such file"):
        from_drawing(tmp_path / "none.png", Wishes("bad"))
