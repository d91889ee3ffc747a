"""Calls from other threads run in the loop's thread, and nobody waits for ever."""

import threading

import pytest

from bullet_sim_ros.mailbox import Closed, Mailbox


def in_thread(function):
    """Run in a thread; a function that joins it and gives back result or exception."""
    box = []

    def run():
        try:
            box.append(function())
        except Exception as error:
            box.append(error)

    thread = threading.Thread(target=run)
    thread.start()

    def result():
        thread.join(timeout=60)
        assert not thread.is_alive()
        return box[0]
    return result


def test_a_call_runs_in_the_loop_and_brings_its_result():
    mailbox = Mailbox()
    result = in_thread(lambda: mailbox.call(threading.get_ident))
    mailbox.run_pending(wait=60.0)
    assert result() == threading.get_ident()


def test_an_exception_reaches_the_caller():
    mailbox = Mailbox()
    result = in_thread(lambda: mailbox.call(lambda: 1 / 0))
    mailbox.run_pending(wait=60.0)
    assert isinstance(result(), ZeroDivisionError)


def test_what_was_left_runs_in_order():
    mailbox, seen = Mailbox(), []
    for number in range(3):
        mailbox.post(lambda number=number: seen.append(number))
    mailbox.run_pending()
    assert seen == [0, 1, 2]


def test_what_was_left_and_fails_is_logged_and_the_rest_runs(caplog):
    mailbox, seen = Mailbox(), []
    mailbox.post(lambda: 1 / 0)
    mailbox.post(lambda: seen.append(1))
    mailbox.run_pending()
    assert seen == [1]
    assert "ZeroDivisionError: division by zero" in caplog.text


def test_a_closed_mailbox_answers_instead_of_hanging():
    mailbox = Mailbox()
    result = in_thread(lambda: mailbox.call(lambda: None))
    mailbox.close()
    assert isinstance(result(), Closed)


def test_run_pending_without_calls_returns_at_once():
    Mailbox().run_pending()


@pytest.mark.parametrize("error", [TimeoutError])
def test_a_time_out_inside_the_call_is_the_callers(error):
    mailbox = Mailbox()

    def late():
        raise error("late")
    result = in_thread(lambda: mailbox.call(late))
    mailbox.run_pending(wait=60.0)
    assert isinstance(result(), error)
