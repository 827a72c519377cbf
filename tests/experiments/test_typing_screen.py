"""The screen model reads the output of a program in pieces of any size."""

from __future__ import annotations

import pytest

from tangy_tui.experiments.classroom import activity_of
from tangy_tui.experiments.screen import Screen
from tangy_tui.experiments.typing import shortest
from tangy_tui.language.commands import Phrasebook

DRAWN = (
    b"\x1b[?1049h\x1b[>25u\x1b[?2026$p\x1b]22;default\x07\x1b]0;a title\x1b\\"
    b"\x1b[2J\x1b[2;3H\x1b[1;38;5;254;48;5;17mDid you say: \x1b[0mr\xc3\xa9sum\xc3\xa9?\r\n"
    b"\x1b[4;1H\xe6\x97\xa5x\x1b[5;1Hgone\x1b[2K\x1b[3;5Hab\x1b[Dc\x1b[A!"
)


@pytest.mark.parametrize("piece", [1, 3, 7, 1000])
def test_a_screen_reads_the_same_in_pieces_of_any_size(piece: int) -> None:
    screen = Screen(30, 6)
    for at in range(0, len(DRAWN), piece):
        screen.feed(DRAWN[at : at + piece])
    assert screen.lines == ["", "  Did !ou say: résumé?", "    ac", "日x", "", ""]


def test_text_stops_at_the_edges() -> None:
    screen = Screen(5, 2)
    screen.feed(b"abcdefgh\r\n\n\nxy\b\bz\x1b[99;99H!\x1b[1;3H\x1b[K")
    assert screen.lines == ["ab", "zy  !"]
    screen.feed(b"\x1b[1;1H\x1b[J")
    assert screen.text == "\n"


def test_the_shortest_phrase_is_understood_with_certainty() -> None:
    activity = activity_of("bingo")
    phrasebook = Phrasebook(activity, ())
    for behaviour in activity.behaviours.values():
        command = phrasebook.understand(shortest(behaviour))
        assert command is not None
        assert (command.behaviour, command.confidence) == (behaviour.name, 1.0)
