"""The options of a game that an activity offers to staff, read from its file."""

from __future__ import annotations

from pathlib import Path

import pytest

from tangy_profiles.activity import load_activity, read_activity
from tangy_profiles.cards import Deck
from tangy_profiles.errors import ProfileError, TangyError
from tangy_profiles.game_rules import PACES, Patterns, next_pace

BINGO = load_activity("bingo")
ROW, COLUMN, CORNERS = 0b11111, 0x108421, 0x1100011
RIM = 0x1F8C63F
CROSS = 0x1151151


def on(name: str) -> Deck:
    return BINGO.rules.pattern(name).on(BINGO.deck)


@pytest.mark.parametrize(
    ("name", "wins", "loses"),
    [
        ("line", ROW, ROW - 1),
        ("two lines", ROW | COLUMN, ROW | COLUMN << 1 & ~ROW & ~(1 << 6)),
        ("four corners", CORNERS, CORNERS & ~1),
        ("x", CROSS, CROSS & ~1),
        ("frame", RIM, RIM & ~1),
        ("full card", 2**25 - 1, 2**25 - 2),
    ],
)
def test_a_card_wins_by_a_full_pattern(name: str, wins: int, loses: int) -> None:
    assert on(name).wins(wins) and not on(name).wins(loses)


def test_one_line_is_not_two() -> None:
    assert not on("two lines").wins(ROW)


def test_no_chosen_pattern_keeps_the_deck_of_the_activity() -> None:
    patterns = Patterns.of(BINGO.rules, BINGO.deck, ())
    assert patterns.played == BINGO.deck and not patterns.advance()


def test_chosen_patterns_are_played_in_turn() -> None:
    patterns = Patterns.of(BINGO.rules, BINGO.deck, ("line", "x"))
    assert patterns.played.lines == BINGO.deck.lines
    assert patterns.advance() and patterns.played == on("x") and not patterns.advance()


def test_a_pattern_is_found_by_name_or_label() -> None:
    assert BINGO.rules.pattern("The Frame") is BINGO.rules.pattern("frame")
    with pytest.raises(TangyError, match="frame"):
        BINGO.rules.pattern("frames")


@pytest.mark.parametrize(
    ("said", "name"),
    [
        ("one line", "line"),
        ("1 line", "line"),
        ("a single line", "line"),
        ("2 lines", "two lines"),
        ("the four corners", "four corners"),
        ("4 corners", "four corners"),
        ("a full card", "full card"),
    ],
)
def test_a_pattern_is_found_as_people_count_it(said: str, name: str) -> None:
    assert BINGO.rules.pattern(said).name == name


def test_a_strength_excludes_strategies_that_it_does_not_name() -> None:
    assert BINGO.rules.left_out("gentle") == ("scarcity",)
    assert BINGO.rules.left_out("") == () == BINGO.rules.left_out("full")


@pytest.mark.parametrize(
    ("old", "new", "key"),
    [
        ('shapes = ["border"]', 'shapes = ["rim"]', "shapes"),
        ('name = "frame"', 'name = "x"', "patterns"),
        ('claim_right = "Card {card}', 'claim_right = "Card {person}', "claim_right"),
        ("unvisited = 15", "unvisited = -1", "unvisited"),
        ('claim = "bingo"', 'claim = "Left"', r"claim = 'Left' \(line 90\).*command of staff"),
        ('strategies = ["neutral"]', "strategies = []", "strategies"),
    ],
)
def test_a_mistake_is_reported_with_its_key(tmp_path: Path, old: str, new: str, key: str) -> None:
    shipped = Path(load_activity.__globals__["shipped_activities"]()["bingo"])
    file = tmp_path / "mine.toml"
    file.write_text(shipped.read_text(encoding="utf-8").replace(old, new, 1), encoding="utf-8")
    with pytest.raises(ProfileError, match=key):
        read_activity(file)


def test_faster_and_slower_choose_the_next_pace() -> None:
    assert [next_pace(12, by) for by in (-1, 1)] == [10, 15]
    assert [next_pace(20, by) for by in (-1, 1)] == [15, 25]
    assert (next_pace(PACES[0], -1), next_pace(PACES[-1], 1)) == (PACES[0], PACES[-1])
