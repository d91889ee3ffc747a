"""The benchmark without measuring: options, statistics, verdicts, files, processes, exit codes."""

import importlib
import json
import os
import subprocess
import sys
import time
from pathlib import Path

import numpy as np
import pytest
from sim_bench.figures import Figure, figure, ratio
from sim_bench.follower import frame_ages
from sim_bench.own_process import Contest, OwnProcess
from sim_bench.parts import growth, memory, robots, step
from sim_bench.results import (
    Criterion,
    PartResult,
    Results,
    acceptance_table,
    criteria,
    figure_table,
    judge,
    write_chart,
    write_json,
)
from sim_bench.ros_run import read_lines, stage_figures, stages
from sim_bench.settings import PARTS, parse

from evaluation.command_line import NOT_RUN
from run_session import processes
from run_session.failure import RunError
from sim_bench import main

SCRIPT = Path(__file__).parent.parent / "scripts" / "bench.py"


def results(*figures) -> Results:
    """Results of one part, renderer, with these figures."""
    machine = {"processor": "a processor", "cores": 2}
    return Results("2026-01-02T03:04:05+00:00", True, machine, [PartResult("renderer", figures)])


# --- options


def test_without_options_everything_is_measured_in_the_usual_order():
    assert parse([]).parts == PARTS
    assert parse(["--only", "step, renderer"]).parts == ("renderer", "step")


@pytest.mark.parametrize(
    ("arguments", "said"),
    [
        (["--only", "step,nothing"], "nothing"),
        (["--memory-s", "much"], "much"),
        (["--memory-s", "1"], "20 to"),
        (["--memory-s", "nan"], "nan"),
        (["--fast"], "--fast"),
    ],
)
def test_a_mistake_on_the_command_line_is_one_line(arguments, said):
    with pytest.raises(RunError) as raised:
        parse(arguments)
    assert said in str(raised.value)
    assert "\n" not in str(raised.value)


def test_an_unknown_part_ends_with_2_and_names_the_parts(tmp_path):
    command = [sys.executable, str(SCRIPT), "--only", "speed", "--out", str(tmp_path / "out")]
    done = subprocess.run(command, capture_output=True, text=True, timeout=60)
    assert done.returncode == 2
    (line,) = done.stderr.strip().splitlines()
    assert all(part in line for part in PARTS)
    assert not (tmp_path / "out").exists()


@pytest.mark.parametrize("part", PARTS)
def test_every_part_has_its_file(part):
    assert callable(importlib.import_module(f"sim_bench.parts.{part}").measure)


# --- statistics


def test_a_figure_has_the_median_the_least_and_the_greatest_run():
    one = figure("name", "ms", [5, 1, 2])
    assert (one.median, one.min, one.max, one.runs) == (2, 1, 5, (5, 1, 2))


@pytest.mark.parametrize("runs", [[], [1.0, float("nan")], [float("inf")]])
def test_no_figure_without_numbers(runs):
    with pytest.raises(ValueError, match="name"):
        figure("name", "ms", runs)


def test_a_ratio_compares_runs_that_were_taken_side_by_side():
    assert ratio("name", [10.0, 40.0], [1.0, 2.0]).runs == (10.0, 20.0)
    with pytest.raises(ValueError):
        ratio("name", [1.0, 2.0], [1.0])


def test_growth_compares_the_last_tenth_with_the_second():
    caches_fill = list(range(50, 60))
    assert memory.growth_percent(caches_fill + [100] * 90) == 0
    assert memory.growth_percent([100] * 90 + [110] * 10) == pytest.approx(10)
    with pytest.raises(ValueError):
        memory.growth_percent([1, 1])


def test_a_step_cheaper_than_the_engine_alone_is_no_comparison():
    step.check_same_work("standing", 1.02)
    with pytest.raises(RunError, match="leaves the engine out"):
        step.check_same_work("standing", 0.13)


def test_the_grid_leaves_its_middle_free():
    places = growth.grid(64, 1.0)
    assert len(set(places)) == 64
    assert (0.0, 0.0) not in places
    assert max(abs(x) for x, _ in places) <= 5


# --- age of frames


def clock(pace: float, late: float = 0.0) -> np.ndarray:
    """/clock at 100 Hz, begun at wall time 50 s; two of three messages arrive late."""
    return np.array([(50 + i * 0.01 / pace + (late if i % 3 else 0.0), i * 0.01)
                     for i in range(300)])


