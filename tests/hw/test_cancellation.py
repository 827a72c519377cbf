"""What is being opened can be called off until it is open, and leaves nothing behind."""

from __future__ import annotations

import threading

import pytest

from tangy_hw.cancellation import Cancellation, Cancelled


def test_what_was_started_is_ended_the_newest_first_and_once() -> None:
    opening, ended = Cancellation(), list[str]()
    opening.register(lambda: ended.append("bench"))
    opening.register(lambda: ended.append("robot"))
    opening.check()
    opening.cancel()
    opening.cancel()
    assert ended == ["robot", "bench"]
    with pytest.raises(Cancelled):
        opening.check()


def test_what_was_just_being_started_is_ended_as_well() -> None:
    opening, ended = Cancellation(), list[str]()
    opening.cancel()
    opening.register(lambda: ended.append("late"))
    assert ended == ["late"]


def test_what_is_open_is_not_called_off_any_more() -> None:
    opening, ended = Cancellation(), list[str]()
    opening.register(lambda: ended.append("robot"))
    opening.complete()
    opening.register(lambda: ended.append("another one"))
    opening.cancel()
    opening.check()
    assert (ended, opening.cancelled) == ([], False)


def test_what_was_called_off_does_not_become_open() -> None:
    opening = Cancellation()
    opening.cancel()
    with pytest.raises(Cancelled):
        opening.complete()


def test_an_end_may_look_whether_it_was_called_off() -> None:
    """It is called without the lock, so that whoever ends can go on from there."""
    opening, seen = Cancellation(), list[bool]()

    def end() -> None:
        other = threading.Thread(target=lambda: opening.register(lambda: seen.append(True)))
        other.start()
        other.join(5)

    opening.register(end)
    opening.cancel()
    assert seen == [True]
