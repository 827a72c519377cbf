"""Reports name times and ways of asking alike, and say what staff and Tangy did."""

from __future__ import annotations

from collections import Counter
from collections.abc import Mapping
from types import SimpleNamespace
from typing import cast

import pytest

from tangy_profiles.activity import load_activity
from tangy_profiles.game_records import CallMade, GameChange, MoveKind, RecoveryEvent
from tangy_profiles.staff_records import StaffActionKind
from tangy_profiles.state import FRONT
from tangy_tui.monitoring.attention import Attention
from tangy_tui.monitoring.fault import Fault, Moved
from tangy_tui.monitoring.house import PersonInGame, PersonOverTime, RobotLog
from tangy_tui.monitoring.people_progress import Progress
from tangy_tui.monitoring.replay import AnsweredRequest, GameReplay, Moment, Noted
from tangy_tui.monitoring.session import Session, SessionNote
from tangy_tui.pages.staff_parts import FEW_ROWS, staff_part
from tangy_tui.text.fault_moves import MOVES, move_words
from tangy_tui.text.house import GAME_COLUMNS, game_rows, strategy_rows
from tangy_tui.text.report import changes_lines, helped_words, quiet_words
from tangy_tui.text.results import response_line
from tangy_tui.text.session_page import drawn_words
from tangy_tui.text.sessions import note_words
from tangy_tui.text.staff_actions import chosen_words, did_words
from tangy_tui.text.staff_report import staff_rows
from tests.monitoring.test_attention import BEGUN, replay_of, state
from tests.monitoring.test_taking_part import ONE, moment, moves

NAMES = {"user1": "Ada", "user2": "Bob"}


def row_of(replay: GameReplay, got: Attention) -> Mapping[str, str]:
    log = RobotLog("r", "r", (replay,), NAMES, frozenset(), {})
    (row,) = game_rows([PersonInGame(log, replay, got, ())])
    return dict(zip(GAME_COLUMNS, row, strict=True))


def test_the_report_of_a_person_says_when_they_were_there() -> None:
    replay = moves((4, "left", "user1"))
    left, stayed = (row_of(replay, Attention(person)) for person in ("user1", "user2"))
    assert left["there"].startswith("until ") and left["visits"] == "none"
    assert (stayed["there"], stayed["visits"]) == ("all the time", "never")


def test_ways_of_asking_have_the_same_names_in_both_reports() -> None:
    bingo = load_activity("bingo")
    replay = GameReplay(ONE, activity=bingo)
    way = next(iter(bingo.strategies))
    answer = AnsweredRequest("u", "user1", way, complied=True, followed=True, took=1.0)
    log = RobotLog("r", "r", (replay,), NAMES, frozenset(), {})
    one = PersonInGame(log, replay, Attention("user1"), (answer,))
    ((told, *_),) = strategy_rows(PersonOverTime("Ada", [one]))
    tried = SimpleNamespace(used=1, complied=1, late=0, refused=0, void=0, awaited=0)
    person = cast(Progress, SimpleNamespace(name="Ada", strategies={way: tried}))
    assert told.startswith("Tangy ") and way not in told
    assert told in response_line(person, [bingo])


def test_reports_have_no_words_of_the_program() -> None:
    bingo = load_activity("bingo")
    helped = Attention("user1", helped=Counter({"encourage": 2, "mark numbers": 1}))
    assert helped_words(helped, [bingo]) == "encourage them (2), ask to mark numbers"
    assert chosen_words(bingo, "navigate to user", "user1", NAMES.__getitem__) == (
        "told Tangy what to do: go to Ada"
    )
    fault = Noted("fault injected", "Nina", detail="base-failed")
    assert did_words(fault, str) == "brought about a fault: the wheels report nothing"
    note = SessionNote("brought about", "base-failed; path-blocked@3, camera covered; base-failed")
    assert note_words(note) == (
        "Some faults were brought about on purpose: the wheels report nothing; "
        "chairs block every way, camera covered."
    )


def test_the_report_says_whom_tangy_did_not_ask_to_do_anything() -> None:
    told = "Tangy did not ask these people to do anything: Rosa, Emil."
    assert quiet_words(["Rosa", "Emil"]) == told


