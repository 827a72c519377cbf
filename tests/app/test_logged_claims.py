"""A claim is in the log when it is made: before what follows it, and before its check."""

from __future__ import annotations

from collections.abc import Iterator
from pathlib import Path
from threading import Event

import pytest

from tangy_profiles.past_game import PastGame, interrupted_game
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.store import Store
from tangy_tui.app.game_commands import ClaimCard, GameCommand, GoesAway, GoOn
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.staff import StaffLines
from tangy_tui.monitoring.claims import claims_in
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.session import read_session
from tangy_tui.text.control import claimed_words, noted_words
from tangy_tui.text.staff_report import staff_rows
from tests.app.test_interruption import Robot
from tests.support.waiting import wait_until

CARD = 17


@pytest.fixture
def robot(taught: Path) -> Iterator[Robot]:
    robot = Robot(Workspace(taught))
    robot.next(3)
    yield robot
    robot.workspace.close()


def win(robot: Robot, card: int = CARD) -> None:
    numbers = robot.world.numbers_on(card)
    assert numbers is not None
    robot.world.called.extend(n for n in numbers if n not in robot.world.called)


def noted(store: Store) -> list[tuple[str, str, str]]:
    events = store.events(StaffAction)
    return [(one.record.did, one.record.person, one.record.detail) for one in events]


def killed_while_driving(robot: Robot, claim: ClaimCard) -> PastGame:
    """Kill the program before a claim has its turn; return the game."""
    robot.control.plan.say_early(claim)
    past = interrupted_game(robot.workspace.store, "bingo")
    assert past is not None
    return past


def test_a_claim_is_logged_before_what_staff_say_after_it(robot: Robot) -> None:
    plan, calls = robot.control.plan, len(robot.world.called_now)
    plan.say_early(ClaimCard(CARD, "user2"))  # the robot drives
    plan.say_early(GoesAway("user2"))
    robot.control.apply(ClaimCard(CARD, "user2"))
    store = robot.workspace.store
    made, left, again, given, checked = (one.record for one in store.events(StaffAction))
    assert (made.did, made.person, made.detail, made.by) == ("claim made", "user2", "17", "Ada")
    assert left.did == "left" and checked.did == "claim wrong"
    assert (again.did, given.did) == ("claim made", "card given")
    assert made.calls == checked.calls == calls > 0


def test_typed_lines_that_wait_for_their_turn_are_logged_when_they_are_typed(taught: Path) -> None:
    robot = Robot(Workspace(taught), begins=False)
    store, drives = robot.workspace.store, Event()
    typed = iter(("take back", "bingo 17 user2", "left user2", "end"))
    seen = list[list[str]]()

    def read() -> str | None:
        drives.wait(20)
        return next(typed, None)

    def said() -> list[str]:
        return [did for did, _, _ in noted(store)]

    def meanwhile(do: str, time: float) -> None:
        robot.link.meanwhile = lambda do, time: None
        drives.set()
        wait_until(lambda: "left" in said())
        seen.append(said())

    robot.link.meanwhile = meanwhile
    StaffLines(robot.control, str, str, read, lambda line: None).run(1)
    assert [did for did in seen[0] if did != "cards dealt"] == ["claim made", "left"]
    assert said().count("claim made") == said().count("left") == 1
    robot.workspace.close()


def test_the_number_that_is_being_said_counts(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    calls = len(robot.world.called_now)
    monkeypatch.setattr(type(robot.world), "calling", (75,))
    robot.control.plan.say_early(ClaimCard(CARD, "user2"))
    made = robot.workspace.store.last(StaffAction)
    assert made is not None and made.record.calls == calls + 1


def test_a_claim_that_was_not_checked_is_checked_when_the_game_goes_on(robot: Robot) -> None:
    win(robot)
    past = killed_while_driving(robot, ClaimCard(CARD, "user2"))
    assert past.claims == ((CARD, "user2"),)
    again = Robot(robot.workspace, past)
    win(again)
    assert again.control.next() == [] and again.world.vouched == frozenset()  # it is paused
    news = again.control.plan.claim
    assert news is not None and claimed_words(news, str).endswith("as soon as the game goes on.")
    again.control.apply(GoOn())
    (change,) = again.control.next()
    assert getattr(change, "what", "") == "claimed" and again.world.vouched == {"user2"}
    (told,) = again.control.plan.late_notes()
    assert (told.kind, told.about, told.people) == ("claim right", "17", ("user2",))
    assert again.control.plan.late_notes() == []
    later = interrupted_game(robot.workspace.store, "bingo")
    assert later is not None and later.claims == ()


def test_a_claim_that_staff_repeat_after_an_interruption_is_checked_once(robot: Robot) -> None:
    past = killed_while_driving(robot, ClaimCard(CARD, "user2"))
    again = Robot(robot.workspace, past)
    (told,) = again.control.apply(ClaimCard(CARD, "user2"))
    assert isinstance(told, StaffNote) and told.kind == "claim wrong"
    again.control.apply(GoOn())
    again.control.next()
    assert again.control.plan.late_notes() == []


def test_a_claim_that_a_new_person_overtakes_is_kept(
    robot: Robot, monkeypatch: pytest.MonkeyPatch
) -> None:
    control = robot.control
    logged = control.plan.say_early

    def joined_meanwhile(command: GameCommand) -> None:
        logged(command)
        control.supervision.interrupt()
        control.joined = True

    monkeypatch.setattr(control.plan, "say_early", joined_meanwhile)
    kept = StaffNote("claim kept", "17")
    assert control.apply(ClaimCard(CARD, "user2")) == [kept]
    assert "as soon as the game goes on" in noted_words(kept, str)
    past = interrupted_game(robot.workspace.store, "bingo")
    assert past is not None and past.claims == ((CARD, "user2"),)


def test_the_report_tells_each_claim_once_when_it_was_made(robot: Robot) -> None:
    robot.control.apply(ClaimCard(CARD, "user2"))
    calls = len(robot.world.called_now)
    win(robot, 18)
    robot.control.plan.say_early(ClaimCard(18, "user3"))
    store = robot.workspace.store
    (replay,) = read_session(store, read_games(store), {}, {}).replays
    assert [(one.card, one.person, one.result) for one in claims_in(replay)] == [
        ("17", "user2", "claim wrong"), ("18", "user3", None)
    ]  # fmt: skip
    words = [what for _, _, what in staff_rows([replay], str) if "check" in what]
    assert words == [
        f"had user2's card 17 checked at call {calls}: it does not win yet",
        f"asked Tangy to check user3's card 18 at call {len(robot.world.called_now)}; "
        "it was not checked",
    ]
    (game,) = read_session(store, read_games(store), {}, {}).to_json()["games"]
    assert [one["result"] for one in game["claims"]] == ["claim wrong", None]
