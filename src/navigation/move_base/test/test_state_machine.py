"""move_base's rules, with a clock of our own."""

from dataclasses import replace

import pytest

from move_base.plugin import settings_from, table
from move_base.state_machine import Patience, State, StateMachine, Trigger

DEFAULT = settings_from(Patience, {entry.name: entry.default for entry in table("move_base")})


@pytest.fixture
def machine():
    """Two recoveries, and a goal that was given at 100 s."""
    made = StateMachine(DEFAULT, recoveries=2)
    made.goal = made.begin(100.0)
    return made


def with_(machine, **changes):
    """Other parameters."""
    machine.patience = replace(machine.patience, **changes)


def test_a_new_goal_is_planned(machine):
    """Before anything else."""
    assert machine.state is State.PLANNING and machine.wants_plan


def test_no_goal_wants_no_plan():
    """Neither before the first nor after the last."""
    machine = StateMachine(DEFAULT)
    assert not machine.wants_plan
    machine.begin(0.0)
    machine.end()
    assert not machine.wants_plan and machine.state is State.PLANNING


def test_a_plan_begins_the_drive_and_ends_planning_without_a_frequency(machine):
    """planner_frequency 0: only one plan."""
    machine.planned(machine.goal, True, 100.5)
    assert machine.state is State.CONTROLLING and not machine.wants_plan


def test_with_a_frequency_planning_goes_on(machine):
    """planner_frequency above 0."""
    with_(machine, planner_frequency=5.0)
    machine.planned(machine.goal, True, 100.5)
    assert machine.state is State.CONTROLLING and machine.wants_plan


def test_a_failed_replan_does_not_stop_the_drive(machine):
    """The last path still holds."""
    with_(machine, planner_frequency=5.0)
    machine.planned(machine.goal, True, 100.5)
    machine.planned(machine.goal, False, 200.0)
    assert machine.state is State.CONTROLLING


def test_the_plan_of_an_earlier_goal_counts_for_nothing(machine):
    """It came too late."""
    machine.begin(101.0)
    machine.planned(machine.goal, True, 101.5)
    assert machine.state is State.PLANNING
    machine.end()
    machine.planned(machine.goal + 2, True, 101.5)
    assert machine.state is State.PLANNING


@pytest.mark.parametrize(("now", "state"), [(105.0, State.PLANNING), (105.1, State.CLEARING)])
def test_planner_patience(machine, now, state):
    """5 s, then recovery."""
    machine.planned(machine.goal, False, now)
    assert machine.state is state
    assert machine.wants_plan is (state is State.PLANNING)
    assert machine.trigger is Trigger.PLANNING


def test_max_planning_retries_counts_failures(machine):
    """The third failure is the one too many of two retries; patience is not used up."""
    with_(machine, max_planning_retries=2)
    for state in (State.PLANNING, State.PLANNING, State.CLEARING):
        machine.planned(machine.goal, False, 100.1)
        assert machine.state is state


def test_each_recovery_is_tried_once_then_the_goal_is_given_up(machine):
    """Nothing helps."""
    for n in range(2):
        machine.planned(machine.goal, False, 106.0 + 10 * n)
        assert machine.state is State.CLEARING and machine.failure() is None
        assert machine.recovery == n
        machine.recovered(110.0 + 10 * n)
        assert machine.state is State.PLANNING and machine.wants_plan
    machine.planned(machine.goal, False, 126.0)
    assert machine.failure() == (
        "Failed to find a valid plan. Even after executing recovery behaviors.")


def test_a_path_makes_all_recoveries_available_again(machine):
    """Those that were begun for want of a plan."""
    machine.planned(machine.goal, False, 106.0)
    machine.recovered(107.0)
    machine.planned(machine.goal, True, 108.0)
    machine.took_path()
    assert machine.recovery == 0


def test_recoveries_can_be_switched_off(machine):
    """recovery_behavior_enabled."""
    with_(machine, recovery_behavior_enabled=False)
    machine.planned(machine.goal, False, 106.0)
    assert machine.failure() is not None


