"""An opening can be cancelled until it completes, and leaves nothing behind."""

from __future__ import annotations

import threading

import pytest

from tangy_hw.cancellation import Cancellation, Cancelled


def test_cancel_ends_each_started_part_once_and_newest_first() -> None:
    opening, ended = Cancellation(), list[str]()
    opening.register(lambda: ended.append("bench"))
    opening.register(lambda: ended.append("robot"))
    opening.check()
    opening.cancel()
    opening.cancel()
    assert ended == ["robot", "bench"]
    with pytest.raises(Cancelled):
        opening.check()


def test_a_part_registered_after_cancel_is_ended_at_once() -> None:
    opening, ended = Cancellation(), list[str]()
    opening.cancel()
    opening.register(lambda: ended.append("late"))
    assert ended == ["late"]


def test_cancel_after_completion_does_nothing() -> None:
    opening, ended = Cancellation(), list[str]()
    opening.register(lambda: ended.append("robot"))
    opening.complete()
    opening.register(lambda: ended.append("another one"))
    opening.cancel()
    opening.check()
    assert (ended, opening.cancelled) == ([], False)


def test_a_cancelled_opening_cannot_complete() -> None:
    opening = Cancellation()
    opening.cancel()
    with pytest.raises(Cancelled):
        opening.complete()


def test_an_end_handler_runs_without_the_lock() -> None:
    """The handler runs without the lock, so that another thread can register a part."""
    opening, seen = Cancellation(), list[bool]()

    def end() -> None:
        other = threading.Thread(target=lambda: opening.register(lambda: seen.append(True)))
        other.start()
        other.join(5)

    opening.register(end)
    opening.cancel()
    assert seen == [True]
