"""What the lessons see in made-up pictures and scans, and what they do then."""

import math
from dataclasses import replace
from importlib import import_module
from pathlib import Path

import cv2
import numpy as np
import pytest
from learning_autorace.ground import (
    AHEAD,
    CalibrationError,
    compensate,
    find_lane,
    floor_maps,
    load_calibration,
    to_pixel,
)

LANE, LIGHT, BAR, TUNNEL, PARK, COURSE = (import_module(name) for name in (
    "02lane", "03traffic_light", "04bar", "05tunnel", "06parking", "07course"))
CONFIG = Path(__file__).resolve().parent.parent / "config" / "camera.yaml"
CALIBRATION = load_calibration(CONFIG)
SIZE = 320, 240  # px
YELLOW, WHITE, RED = (0, 255, 255), (255, 255, 255), (0, 0, 255)
NOTHING = np.empty((0, 2))


def floor(*lines):
    """A view with lines of (colour, (x, y), (x, y)), m, 2 cm wide."""
    c = CALIBRATION
    view = np.zeros((round((c.far - c.near) * c.px_per_m), round(2 * c.half_width * c.px_per_m), 3),
                    np.uint8)
    for colour, *ends in lines:
        pixels = [(round((c.half_width - y) * c.px_per_m), round((c.far - x) * c.px_per_m))
                  for x, y in ends]
        cv2.line(view, *pixels, colour, 4)
    return view


def lane(left=0.0):
    return (YELLOW, (0.0, left + 0.125), (0.7, left + 0.125)), (
        WHITE, (0.0, left - 0.125), (0.7, left - 0.125))


def picture(*spots):
    """A camera's picture with rectangles of (colour, forward, left, up, width, height), m."""
    image = np.full((SIZE[1], SIZE[0], 3), 60, np.uint8)
    for colour, forward, left, up, wide, high in spots:
        columns, rows = to_pixel(np.full(2, forward), left + np.array([wide, -wide]) / 2,
                                 up + np.array([high, -high]) / 2, *SIZE, CALIBRATION)
        cv2.rectangle(image, *((round(float(x)), round(float(y)))
                               for x, y in zip(columns, rows, strict=True)), colour, -1)
    return image


def seen(view=None, image=None, points=NOTHING, pose=(0.0, 0.0, 0.0), time=0.0):
    return LANE.Seen(time, picture() if image is None else image,
                floor(*lane()) if view is None else view, points, pose)


def wall(along, aside, step=0.02):
    """Points of a wall from x to x at y, or from y to y at x: (axis, fixed), ..."""
    low, high = along
    run = np.arange(low, high, step)
    return np.stack((run, np.full(len(run), aside)), 1)


@pytest.mark.parametrize("change, said", [
    ("height: 0.129", "camera.height must be a number, 0.01 to 2; got 'high'"),
    ("far: 0.60", "view.far must be a number"),
    ("clip_percent: 1.0", "clip_percent must be a number"),
])
def test_a_wrong_number_of_the_calibration_is_named(tmp_path, change, said):
    path = tmp_path / "camera.yaml"
    key = change.split(":")[0]
    path.write_text(CONFIG.read_text().replace(change, f"{key}: high"))
    with pytest.raises(CalibrationError, match=f"camera.yaml: {said.split(';')[0]}"):
        load_calibration(path)
    with pytest.raises(CalibrationError, match="No such file"):
        load_calibration(tmp_path / "none.yaml")
    path.write_bytes("height: 高".encode("gbk"))
    with pytest.raises(CalibrationError, match=r"camera.yaml: cannot be read: 'utf-8' codec"):
        load_calibration(path)


@pytest.mark.parametrize("text", ["a: 2020-13-45", "a: !!int ''", "a: !!bool x", "[" * 1000])
def test_what_the_yaml_parser_gives_up_on_is_one_line(tmp_path, text):
    (tmp_path / "camera.yaml").write_text(text)
    with pytest.raises(CalibrationError, match=r"camera\.yaml: cannot be read: [^\n]{1,300}$"):
        load_calibration(tmp_path / "camera.yaml")


def test_a_list_of_aliases_is_not_spelt_out(tmp_path):
    bomb = ", ".join(f"&b{n} [{', '.join([f'*b{n - 1}' if n else 'a'] * 10)}]" for n in range(9))
    (tmp_path / "camera.yaml").write_text(f"clip_percent: [{bomb}]")
    with pytest.raises(CalibrationError, match=r"clip_percent must be a number, .{1,200}$"):
        load_calibration(tmp_path / "camera.yaml")