def test_no_velocity_means_a_new_plan_until_patience_ends(machine):
    """controller_patience counts from the last velocity."""
    machine.planned(machine.goal, True, 101.0)
    machine.controlled(True, True, 101.0)
    machine.controlled(False, False, 116.0)
    assert machine.state is State.PLANNING and machine.wants_plan
    machine.planned(machine.goal, True, 116.05)
    machine.controlled(False, False, 116.1)
    assert machine.state is State.CLEARING and machine.trigger is Trigger.CONTROLLING
    for now in (116.2, 132.0):
        machine.recovered(now)
        machine.planned(machine.goal, True, now)
        machine.took_path()
        machine.controlled(False, False, now + 16.0)
    assert machine.failure() == (
        "Failed to find a valid control. Even after executing recovery behaviors.")


def test_a_velocity_makes_all_recoveries_available_again(machine):
    """Those that were begun for want of a velocity."""
    machine.planned(machine.goal, True, 101.0)
    machine.controlled(False, False, 116.0)
    machine.recovered(117.0)
    assert machine.recovery == 1
    machine.planned(machine.goal, True, 118.0)
    machine.took_path()
    assert machine.recovery == 1
    machine.controlled(True, True, 118.0)
    assert machine.recovery == 0


def test_oscillation(machine):
    """Less than 0.5 m in 10 s; a way of 0.5 m, also in small steps, begins anew."""
    with_(machine, oscillation_timeout=10.0)
    machine.planned(machine.goal, True, 100.0)
    machine.at(0.0, 0.0, 100.0)
    machine.at(0.3, 0.0, 105.0)
    machine.at(0.5, 0.0, 109.0)
    assert not machine.oscillates(119.0)
    machine.at(0.2, 0.1, 119.0)
    assert machine.oscillates(119.1) and machine.state is State.CLEARING
    machine.recovered(120.0)
    machine.planned(machine.goal, True, 121.0)
    assert not machine.oscillates(130.0)
    assert machine.oscillates(130.1)
    machine.recovered(131.0)
    assert machine.oscillates(142.0)
    assert machine.failure() == "Robot is oscillating. Even after executing recovery behaviors."


def test_a_plan_does_not_cut_recovery_short(machine):
    """With planner_frequency above 0, as the planner answers a little too late."""
    with_(machine, oscillation_timeout=10.0, planner_frequency=5.0)
    machine.planned(machine.goal, True, 100.0)
    assert machine.oscillates(110.1) and not machine.wants_plan
    machine.planned(machine.goal, True, 110.2)
    assert machine.state is State.CLEARING
    machine.recovered(112.0)
    assert machine.wants_plan


def test_who_gets_about_after_oscillating_has_all_recoveries_again(machine):
    """And a timeout of 0 is none."""
    assert not machine.oscillates(1e6)
    with_(machine, oscillation_timeout=10.0)
    machine.at(0.0, 0.0, 100.0)
    assert machine.oscillates(111.0)
    machine.recovered(111.0)
    machine.at(0.5, 0.0, 112.0)
    assert machine.recovery == 0


def test_while_the_robot_cannot_see_patience_does_not_run_out(machine):
    """For plans, velocities and oscillation."""
    with_(machine, oscillation_timeout=10.0)
    machine.hold(200.0)
    machine.planned(machine.goal, False, 204.0)
    assert machine.state is State.PLANNING
    machine.planned(machine.goal, True, 204.0)
    assert not machine.oscillates(209.0)
    machine.controlled(False, False, 214.0)
    assert machine.state is State.PLANNING


def test_who_drives_but_gets_no_nearer_must_recover_and_then_give_up(machine):
    """With progress_timeout; a velocity alone makes no recovery available again."""
    with_(machine, progress_timeout=15.0)
    machine.planned(machine.goal, True, 100.0)
    for nearer, now, state in ((True, 101.0, State.CONTROLLING), (False, 116.0, State.CONTROLLING),
                               (False, 116.1, State.CLEARING)):
        machine.controlled(True, nearer, now)
        assert machine.state is state
    for now in (120.0, 140.0):
        assert machine.failure() is None
        machine.recovered(now)
        machine.planned(machine.goal, True, now)
        machine.controlled(True, False, now + 1.0)
        assert machine.state is State.CONTROLLING
        machine.controlled(True, False, now + 15.1)
        assert machine.state is State.CLEARING
    assert machine.failure() == (
        "Failed to find a valid control. Even after executing recovery behaviors.")


def test_without_a_progress_timeout_a_velocity_is_enough_as_upstream(machine):
    machine.planned(machine.goal, True, 100.0)
    machine.controlled(True, False, 1e6)
    assert machine.state is State.CONTROLLING
