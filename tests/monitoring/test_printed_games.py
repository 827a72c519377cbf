"""The page to print draws as many of the last games as two sheets have room for."""

from __future__ import annotations

from dataclasses import replace
from types import SimpleNamespace
from typing import cast

import pytest

from tangy_tui.monitoring.people_progress import Progress
from tangy_tui.monitoring.replay import GameReplay
from tangy_tui.monitoring.session import Session
from tangy_tui.pages.session import drawn_games, session_page
from tangy_tui.text.session_page import drawn_words
from tests.monitoring.test_taking_part import ONE


def session_of(games: int, people: int) -> Session:
    replays = [GameReplay(replace(ONE, id=f"g{n}", number=n)) for n in range(1, games + 1)]
    who = [SimpleNamespace(id=f"p{n}", name=f"P{n}") for n in range(people)]
    return Session(tuple(replays), "Bingo", (), cast(tuple[Progress, ...], tuple(who)), (), {})


@pytest.mark.parametrize(
    ("games", "people", "drawn"),
    [(1, 12, 1), (1, 24, 1), (3, 8, 3), (3, 12, 2), (3, 24, 1), (5, 12, 1), (5, 24, 0), (8, 12, 0)],
)
def test_few_games_are_drawn_if_many_people_or_games_need_the_room(
    games: int, people: int, drawn: int
) -> None:
    assert drawn_games(session_of(games, people)) == drawn


def test_a_page_without_drawings_tells_how_to_get_them() -> None:
    page = session_page(session_of(5, 24), full=False)
    told = drawn_words(0, 5, full=False)
    assert told in page and "--full" in told and page.count("<div") == page.count("</div>")
    assert "<svg" not in page