def test_a_camera_that_looks_elsewhere_sees_no_bar():
    image = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    for pitch in (-1.0, 1.0):
        assert BAR.bar_distance(image, replace(CALIBRATION, pitch=pitch)) is None


def test_the_picture_of_a_lane_becomes_the_lane_from_above():
    image = np.zeros((SIZE[1], SIZE[0], 3), np.uint8)
    for colour, left in ((YELLOW, 0.125), (WHITE, -0.125)):
        for aside in np.arange(-0.01, 0.011, 0.001):
            x = np.arange(0.1, 0.7, 0.001) - CALIBRATION.forward
            columns, rows = to_pixel(x, np.full_like(x, left + aside),
                                     np.full_like(x, -CALIBRATION.height), *SIZE, CALIBRATION)
            image[rows.astype(int).clip(0, 239), columns.astype(int)] = colour
    view = cv2.remap(image, *floor_maps(*SIZE, CALIBRATION), cv2.INTER_LINEAR)
    found = find_lane(compensate(view // 2, 1.0), 0.0, CALIBRATION)
    assert found.yellow == pytest.approx(0.125, abs=0.01)
    assert found.white == pytest.approx(-0.125, abs=0.01)


@pytest.mark.parametrize("view, centre", [
    (floor(*lane(0.05)), 0.05),
    (floor(lane(-0.04)[0]), -0.04),  # the white line is broken by an intersection
    (floor(lane(-0.04)[1]), -0.04),
    (floor(*lane(), (WHITE, (AHEAD, 0.115), (AHEAD, -0.115))), 0.0),  # a stop line across
    (floor(), None),
])
def test_the_lane_s_middle(view, centre):
    found = find_lane(view, 0.0, CALIBRATION).centre(CALIBRATION.lane_width)
    assert found == (centre if centre is None else pytest.approx(centre, abs=0.01))


def test_the_lane_keeper_turns_to_the_middle_and_slows_down_without_one():
    keeper = LANE.LaneKeeper(CALIBRATION)
    speed, turn = keeper.steer(keeper.look(floor(*lane(0.05))), 0.0)
    assert speed > 0.1 and turn > 0.1
    for tick in range(8):
        slow, _ = keeper.steer(keeper.look(floor()), tick / 10)
    assert slow < speed


@pytest.mark.parametrize("colour, name", [(RED, "red"), (YELLOW, "yellow"), ((0, 255, 0), "green")])
def test_a_lit_lamp(colour, name):
    assert LIGHT.lit_lamp(picture((colour, 0.5, 0.18, 0.08, 0.09, 0.09)), CALIBRATION) == name
    assert LIGHT.lit_lamp(picture((tuple(c // 3 for c in colour), 0.5, 0.18, 0.08, 0.09, 0.09)),
                    CALIBRATION) is None
    assert LIGHT.lit_lamp(picture((colour, 0.5, 0.18, -0.12, 0.3, 0.02)), CALIBRATION) is None


def test_the_light_is_obeyed_and_forgotten_when_it_is_passed():
    light = LIGHT.TrafficLight(CALIBRATION)
    for colour, command, done in ((RED, (0.0, 0.0), False), (YELLOW, (0.0, 0.0), False),
                                  ((0, 255, 0), None, False), (None, None, True)):
        image = picture((colour, 0.5, 0.18, 0.08, 0.09, 0.09)) if colour else picture()
        assert light.step(seen(image=image)) == command
        assert light.done == done


def test_the_bar_s_distance_and_the_robot_that_waits_for_it():
    closed = picture(((0, 0, 60), 0.3, 0.0, -0.01, 0.12, 0.03))
    assert BAR.bar_distance(closed, CALIBRATION) == pytest.approx(0.3, abs=0.06)
    assert BAR.bar_distance(picture(((0, 0, 60), 0.3, 0.2, 0.1, 0.03, 0.12)), CALIBRATION) is None
    bar = BAR.Bar(CALIBRATION)
    assert bar.step(seen(image=closed)) == (0.0, 0.0)
    assert bar.step(seen(pose=(0.3, 0.0, 0.0))) is None and not bar.done
    bar.step(seen(pose=(0.7, 0.0, 0.0)))
    assert bar.done


def test_barriers_move_the_aim():
    left = np.array([[0.3, 0.05], [0.3, 0.10]])
    assert LANE.between(0.0, NOTHING) == 0.0
    assert LANE.between(0.0, left) == pytest.approx(-0.07)
    assert LANE.between(0.0, -left * (-1, 1)) == pytest.approx(0.07)
    assert LANE.between(0.0, left + np.array((0.3, 0.0))) == 0.0  # still far


def test_the_wall_on_the_right_is_followed_through_the_tunnel():
    near, far = TUNNEL.WALL - 0.08, TUNNEL.WALL + 0.08
    assert TUNNEL.along_wall(wall((-0.5, 1.0), -near))[1] > 0.1
    assert TUNNEL.along_wall(wall((-0.5, 1.0), -far))[1] < -0.1
    corner = np.concatenate((wall((-0.5, 0.3), -TUNNEL.WALL), wall((-0.2, 0.5), 0.3)[:, ::-1]))
    assert TUNNEL.along_wall(corner)[1] > 0.5
    tunnel, inside = TUNNEL.Tunnel(CALIBRATION), seen(view=floor(), points=wall((-0.5, 1.0), -0.25))
    commands = [tunnel.step(inside) for _ in range(7)]
    assert commands[0] is None and commands[-1] is not None
    for _ in range(5):
        last = tunnel.step(seen(points=wall((-0.5, 0.2), -0.25)))
    assert last is None and tunnel.done


def test_the_way_into_the_car_park_and_the_free_bay():
    lines = [(WHITE, (x, 0.15), (x, 0.4)) for x in (0.2, 0.45)]
    assert PARK.way_in(floor(*lane(), *lines), CALIBRATION) == pytest.approx(0.325, abs=0.01)
    assert PARK.way_in(floor(*lane(), lines[0]), CALIBRATION) is None
    parked = np.array([[0.0, PARK.SIDEWAYS], [0.05, PARK.SIDEWAYS + 0.1]])
    assert PARK.free_side(parked) == -1 and PARK.free_side(-parked) == 1


def test_parking_goes_in_and_out_and_ends_where_it_turned_off():
    parking, x, y, yaw, time, deepest = PARK.Parking(CALIBRATION), 0.0, 0.0, 0.0, 0.0, (0.0, 0.0)
    view = floor(*lane(), *((WHITE, (d, 0.15), (d, 0.4)) for d in (0.2, 0.45)))
    parked = np.array([[0.0, PARK.SIDEWAYS]])
    for _ in range(1200):
        command = parking.step(seen(view, points=parked, pose=(x, y, yaw), time=time))
        if parking.done:
            break
        speed, turn = command
        x, y = x + speed * math.cos(yaw) * 0.1, y + speed * math.sin(yaw) * 0.1
        yaw, time = yaw + turn * 0.1, time + 0.1
        deepest = max(deepest, (round(x, 2), round(y, 2)))
    assert parking.done and deepest == pytest.approx((0.325 + PARK.SIDEWAYS, PARK.IN), abs=0.03)
    assert (x, y, yaw) == pytest.approx((0.325, 0.0, 0.0), abs=0.03)


def test_the_course_takes_its_missions_in_order_and_stands_at_the_red_line():
    line = floor(*lane(), (RED, (0.15, 0.1), (0.15, -0.1)))
    course = LANE.Driver(CALIBRATION, [LIGHT.TrafficLight, BAR.Bar, TUNNEL.Tunnel, COURSE.Finish])
    assert type(course.missions[0]) is LIGHT.TrafficLight
    assert course.drive(seen(view=line))[0] > 0  # the start
    course.drive(seen(image=picture(((0, 255, 0), 0.5, 0.18, 0.08, 0.09, 0.09))))
    course.drive(seen())
    assert type(course.missions[0]) is BAR.Bar
    for _ in range(7):  # the bar was open
        course.drive(seen(view=floor(), points=wall((-0.5, 1.0), -0.25)))
    assert type(course.missions[0]) is TUNNEL.Tunnel
    for _ in range(5):
        course.drive(seen(points=wall((-0.5, 0.2), -0.25)))
    assert type(course.missions[0]) is COURSE.Finish
    assert course.drive(seen(view=line)) == (0.0, 0.0)
    assert course.drive(seen()) == (0.0, 0.0)