@pytest.mark.parametrize("pace", [0.5, 1.0, 4.0])
def test_a_frames_age_is_from_when_its_moment_was_due(pace):
    frames = np.array([(50 + 1.0 / pace + 0.030, 1.0), (50 + 1.5 / pace + 0.040, 1.5)])
    assert frame_ages(frames, clock(pace, late=0.040)) == pytest.approx([0.030, 0.040], abs=1e-6)


def test_a_frame_without_clock_around_it_has_no_age():
    assert frame_ages(np.array([(60.0, 99.0)]), clock(1.0)) == []


def test_a_time_of_the_clock_between_two_periods_is_noticed():
    assert memory.off_whole_periods(np.array([10_000_000.0, 20_000_000.0, 29_999_997.0])) == 3


def test_a_line_that_is_not_whole_yet_is_left_out(tmp_path):
    file = tmp_path / "probe.txt"
    assert read_lines(file) == []
    file.write_text("1 2.5\n3 4.")
    assert read_lines(file) == [(1.0, 2.5)]


# --- verdicts and files


def test_criteria_are_of_parts_that_exist_and_have_one_bound():
    for criterion in criteria():
        assert criterion.figure.partition("/")[0] in PARTS
        assert (criterion.at_least is None) != (criterion.at_most is None)
        if isinstance(criterion.limit, str):
            assert criterion.limit.partition("/")[0] in ("", criterion.figure.partition("/")[0])


def test_a_bound_itself_is_enough():
    least, most = Criterion("a", "step/a", at_least=4), Criterion("b", "step/b", at_most=4)
    assert least.met(4) and not least.met(3.999)
    assert most.met(4) and not most.met(4.001)


def test_only_what_was_measured_is_judged():
    verdicts = results(figure("ratio.tiny.1920x1080", "x", [30.0])).verdicts()
    assert [verdict.met for verdict in verdicts] == [False]
    assert "MISSED" in acceptance_table(verdicts)


def test_what_is_missed_says_what_binds():
    judged = judge({"fast/no_camera.driving.real_time_factor": figure("a", "x", [12.0]),
                    "fast/no_camera.driving.bare_step": figure("b", "us", [41.5])})
    assert "What binds, no camera, driving: no_camera.driving.bare_step 41.5 us" in (
        acceptance_table(judged))
    assert "binds" not in acceptance_table(judge({
        "fast/no_camera.driving.real_time_factor": figure("a", "x", [31.0]),
        "fast/no_camera.driving.bare_step": figure("b", "us", [20.0])}))


def test_the_share_of_the_limit_is_told_of_times_and_of_rates():
    judged = judge({"growth/robots.8": figure("a", "ms", [200.0]),
                    "growth/engine.robots.8": figure("b", "ms", [150.0]),
                    "step/ratio.driving": figure("c", "x", [1.25]),
                    "fast/lockstep.real_time_factor": figure("d", "x", [5.0]),
                    "fast/lockstep.limit": figure("e", "x", [10.0]),
                    "ros/1080p.cpu.gazebo": figure("f", "%", [70.0])})  # its limit failed
    assert {verdict.criterion.figure: verdict.share for verdict in judged} == {
        "growth/robots.8": 0.75, "step/ratio.driving": 0.8,
        "fast/lockstep.real_time_factor": 0.5, "ros/1080p.cpu.gazebo": None}
    assert "75%" in acceptance_table(judged)


STAGES = """[INFO] stages of the work in 10 s
stage           times   ms each  worst ms   share
draw               10    50.000    263.83   13.5%
send                9     3.000      7.82    3.4%
[INFO] stages of the work in 20 s
stage           times   ms each  worst ms   share
draw               20    30.000    263.83   20.6%
read back          10     1.000      5.87    3.5%
wait               10    90.000     91.00   30.0%
scene              10     0.100      0.20    0.0%
send               19     4.000      7.82    6.5%
[gazebo-2] killing on exit
"""


def test_stages_are_told_for_one_frame_without_those_before_the_first_table(tmp_path):
    log = tmp_path / "roslaunch.log"
    log.write_text(STAGES)
    found = {one.name: one.median for one in stage_figures("drive", stages(log, turn="send"))}
    assert found == pytest.approx({"drive.stage.draw": (600 - 500) / 10,
                                   "drive.stage.send": (76 - 27) / 10,
                                   "drive.stage.read_back": 1.0})
    assert stages(log, turn="depth") == {}
    log.write_text("nothing was printed")
    assert stages(log, turn="send") == {}


def read_json(path) -> Results:
    """What `write_json` wrote."""
    values = json.loads(path.read_text(encoding="utf-8"))
    parts = [PartResult(**{**part, "figures": tuple(
        Figure(**{**one, "runs": tuple(one["runs"])}) for one in part["figures"])})
        for part in values["parts"]]
    return Results(values["began"], values["quick"], values["machine"], parts)


