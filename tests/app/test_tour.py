"""The tour: actions of the new teacher advance it from stop to stop, and teach one real step."""

from __future__ import annotations

import asyncio

from tangy_tui.app.tour import Tour, TourStop
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.teaching import TeachingLines
from tangy_tui.learning.teaching_events import Redo, Undo
from tangy_tui.learning.teaching_session import TeachingSession
from tangy_tui.learning.verification import Reply, Say
from tangy_tui.monitoring.attention import goes_to_people
from tangy_tui.text.tour import tour_line, tour_words
from tests.support.declared import declared


def begun(workspace: Workspace) -> tuple[Tour, TeachingSession]:
    teaching = workspace.teaching("Ada", 1)
    teaching.begin()
    return Tour(), teaching


def test_a_command_its_question_and_its_answer_advance_the_tour(workspace: Workspace) -> None:
    tour, teaching = begun(workspace)
    tour.go_on()
    assert (tour.at, tour.enter_goes_on) == (TourStop.COMMAND, False)
    tour.follow(teaching.apply(Say(teaching.sayable[0])))
    assert (tour.at, tour.enter_goes_on) == (TourStop.QUESTION, False)
    tour.follow(teaching.apply(Reply(yes=False)))
    assert (tour.at, tour.enter_goes_on) == (TourStop.COMMAND, False)
    tour.follow(teaching.apply(Say(teaching.sayable[0])))
    tour.follow(teaching.apply(Reply(yes=True)))
    assert (tour.at, tour.enter_goes_on) == (TourStop.STEP, True)
    for _ in range(3):
        tour.go_on()
    assert tour.at is None


def test_a_step_taught_at_once_skips_the_earlier_stops(workspace: Workspace) -> None:
    tour, teaching = begun(workspace)
    for command in (Say(teaching.sayable[0]), Reply(yes=True)):
        tour.follow(teaching.apply(command))
    assert tour.at is TourStop.STEP


def test_each_further_step_advances_the_tour_like_enter(workspace: Workspace) -> None:
    tour, teaching = begun(workspace)
    for stop in (TourStop.STEP, TourStop.PEOPLE, TourStop.COACH, None, None):
        teaching.apply(Say(teaching.sayable[0]))
        tour.follow(teaching.apply(Reply(yes=True)))
        assert tour.at is stop


def test_a_first_step_that_is_undone_is_no_longer_told_of(workspace: Workspace) -> None:
    tour, teaching = begun(workspace)
    for command in (Say(teaching.sayable[0]), Reply(yes=True), Undo()):
        tour.follow(teaching.apply(command))
    assert (tour.at, tour.enter_goes_on) == (TourStop.UNDONE, True)
    assert "see it" not in tour_words(TourStop.UNDONE, "Ada", "Bingo", "call number")
    tour.follow(teaching.apply(Redo()))
    gone_on = tour.at
    assert gone_on is TourStop.PEOPLE


def test_a_skipped_tour_never_resumes(workspace: Workspace) -> None:
    tour, teaching = begun(workspace)
    tour.skip()
    assert not tour.follow(teaching.apply(Say(teaching.sayable[0])))
    tour.go_on()
    assert tour.at is None


def test_the_words_of_each_stop_fit_into_two_lines() -> None:
    for stop in TourStop:
        words = tour_words(stop, "Rosa-Maria", "Bingo", "greet everyone")
        assert len(words) < 2 * 78 - 14, stop  # breaks at spaces cost some columns
        assert tour_line(stop, "Rosa", "Bingo", "greet everyone")


def lines(workspace: Workspace, *typed: str) -> list[str]:
    given = iter(typed)
    said: list[str] = []
    teaching = workspace.teaching("Ada", 1)
    session = TeachingLines(teaching, lambda: next(given, None), said.append, tour=True)
    asyncio.run(session.run())
    return said


def place(said: list[str], stop: TourStop) -> int:
    return said.index(tour_line(stop, "Ada", "Bingo", "greet everyone"))


def test_without_visits_the_tour_sends_the_robot_to_nobody() -> None:
    assert not goes_to_people(declared("trivia"))
    for words in (tour_words, tour_line):
        told = words(TourStop.PEOPLE, "Ada", "Trivia", "say hello", visits=False)
        assert "at their seats" in told
        assert "Send Tangy" not in told


def test_the_tour_by_lines_teaches_one_step(workspace: Workspace) -> None:
    said = lines(workspace, "", "greet everyone", "y", "", "", "", "call number", "y")
    places = [place(said, stop) for stop in TourStop if stop is not TourStop.UNDONE]
    assert places == sorted(places)


def test_a_word_skips_the_tour_by_lines(workspace: Workspace) -> None:
    said = lines(workspace, "skip", "", "greet everyone", "y", "")
    told = [stop for stop in TourStop if tour_line(stop, "Ada", "Bingo", "greet everyone") in said]
    assert told == [TourStop.ROOM]
