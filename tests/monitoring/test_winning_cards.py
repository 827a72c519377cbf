"""Reports name the card that won, for what, and at which call."""

from __future__ import annotations

from dataclasses import replace

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.game_records import GameChange
from tangy_profiles.game_world import BENCH, SIMULATED
from tangy_profiles.state import FRONT
from tangy_tui.monitoring.attention import Attention
from tangy_tui.monitoring.done import Done
from tangy_tui.monitoring.house import PersonInGame, RobotLog
from tangy_tui.monitoring.played_for import played_for, wins_of
from tangy_tui.monitoring.replay import GameReplay, Moment, Noted
from tangy_tui.monitoring.session import Session
from tangy_tui.text.house import GAME_COLUMNS, game_rows
from tangy_tui.text.report import changes_lines
from tangy_tui.text.taking_part import played_for_rows, won_words
from tests.monitoring.test_attention import BEGUN, game, state

NAMES = {"ann": "Ann", "bob": "Bob"}


def step(number: int, before: str, after: str) -> Done:
    return Done(
        number, 10.0 * number, 10.0 * number, state(before), state(after), "b", None, "",
        completed=True, right=True, teacher="", said="", draws=False,
    )  # fmt: skip


def call(number: int, called: int) -> Done:
    return replace(step(number, FRONT, FRONT), draws=True, numbers=(called,))


def win(number: int, person: str) -> Done:
    return replace(step(number, person, person), wins=True)


def replay_of(*whats: Done | Noted | GameChange, **given: object) -> GameReplay:
    one = game(**{"patterns": ("line", "two lines"), "world": BENCH} | given)
    at = BEGUN.isoformat()
    moments = [Moment(10.0 * n, n, at, what) for n, what in enumerate(whats, 1)]
    return GameReplay(one, moments, activity=load_activity("bingo"))


ON = GameChange(game="g1", steps=5, what="played on", person="ann")
READ = Noted("card learnt", "tangy", person="ann", detail="155")
CLAIM = Noted("claim right", "Nina", person="bob", detail="17")


def words(replay: GameReplay) -> str:
    session = Session((replay,), "Bingo", (), (), (), NAMES)
    ((_, told),) = played_for_rows(session)
    return told


def test_the_report_names_the_card_and_the_call_of_each_win() -> None:
    replay = replay_of(call(1, 5), call(2, 66), READ, win(3, "ann"), ON, call(4, 1), CLAIM,
                       win(5, "bob"))  # fmt: skip
    assert words(replay) == (
        "a line: Ann won with card 155 at call 2 (O-66); then two lines: Bob won with card 17 at "
        "call 3 (B-1)"
    )
    assert won_words(replay, "ann") == "card 155, a line, call 2"
    assert won_words(replay, "bob") == "card 17, two lines, call 3"
    (line,) = changes_lines([replay], NAMES.__getitem__)
    assert line.endswith("Ann has won (a line) with card 155 at call 2 (O-66). The game goes on.")
    log = RobotLog("r", "r", (replay,), NAMES, frozenset(), {})
    (row,) = game_rows([PersonInGame(log, replay, Attention("ann", won=1), ())])
    assert dict(zip(GAME_COLUMNS, row, strict=True))["won"] == "card 155, a line, call 2"
    told = [one.to_json()["wins"] for one in played_for(replay)]
    assert [[(w["card"], w["call"], w["number"]) for w in wins] for wins in told] == [
        [(155, 2, 66)], [(17, 3, 1)]
    ]  # fmt: skip


def test_a_game_that_goes_on_has_no_winner_yet() -> None:
    replay = replay_of(call(1, 5), ended=None)
    assert words(replay) == "a line: nobody has won yet; then two lines: not reached yet"
    assert words(replay_of(call(1, 5))) == "a line: nobody won; then two lines: not reached"


def test_winners_of_the_same_call_share_it() -> None:
    first = replace(ON, what="others first")
    replay = replay_of(call(1, 5), READ, win(2, "ann"), first, CLAIM, win(3, "bob"))
    assert words(replay).startswith(
        "a line: Ann with card 155 and Bob with card 17 won at call 1 (B-5); then two lines"
    )


def test_a_call_that_was_taken_back_does_not_count() -> None:
    back = Noted("took back", "Nina", detail="O-66", taken_back=66)
    replay = replay_of(call(1, 5), call(2, 66), back, call(3, 1), READ, win(4, "ann"))
    ((_, won),) = wins_of(replay, "ann")
    assert (won.call, won.number) == (2, 1)


@pytest.mark.parametrize(("world", "card"), [(BENCH, None), (SIMULATED, 2)])
def test_a_card_that_nobody_knows_has_no_number(world: str, card: int | None) -> None:
    replay = replay_of(call(1, 5), win(2, "bob"), world=world)
    ((_, won),) = wins_of(replay, "bob")
    assert won.card == card
    if card is None:
        assert words(replay).startswith("a line: Bob won at call 1 (B-5)")