def test_json_holds_figures_runs_and_verdicts(tmp_path):
    file = tmp_path / "bench.json"
    written = results(figure("ratio.tiny.1920x1080", "x", [40.0, 36.0, 38.0]))
    write_json(written, file)
    assert read_json(file) == written
    values = json.loads(file.read_text())
    assert values["parts"][0]["figures"][0]["runs"] == [40.0, 36.0, 38.0]
    assert [one["met"] for one in values["acceptance"]] == [True]


def test_the_table_says_when_others_used_the_machine():
    one = figure("a", "ms", [1.0])
    assert "quiet" not in figure_table(PartResult("step", (one,), others_percent=3.0))
    assert "quiet" in figure_table(PartResult("step", (one,), others_percent=60.0))


@pytest.mark.parametrize("names", [(), ("frame.ours.640x480", "ratio.tiny.1920x1080")])
def test_a_chart_is_drawn_of_what_there_is(tmp_path, names):
    file = tmp_path / "bench.png"
    write_chart(results(*(figure(name, "ms", [1.0, 3.0, 2.0]) for name in names)), file)
    assert file.read_bytes().startswith(b"\x89PNG")


# --- processes


@pytest.mark.parametrize(
    ("line", "name"),
    [
        ("python3 -P -m bullet_sim_ros --world w __name:=gazebo __log:=x", "gazebo"),
        ("/usr/bin/python3 /usr/bin/rosmaster --core -p 4000", "rosmaster"),
        ("python3 -P -m sim_bench.probes follower out 05.py __name:=follower", "follower"),
        ("python3 /usr/bin/roslaunch -p 4000 learning_topic 0course.launch", "roslaunch"),
        ("sh -c something", "its parent"),
    ],
)
def test_processes_have_the_names_that_ros_gave_them(line, name):
    assert processes.process_name(line, "its parent") == name


def test_a_child_is_found_with_its_memory():
    with subprocess.Popen(["sleep", "60"]) as child:
        name = Path(f"/proc/{child.pid}/comm")
        while name.read_text() != "sleep\n":  # until then it is a copy of this process
            time.sleep(0.01)
        (found,) = [process for process in processes.processes() if process.pid == child.pid]
        child.kill()
    assert found.memory > 0


def test_the_launch_file_spawns_every_robot_in_its_own_namespace():
    text = robots.launch_file_text()
    assert all(f'ns="{name}"' in text for name in robots.PLACES)
    assert text.count("spawn_model") == robots.COUNT


def test_who_cannot_is_left_out_of_a_contest_unless_it_is_ours(capsys):
    with Contest({"2": "ours", "x": "theirs"}) as contest:
        assert contest.turn(int) == {"2": [2]}
        assert "left out: theirs: invalid literal" in capsys.readouterr().out
        assert contest.turn(str) == {"2": ["2"]}
        with pytest.raises(RunError, match="ours: "):
            contest.turn(getattr, "no_such")


def test_a_crash_in_a_process_of_its_own_is_an_error_and_a_result_is_of_each_process():
    with OwnProcess("two processes", count=2) as both:
        assert both.call(max, 1, 2) == [2, 2]
        for _ in range(2):  # at the second both are dead already
            with pytest.raises(RunError, match="two processes: it died"):
                both.call(os._exit, 1)  # a process that cannot import what it calls dies as well


def test_whatever_is_raised_in_a_process_of_its_own_is_an_error_of_one_line():
    with OwnProcess("a process") as process:
        for text, call in (("a process: No module named 'no_such'",
                            (importlib.import_module, "no_such")),
                           ("a process: two lines", (exec, "raise ValueError('two\\nlines')")),
                           ("a process: error", (exec, "import pybullet; raise pybullet.error"))):
            with pytest.raises(RunError) as raised:
                process.call(*call)
            assert str(raised.value) == text
        assert process.call(max, 1, 2) == [2]


def test_a_part_that_fails_is_said_and_the_others_go_on(tmp_path, monkeypatch, capsys):

    def fail(_settings):
        raise RunError("nothing works")

    monkeypatch.setattr(growth, "measure", fail)
    monkeypatch.setattr(step, "measure", lambda _settings: [figure("ratio.driving", "x", [1.1])])
    assert main.main(["--only", "step,growth", "--out", str(tmp_path)]) == NOT_RUN
    assert "part growth: nothing works" in capsys.readouterr().err
    parts = {part.part: part for part in read_json(tmp_path / "bench.json").parts}
    assert parts["step"].figures and parts["growth"].failure == "nothing works"
