"""While a game runs, staff see whether several can win, and who has won already."""

from __future__ import annotations

import pytest

from tangy_profiles.game_rules import GamePlan
from tangy_tui.app.game_commands import ChoosePatterns, ClaimCard, EndGame
from tangy_tui.app.game_view import view_of
from tangy_tui.app.inquiry_grammar import AsksWhoWon, read_question
from tangy_tui.app.scripted_staff import go_on_by_script
from tangy_tui.app.typed_line import read_typed
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.text.staff_view import (
    HAS_WON,
    SEVERAL_WIN,
    SEVERAL_WINNERS,
    person_words,
    played_facts,
    played_words,
    winners_facts,
    won_words,
)
from tangy_tui.text.watching import now_lines
from tangy_tui.ui.screens.play_view import ViewSource, next_line, show_view
from tangy_tui.ui.widgets.call_board import CallBoard
from tangy_tui.ui.widgets.staff_panel import StaffPanel
from tests.support.planned_games import Planned

NAMES = {"user1": "Ann", "user2": "Ben", "user3": "Cleo", "user4": "Dora"}


def won_first(planned: Planned) -> str:
    """Play until a first person of several has won; return who it is."""
    planned.begin(GamePlan(("line", "two lines"), several=True))
    first, _ = planned.win_twice()
    while "others first" not in planned.changes():
        planned.events += go_on_by_script(planned.control, expert=True)
    return first


def test_several_winners_are_told_where_staff_look(
    planned: Planned, monkeypatch: pytest.MonkeyPatch
) -> None:
    planned.begin(GamePlan(("line",), several=True))
    facts = list[object]()
    monkeypatch.setattr(StaffPanel, "show", lambda panel, call, step, told, *_: facts.extend(told))
    source = ViewSource(planned.world, planned.control, NAMES.__getitem__)
    show_view(StaffPanel(), CallBoard(planned.world.activity.deck), planned.control.view(), source)
    assert {"for a line", SEVERAL_WINNERS} <= {*facts}
    (where,) = Inquiries(planned.control, NAMES.__getitem__, None, str).lines("where") or [""]
    assert f"Played for a line. {SEVERAL_WIN}" in where
    view = view_of(planned.control)
    assert view is not None
    assert f"{SEVERAL_WINNERS}, for a line" in " ".join(now_lines(view, None, str))


def test_patterns_that_staff_choose_in_a_game_are_told_before_the_first_win(
    planned: Planned,
) -> None:
    planned.begin(GamePlan())
    assert played_words(planned.world.patterns) == ""  # it is played as usual
    planned.control.apply(ChoosePatterns(("two lines", "full card")))
    told = "for a line, then two lines, then the full card"
    assert played_facts(planned.world.patterns) == (told, "for a line, then 2 more")
    view = view_of(planned.control)
    assert view is not None and view.patterns == ("a line", "two lines", "the full card")


def test_who_has_won_already_is_told(planned: Planned) -> None:
    first = won_first(planned)
    (person,) = [one for one in planned.control.view().people if one.has_won]
    assert person.id == first and HAS_WON in person_words(person)
    (where,) = Inquiries(planned.control, NAMES.__getitem__, None, str).lines("where") or [""]
    assert f"{NAMES[first]} {HAS_WON}." in where
    assert winners_facts([NAMES[first]]) == (f"won: {NAMES[first]}", "1 won")
    view = view_of(planned.control)
    assert view is not None and [one.id for one in view.people if one.has_won] == [first]


def test_nobody_has_won_when_another_game_begins(planned: Planned) -> None:
    won_first(planned)
    planned.control.apply(EndGame())
    planned.begin(GamePlan())
    assert planned.world.has_won == ()


ASKED = (
    *("who has won", "who won?", "Who's won so far", "who is the winner", "who are the winners"),
    *("has anybody won", "has anyone won yet?", "did somebody win", "is there a winner"),
)


@pytest.mark.parametrize("words", ASKED)
def test_questions_about_who_has_won_are_understood(words: str) -> None:
    assert read_typed(words, lambda line: None, str, lambda action: True) == AsksWhoWon()


@pytest.mark.parametrize("words", ["who waits", "several winners", "who is next", "who has a line"])
def test_other_words_do_not_ask_who_has_won(words: str) -> None:
    assert read_question(words, str) != AsksWhoWon()


def test_the_winners_are_told_with_pattern_card_and_call(planned: Planned) -> None:
    planned.begin(GamePlan())
    lines = Inquiries(planned.control, NAMES.__getitem__, None, str).lines
    assert lines("has anybody won") == ["Nobody has won yet."]
    first = won_first(planned)
    world = planned.world
    label = world.activity.deck.label(world.called_now[-1])
    at = f"card {world.known_cards[first]}, call {len(world.called_now)} ({label})"
    told = lines("who has won") or []
    assert told[0] == f"{NAMES[first]} has won with a line: {at}."
    planned.play()
    told = lines("who won") or []
    assert told[0] == "The game is over." and " has won with two lines: " in told[-1]
    won = [NAMES[one] for one in world.has_won]
    source = ViewSource(world, planned.control, NAMES.__getitem__)
    assert next_line(source) == f"The game is over. {won_words(won)}"


def test_nobody_has_won_a_game_that_staff_ended(planned: Planned) -> None:
    planned.begin(GamePlan())
    planned.control.apply(EndGame())
    lines = Inquiries(planned.control, NAMES.__getitem__, None, str).lines
    assert lines("who won") == ["The game is over.", "Nobody has won."]


def test_claims_that_win_are_celebrated_in_their_order_and_told_before(
    planned: Planned, monkeypatch: pytest.MonkeyPatch
) -> None:
    planned.begin(GamePlan(("line",), several=True))
    planned.play(2)
    world = planned.world
    monkeypatch.setattr(world, "wins", lambda card: True)
    claimed = ["user3", "user1", "user4"]
    for person in claimed:
        assert "claim right" in planned.do(ClaimCard(0, person))
    assert world.tracker.queue[:3] == claimed
    planned.do(ClaimCard(0, "user4"))  # claimed once more
    assert world.tracker.queue[:3] == claimed
    lines = Inquiries(planned.control, NAMES.__getitem__, None, str).lines
    told = [f"{NAMES[one]}'s card wins: Tangy still has to go there." for one in claimed]
    assert lines("who has won") == told
