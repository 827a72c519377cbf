"""Cards: their numbers, winning lines, and card states."""

from __future__ import annotations

from dataclasses import replace
from itertools import combinations
from random import Random

import pytest
from hypothesis import given
from hypothesis import strategies as st

from tangy_profiles.activity import Activity, load_activity
from tangy_profiles.cards import PATTERNS, CardState, Column, Deck, judge, judge_partly, read_deck
from tangy_profiles.errors import ProfileError
from tangy_profiles.reading import Table

BINGO = load_activity("bingo")
DECK = BINGO.deck
masks = st.integers(0, 2**25 - 1)


@st.composite
def decks(draw: st.DrawFn) -> Deck:
    rows, width = draw(st.integers(1, 6)), draw(st.integers(1, 6))
    size = draw(st.integers(rows, 12))
    columns = tuple(Column(chr(65 + i), i * size + 1, (i + 1) * size) for i in range(width))
    possible = [p for p in PATTERNS if p != "diagonal" or rows == width]
    patterns = draw(st.lists(st.sampled_from(possible), min_size=1, unique=True))
    free = rows % 2 == 1 and width % 2 == 1 and draw(st.booleans())
    return Deck(columns, rows, free, tuple(patterns))


def cells_of(mask: int, deck: Deck) -> set[tuple[int, int]]:
    width = len(deck.columns)
    return {divmod(c, width) for c in range(deck.rows * width) if mask >> c & 1}


def test_bingo_cards_are_five_by_five_of_seventy_five_balls_without_free_centre() -> None:
    assert DECK.numbers == tuple(range(1, 76))
    assert [(c.letter, c.low, c.high) for c in DECK.columns] == [
        ("B", 1, 15), ("I", 16, 30), ("N", 31, 45), ("G", 46, 60), ("O", 61, 75),
    ]  # fmt: skip
    assert (DECK.rows, DECK.free) == (5, 0)
    assert len(DECK.lines) == 12
    assert [DECK.label(n) for n in (1, 15, 16, 31, 46, 75)] == [
        "B-1", "B-15", "I-16", "N-31", "G-46", "O-75",
    ]  # fmt: skip


@given(decks(), st.integers())
def test_a_dealt_card_has_distinct_numbers_each_in_its_column(deck: Deck, seed: int) -> None:
    card = deck.deal(Random(seed).random)
    width = len(deck.columns)
    assert len(set(card)) == len(card) == deck.rows * width
    for place, number in enumerate(card):
        column = deck.columns[place % width]
        assert column.low <= number <= column.high


@given(decks(), st.integers())
def test_every_number_is_called_once(deck: Deck, seed: int) -> None:
    assert sorted(deck.shuffled(Random(seed).random)) == list(deck.numbers)


@given(st.floats(0, 1, exclude_max=True))
def test_dealing_and_shuffling_take_every_number_a_generator_can_give(constant: float) -> None:
    assert len(set(DECK.deal(lambda: constant))) == 25
    assert len(set(DECK.shuffled(lambda: constant))) == 75