def test_the_report_says_how_a_person_won_who_had_left() -> None:
    replay = moves((4, "left", "user1"))
    won = GameChange(game="g", what="played on", person="user1", steps=1)
    replay.moments = [
        moment(5, Noted("claim right", "Nina", person="user1", detail="111")),
        moment(6, won),
    ]
    (line,) = changes_lines([replay], NAMES.__getitem__)
    assert line.endswith("Ada had left before. Staff had Ada's card 111 checked.")
    back = moves((4, "left", "user1"), (5, "came", "user1"))
    back.moments = [moment(6, won)]
    (line,) = changes_lines([back], NAMES.__getitem__)
    assert line.endswith("Ada has won. The game goes on.")


def test_the_expert_counts_as_called_only_if_tangy_called() -> None:
    fault = cast(Fault, SimpleNamespace(id="f1", name="Emergency stop pressed"))
    seen = moment(1, Moved(fault, RecoveryEvent("expert called", 3.0, by="Nina")))
    call = CallMade(game="g", fault="f1", role="expert", way="command", stage="tried")
    shown, called = GameReplay(ONE, [seen]), GameReplay(ONE, [seen, moment(1, call)])
    whats = [what for _, _, what in staff_rows([shown, called], str)]
    assert whats == [
        "saw whom to call: Emergency stop pressed",
        "called the expert: Emergency stop pressed",
    ]


def checked(minute: float, person: str, card: str, *, wins: bool = False) -> Moment:
    did: StaffActionKind = "claim right" if wins else "claim wrong"
    return moment(minute, Noted(did, "Nina", person=person, detail=card))


def test_each_card_that_staff_have_checked_keeps_its_own_time() -> None:
    replay = GameReplay(
        ONE,
        [checked(1, "user1", "38"), checked(1.5, "", "17"), checked(2, "user2", "21", wins=True)],
    )
    rows = staff_rows([replay], NAMES.__getitem__)
    assert [what for _, _, what in rows] == [
        "had Ada's card 38 checked: it does not win yet",
        "had card 17 checked: it does not win yet",
        "had Bob's card 21 checked: it wins",
    ]
    assert [when[3:] for when, _, _ in rows] == ["01:00", "01:30", "02:00"]


@pytest.mark.parametrize(
    ("waited", "told"),
    [
        ((1,), "Once, Tangy called some numbers first while 1 person waited."),
        ((2, 2), "Twice, Tangy called some numbers first while 2 people waited."),
        ((2, 1), "Twice, Tangy called some numbers first while 1 to 2 people waited."),
    ],
)
def test_the_report_counts_who_waited_while_calls_came_first(
    waited: tuple[int, ...], told: str
) -> None:
    asking = state("ann", ["bob"]), state("ann", ["ann", "bob"])
    games = []
    for count in waited:
        first = GameChange(game="g1", what="calls first", steps=1, number=2)
        replay = replay_of(state(FRONT), asking[count - 1], state(FRONT))
        replay.moments.insert(1, Moment(10.0, 1, BEGUN.isoformat(), first))
        games.append(replay)
    assert changes_lines(games, str) == [told]


@pytest.mark.parametrize(("drawn", "full"), [(1, False), (2, False), (24, True)])
def test_the_page_says_how_to_have_more_games_drawn(drawn: int, *, full: bool) -> None:
    assert ("--full" in drawn_words(drawn, 30, full=full)) is not full


@pytest.mark.parametrize(("count", "columns"), [(FEW_ROWS, False), (FEW_ROWS + 1, True)])
def test_a_long_list_of_what_staff_did_is_printed_in_two_columns(
    count: int, *, columns: bool
) -> None:
    noted = [moment(n, Noted("paused", "Nina")) for n in range(count)]
    session = cast(Session, SimpleNamespace(replays=[GameReplay(ONE, noted)], name=str))
    assert ('class="staff long"' in "".join(staff_part(session))) is columns


def test_a_move_of_staff_is_a_sentence_about_them() -> None:
    def words(kind: MoveKind, by: str = "staff") -> str:
        return move_words(RecoveryEvent(kind, 3.0, by=by))

    assert words("expert called") == "staff saw whom to call"
    assert words("expert called", "Ada") == "Ada saw whom to call"
    assert words("still there").startswith("staff wanted to clear it, but it is still there")
    assert words("cleared", "Ada") == "was cleared by Ada"
    assert words("taught") == "staff said what to do"
    assert words("still there", "") == MOVES["still there"]