def test_dealt_numbers_are_uniform_over_numbers_and_rows() -> None:
    rng = Random(7)
    seen: dict[tuple[int, int], int] = {}
    for _ in range(3000):
        for place, number in enumerate(DECK.deal(rng.random)):
            seen[place // 5, number] = seen.get((place // 5, number), 0) + 1
    assert len(seen) == 5 * 75
    assert 120 < min(seen.values()) <= max(seen.values()) < 290  # 200 each, SD 14


def test_the_order_of_calls_is_uniform() -> None:
    rng = Random(8)
    at: dict[tuple[int, int], int] = {}
    for _ in range(5000):
        order = DECK.shuffled(rng.random)
        for place in (0, 37, 74):
            at[place, order[place]] = at.get((place, order[place]), 0) + 1
    assert len(at) == 3 * 75
    assert 30 < min(at.values()) <= max(at.values()) < 110  # 67 each, SD 8


@given(decks())
def test_lines_match_the_patterns(deck: Deck) -> None:
    rows, width = deck.rows, len(deck.columns)
    wanted: list[set[tuple[int, int]]] = []
    if "row" in deck.patterns:
        wanted += [{(r, c) for c in range(width)} for r in range(rows)]
    if "column" in deck.patterns:
        wanted += [{(r, c) for r in range(rows)} for c in range(width)]
    if "diagonal" in deck.patterns:
        wanted += [{(i, i) for i in range(rows)}, {(i, rows - 1 - i) for i in range(rows)}]
    if "four corners" in deck.patterns:
        wanted.append({(r, c) for r in (0, rows - 1) for c in (0, width - 1)})
    everywhere = {(r, c) for r in range(rows) for c in range(width)}
    if "both diagonals" in deck.patterns and rows == width:
        wanted.append({(r, c) for r, c in everywhere if c in (r, rows - 1 - r)})
    if "border" in deck.patterns:
        wanted.append({(r, c) for r, c in everywhere if r in (0, rows - 1) or c in (0, width - 1)})
    if "whole card" in deck.patterns:
        wanted.append(everywhere)
    assert [cells_of(line, deck) for line in deck.lines] == wanted
    for cell, through in enumerate(deck.lines_through):
        assert through == tuple(line for line in deck.lines if line >> cell & 1)


@given(decks(), masks)
def test_a_card_wins_only_with_a_full_line(deck: Deck, mask: int) -> None:
    whole = [cells_of(line, deck) <= cells_of(mask, deck) for line in deck.lines]
    assert deck.wins(mask) == any(whole)
    assert all(deck.wins(line) for line in deck.lines)


@given(decks())
def test_the_free_centre_is_the_middle_cell(deck: Deck) -> None:
    middle = {(deck.rows // 2, len(deck.columns) // 2)} if deck.free_centre else set()
    assert cells_of(deck.free, deck) == middle


@given(masks, masks)
def test_a_card_is_judged_bingo_then_wrong_then_missing_then_correct(
    marked: int, called: int
) -> None:
    state = judge(BINGO.card_states, DECK, marked, called)
    if DECK.wins(marked & called):
        assert state == "bingo"
    elif marked & ~called:
        assert state == "incorrectly marked"
    elif called & ~marked:
        assert state == "missing numbers"
    else:
        assert state == "correctly marked"
        assert marked == called


def test_a_full_line_with_an_uncalled_number_is_no_win() -> None:
    row = DECK.lines[0]
    assert judge(BINGO.card_states, DECK, row, row) == "bingo"
    assert judge(BINGO.card_states, DECK, row, row & ~1) == "incorrectly marked"


@given(masks, masks, st.lists(st.integers(0, 24), max_size=4, unique=True))
def test_hidden_cells_matter_only_if_they_could_change_the_state(
    marked: int, called: int, unknown: list[int]
) -> None:
    cells = [1 << cell for cell in unknown]
    hidden = sum(cells)
    possible = {
        judge(BINGO.user_states, DECK, marked & ~hidden | sum(lying), called)
        for count in range(len(cells) + 1)
        for lying in combinations(cells, count)
    }
    told = judge_partly(BINGO.user_states, DECK, marked, hidden, called)
    assert told == (possible.pop() if len(possible) == 1 else "occluded")


@given(st.permutations(BINGO.card_states[:-1]), masks, masks)
def test_the_first_matching_card_state_applies(
    order: list[CardState], marked: int, called: int
) -> None:
    last = BINGO.card_states[-1]
    alone = [judge([state, last], DECK, marked, called) == state.name for state in order]
    first = order[alone.index(True)] if any(alone) else last
    assert judge([*order, last], DECK, marked, called) == first.name


@pytest.mark.parametrize(
    ("change", "said"),
    [
        ({"rows": 10}, "rows = 10"),
        ({"rows": 4, "free_centre": True, "patterns": ["row"]}, "free_centre = True"),
        ({"patterns": []}, "patterns = []"),
        ({"patterns": ["rwo"]}, "did you mean 'row'?"),
        ({"rows": 3, "patterns": ["diagonal"]}, "square"),
        ({"rows": 3, "patterns": ["row", "diagonal", "diagonal"]}, "square"),
        ({"columns": []}, "at least one column"),
        ({"columns": [{"letter": "B", "from": 1, "to": 3}]}, "fewer numbers than the 5 rows"),
        ({"columns": [{"letter": "B", "from": 9, "to": 3}]}, "to = 3"),
        (
            {"columns": [{"letter": c, "from": 1, "to": 9} for c in "BI"]},
            "overlaps the column before it (to 9)",
        ),
        ({"columns": [{"letter": "B", "from": 1, "to": 9, "too": 3}]}, "did you mean 'to'?"),
    ],
)
def test_a_deck_that_cannot_be_dealt_is_refused(change: dict[str, object], said: str) -> None:
    columns = [{"letter": c, "from": 9 * i + 1, "to": 9 * i + 9} for i, c in enumerate("BINGO")]
    deck = {"rows": 5, "columns": columns, "patterns": ["row", "diagonal"]} | change
    with pytest.raises(ProfileError) as caught:
        read_deck(Table(deck, "mine.toml"))
    assert said in str(caught.value)


def test_free_centre_and_patterns_are_settings(activity: Activity) -> None:
    free = replace(activity.deck, free_centre=True, patterns=("four corners",))
    assert free.free == 1 << 12
    assert len(free.lines) == 1
    assert not free.wins(activity.deck.lines[0])
