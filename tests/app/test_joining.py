"""A new person joins a running live game, which goes on with them."""

from __future__ import annotations

from datetime import datetime
from pathlib import Path

import pytest

from tangy_hw.device_protocols import DeviceError
from tangy_profiles.card_face import called_cells, numbers_of
from tangy_profiles.game_records import GameChange, GameEnding, GameResumed
from tangy_profiles.game_world import LIVE
from tangy_profiles.past_game import PastGame
from tangy_profiles.room import load_room
from tangy_profiles.staff_records import StaffAction
from tangy_profiles.state import FRONT
from tangy_tui.app.command_grammar import read_command
from tangy_tui.app.game_commands import (
    AskFor,
    GoesAway,
    GoOn,
    Joins,
    SetAutonomy,
    SetPace,
    StopRobot,
)
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.interruption import end_interrupted, find_interrupted, take_up
from tangy_tui.app.joining import Admission, resume_joined
from tangy_tui.app.last_plan import seated_as_before
from tangy_tui.app.register import guest_ids
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted
from tangy_tui.learning.policies import load_policy
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.log_check import log_problems
from tangy_tui.monitoring.pauses import PauseTotal
from tangy_tui.monitoring.session import read_session
from tangy_tui.pages.session import session_page
from tangy_tui.text.control import noted_words
from tangy_tui.text.joining import joined_words, sets_up_words
from tangy_tui.text.log import session_lines
from tests.hw.links import FakeLink, LaidCard
from tests.support.live_worlds import live_world

SEED = 31


def seats_before(workspace: Workspace) -> list[str]:
    """Return the ids of the participants in the order of the last game."""
    return seated_as_before(workspace.store, [person.id for person in workspace.people])


class LiveGame:
    """A live game over a fake link, which people can join."""

    def __init__(
        self,
        workspace: Workspace,
        past: PastGame | None = None,
        *,
        goes_on: bool = False,
        before: GameController | None = None,
    ) -> None:
        policy, _ = load_policy(workspace.store, workspace.activity)
        self.workspace = workspace
        self.link = FakeLink(tuple(workspace.names))
        self.world = live_world(workspace, self.link, seed=SEED, pace=0.0)
        supervision = workspace.supervision(policy, SEED, asks=True, world=self.world)
        self.control = GameController(supervision, "Ada", robot=self.world, past=past)
        self.control.goes_on = goes_on
        if before is not None:
            self.control.follow(before)
        self.control.admission = Admission(workspace, self.world)
        self.control.begin()

    def play(self, steps: int) -> None:
        for _ in range(steps):
            self.control.next()

    def says(self, joins: Joins) -> str:
        return noted_words(self.told(joins), self.workspace.name)

    def told(self, joins: Joins) -> StaffNote:
        (note,) = self.control.apply(joins)
        assert isinstance(note, StaffNote)
        return note


def known(workspace: Workspace, *names: str) -> None:
    for person, name in zip(workspace.people, names, strict=False):
        workspace.rename(person, name)


@pytest.mark.parametrize(
    ("typed", "joins"),
    [
        ("add Berta", Joins("Berta")),
        ("Berta Blum joins", Joins("Berta Blum")),
        ("guest Berta", Joins("Berta", guest=True)),
        ("add", Joins("")),
        ("add Berta Blum on seat 3", Joins("Berta Blum", seat=3)),
        ("guest Berta, at table 2", Joins("Berta", guest=True, table=2)),
        ("Berta joins at seat 12", Joins("Berta", seat=12)),
    ],
)
def test_staff_say_who_joins(typed: str, joins: Joins) -> None:
    assert read_command(typed, str) == joins


def test_a_fact_called_joins_is_no_new_person() -> None:
    assert not isinstance(read_command("user2: joins", str), Joins)


@pytest.mark.parametrize("corrected", [False, True])
def test_tangy_looks_at_the_card_again_to_which_it_returns(taught: Path, corrected: bool) -> None:
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.link.cards["user3"] = LaidCard(7, marked=1)
    before.play(6)
    before.control.apply(AskFor("user3"))
    while before.world.tracker.place != "user3":
        before.play(1)
    assert before.world.tracker.seen == "incorrectly marked"
    before.told(Joins("Berta"))
    after = LiveGame(workspace, resume_joined(workspace, LIVE), goes_on=True)
    deck = workspace.activity.deck
    numbers = numbers_of(deck, 7, after.link.setup.deck_seed)
    right = called_cells(deck, numbers, set(after.world.scene().called))
    after.link.cards["user3"] = LaidCard(7, marked=right if corrected else 1)
    (acted,) = (one for one in after.control.next() if isinstance(one, Acted))
    assert acted.outcome.completed != corrected
    assert acted.outcome.obsolete == corrected
    assert not after.control.supervision.faults
    assert (after.world.tracker.seen == "correctly marked") is corrected
    after.play(1)
    assert not after.control.supervision.faults
    workspace.close()


def test_a_new_person_joins_a_running_game_and_is_in_its_log(taught: Path) -> None:
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.play(6)
    before.control.apply(AskFor("user3"))
    before.play(1)
    called, asking = tuple(before.world.called), before.world.scene().requests
    note = before.told(Joins("Berta"))
    assert (note.kind, note.about) == ("joins", "user5") and before.control.joined
    assert before.control.supervision.over
    before.control.admit_no_more()
    assert "when the game goes on" in before.says(Joins("Carl"))
    do, what = before.link.done[-1]
    assert do == "go" and what["name"] == FRONT  # where the robot process begins
    past = resume_joined(workspace, LIVE)
    after = LiveGame(workspace, past, goes_on=before.control.goes_on)
    assert after.control.phase == "running"  # it goes on without a command
    assert after.world.people == ("user1", "user2", "user3", "user4", "user5")
    assert tuple(after.world.called) == called and after.world.scene().requests == asking
    after.control.apply(AskFor("user5"))
    after.play(3)
    called = tuple(after.world.called)
    workspace.close()  # and kill -9

    workspace = Workspace(taught)
    past = find_interrupted(workspace, LIVE)
    assert past is not None
    again = LiveGame(workspace, take_up(workspace, past).past)
    assert again.control.phase == "paused"
    assert again.world.people == after.world.people and tuple(again.world.called) == called
    assert "user5" in again.world.scene().requests
    again.control.apply(GoesAway("user5"))
    assert "user5" in again.world.away
    session = read_session(workspace.store, read_games(workspace.store), {}, workspace.names)
    (game,) = session.replays
    assert game.game.people == again.world.people and not log_problems(workspace.store)
    page, lines = session_page(session), list(session_lines(session))
    for done in ("is here", "has left"):
        assert any(f"Ada: told Tangy that Berta {done}" in line for line in lines)
        assert f"told Tangy that Berta {done}" in page
    # the crash interrupted the game, not the join
    assert sum("after an interruption" in line for line in lines) == 1
    joined = [e.record for e in workspace.store.events(GameChange) if e.record.what == "joined"]
    assert [(one.person, one.by) for one in joined] == [("user5", "Ada")]
    assert not list(workspace.store.events(GameEnding))
    workspace.close()


def test_what_staff_have_set_stays_if_somebody_joins_before_a_step(taught: Path) -> None:
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.control.apply(SetAutonomy("each"))
    before.control.apply(SetPace(40))
    before.told(Joins("Berta"))
    assert resume_joined(workspace, LIVE) is None
    after = LiveGame(workspace)
    after.control.follow(before.control)
    assert after.control.autonomy.level == "each" and after.world.pace == 40
    assert after.world.game_plan == before.world.game_plan
    workspace.close()


@pytest.mark.parametrize("steps", [0, 3])
def test_a_stop_while_the_robot_is_switched_on_again_holds(taught: Path, steps: int) -> None:
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.play(steps)
    assert before.told(Joins("Berta")).kind == "joins"
    before.control.apply(StopRobot(by="Nina"))
    acts = [event.record for event in workspace.store.events(StaffAction)]
    assert [(act.did, act.by) for act in acts] == [("came", "Ada"), ("stopped", "Nina")]
    past = resume_joined(workspace, LIVE)
    after = LiveGame(workspace, past, before=before.control)
    assert after.control.stopped
    assert after.control.supervision.over is (past is None)  # no new game begins
    assert not any(isinstance(event, Acted) for event in after.control.next())
    assert "release" not in after.link.told
    assert [told for told in after.link.told if told.startswith("stop")]
    after.control.apply(GoOn())
    assert (past is not None or after.control.begin()) and after.control.phase == "running"
    assert not after.control.stopped and "user5" in after.world.people
    session = read_session(workspace.store, read_games(workspace.store), {}, workspace.names)
    assert not any("after an interruption" in line for line in session_lines(session))
    after.control.apply(StopRobot(by="Nina"))
    assert after.told(Joins("Carl")) == StaffNote("stopped first", words="Nina")
    workspace.close()


def test_a_person_who_joined_sits_there_in_the_next_set_up(taught: Path) -> None:
    workspace = Workspace(taught, users=9)  # at several tables
    before = LiveGame(workspace)
    before.play(3)
    new = before.told(Joins("Berta")).about
    LiveGame(workspace, resume_joined(workspace, LIVE))
    sat = [person.id for person in workspace.people]
    assert 0 < sat.index(new) < len(sat) - 1
    workspace.gather(sorted(sat))
    assert seats_before(workspace) == sat
    workspace.close()


def test_staff_say_where_a_person_who_joins_sits(taught: Path) -> None:
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.play(3)
    assert before.told(Joins("Berta", seat=6)) == StaffNote("no seat there", words="seat 1 to 5")
    assert admission(before).seats[1] == ("user1",)
    assert admission(before).seats[2] == ("user1", "user2")
    note = before.told(Joins("Berta", seat=2))
    assert (note.about, note.words) == ("user5", "seat 2")
    after = LiveGame(workspace, resume_joined(workspace, LIVE))
    sat = ("user1", "user5", "user2", "user3", "user4")
    assert after.world.people == sat
    after.play(1)
    workspace.close()  # and kill -9

    workspace = Workspace(taught)
    past = find_interrupted(workspace, LIVE)
    assert past is not None and past.beginning.people == sat
    assert tuple(seats_before(workspace)) == sat
    workspace.close()


def test_a_new_person_keeps_the_seat_if_the_game_is_discarded_before_it_goes_on(
    taught: Path,
) -> None:
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.play(3)
    before.told(Joins("Berta", seat=2))
    before.told(Joins("Carl", seat=1))
    workspace.close()  # and kill -9

    workspace = Workspace(taught, users=6)
    past = find_interrupted(workspace, LIVE)
    assert past is not None
    end_interrupted(workspace, past, "discarded")
    sat = ["user6", "user1", "user5", "user2", "user3", "user4"]
    assert seats_before(workspace) == sat
    setup = SetUp.of(workspace)
    assert setup.seats == sat
    LiveGame(workspace)  # another game, in which they did not join
    assert seats_before(workspace) == [person.id for person in workspace.people]
    workspace.close()


def test_people_keep_their_seats_if_the_program_is_killed_before_the_game_goes_on(
    taught: Path,
) -> None:
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.play(3)
    first = before.told(Joins("Berta", seat=2)).about
    second = before.told(Joins("Otto", seat=2)).about
    workspace.close()  # and kill -9, while the robot is switched on again
    for kills in range(3):  # then it comes on
        workspace = Workspace(taught)
        past = find_interrupted(workspace, LIVE)
        assert past is not None
        taken_up = take_up(workspace, past).past
        assert taken_up.beginning.people == ("user1", second, first, "user2", "user3", "user4")
        assert taken_up.newcomers == (first, second)
        if kills == 2:
            after = LiveGame(workspace, taken_up)
            after.play(1)
            assert after.world.people == taken_up.beginning.people
            assert not log_problems(workspace.store)
        workspace.close()


def test_nobody_changes_tables_for_a_person_who_joins(taught: Path) -> None:
    workspace = Workspace(taught, users=10)  # four at the first table, three at the others
    game = LiveGame(workspace)
    game.play(3)
    refused = StaffNote("no seat there", "2", "seat 5 to 8")
    for joins in (Joins("Berta", seat=4), Joins("Berta", seat=9), Joins("Berta", table=1)):
        assert game.told(joins) == refused
    assert list(admission(game).seats) == [5, 6, 7, 8]
    assert game.told(Joins("Berta", table=2)).words == "seat 8"
    workspace.close()


def admission(game: LiveGame) -> Admission:
    assert game.control.admission is not None
    return game.control.admission


def test_adding_somebody_who_was_away_brings_them_back(taught: Path) -> None:
    workspace = Workspace(taught)
    game = LiveGame(workspace)
    game.play(2)
    game.control.apply(GoesAway("user4"))
    assert game.told(Joins(workspace.names["user4"])) == StaffNote("comes", "user4")
    assert not game.world.away and not game.control.joined
    assert game.told(Joins(workspace.names["user4"])) == StaffNote("known already", "user4")
    workspace.close()


def test_a_first_name_brings_back_who_was_away_but_not_to_another_seat(taught: Path) -> None:
    workspace = Workspace(taught)
    hugo = "user3"
    workspace.rename(workspace.find_person(hugo), "Hugo Meier")
    game = LiveGame(workspace)
    game.play(2)
    game.control.apply(GoesAway(hugo))
    assert game.told(Joins("Hugo", seat=1)).kind != "comes" and hugo in game.world.away
    assert game.told(Joins("Hugo")) == StaffNote("comes", hugo)
    assert game.told(Joins("Hugo")).kind == "which person"
    workspace.close()


def test_a_person_for_whom_staff_asked_after_the_last_step_asks_after_a_crash(taught: Path) -> None:
    workspace = Workspace(taught)
    game = LiveGame(workspace)
    game.play(4)
    game.control.apply(AskFor("user2"))
    game.control.apply(AskFor("user4"))
    game.control.apply(GoesAway("user4"))
    workspace.close()  # and kill -9

    workspace = Workspace(taught)
    past = find_interrupted(workspace, LIVE)
    assert past is not None and past.asked_for == ("user2", "user4")
    again = LiveGame(workspace, take_up(workspace, past).past)
    assert again.world.scene().requests == ("user2",)
    workspace.close()


@pytest.mark.parametrize("users", [4, 9])
@pytest.mark.parametrize("steps", [0, 3])
def test_two_people_who_come_together_both_join(taught: Path, steps: int, users: int) -> None:
    workspace = Workspace(taught, users=users)
    before = LiveGame(workspace)
    before.play(steps)
    there = before.world.people
    first = before.told(Joins("Berta"))
    done = list(before.link.done)
    second = before.told(Joins("Otto", guest=True))
    assert (first.kind, second.kind) == ("joins", "joins")
    assert before.link.done == done  # it stands at the front already
    assert before.told(Joins("berta")) == StaffNote("known already", first.about)
    after = LiveGame(workspace, resume_joined(workspace, LIVE), before=before.control)
    assert {*after.world.people} == {*there, first.about, second.about}
    assert [person for person in after.world.people if person in there] == [*there]
    assert after.world.people == tuple(workspace.names)
    assert after.control.phase == "running" and not log_problems(workspace.store)
    came = [event.record for event in workspace.store.events(StaffAction)]
    assert [act.person for act in came] == [first.about, second.about]
    workspace.close()


def test_staff_read_that_nobody_joined_if_tangy_is_stopped_on_its_way(
    taught: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    def stopped(person: str) -> bool:
        raise DeviceError("staff stopped it")

    workspace = Workspace(taught)
    people = workspace.names
    game = LiveGame(workspace)
    game.play(3)
    with monkeypatch.context() as on_its_way:
        on_its_way.setattr(game.world, "drive", stopped)
        assert game.told(Joins("Berta")) == StaffNote("not at front")
    assert workspace.names == people and not game.control.joined
    assert game.told(Joins("Berta")).kind == "joins"
    workspace.close()


def test_the_clock_goes_on_while_tangy_is_set_up_for_a_person(
    taught: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    now = 1000.0
    monkeypatch.setattr("tangy_tui.app.joining_games.monotonic", lambda: now)
    workspace = Workspace(taught)
    before = LiveGame(workspace)
    before.play(3)
    before.told(Joins("Berta"))
    played = before.control.view().seconds
    now += 40.0
    after = LiveGame(workspace, resume_joined(workspace, LIVE), before=before.control)
    assert after.control.view().seconds == pytest.approx(played + 40.0)
    after.play(1)
    (replay,) = read_session(workspace.store, read_games(workspace.store), {}, {}).replays
    assert replay.seconds == pytest.approx(after.control.view().seconds)
    assert replay.staff_pauses.count == 0  # nobody paused the game
    staff = workspace.store.events(StaffAction)
    (came,) = (one.at for one in staff if one.record.did == "came")
    (resumed,) = (one.at for one in workspace.store.events(GameResumed))
    took = datetime.fromisoformat(resumed) - datetime.fromisoformat(came)
    assert replay.set_ups == PauseTotal(1, took.total_seconds())
    workspace.close()


def test_staff_read_whom_tangy_drives_to_the_front_for(
    taught: Path, monkeypatch: pytest.MonkeyPatch
) -> None:
    workspace = Workspace(taught)
    game = LiveGame(workspace)
    game.play(3)
    seen = list[tuple[str, ...]]()

    def drives(person: str) -> bool:
        seen.append(game.control.welcomes)
        return True

    monkeypatch.setattr(game.world, "drive", drives)
    game.told(Joins("Berta"))
    assert seen == [("Berta",)] and str(game.control.phase) == "joining"
    game.told(Joins("Clara"))  # before the robot is set up again
    assert sets_up_words(game.control.welcomes).startswith(
        "Tangy sets itself up for Berta and Clara."
    )
    assert joined_words(["Berta", "Clara"]) == "Berta and Clara have joined."
    workspace.close()


def test_a_guest_joins_for_today(taught: Path) -> None:
    workspace = Workspace(taught)
    game = LiveGame(workspace)
    game.play(3)
    assert game.told(Joins("Berta", guest=True)).about in guest_ids(workspace.store)
    workspace.close()


def test_nobody_joins_without_a_name_a_seat_or_a_name_of_their_own(taught: Path) -> None:
    workspace = Workspace(taught)
    known(workspace, "Zoe Miller", "Rosa")
    game = LiveGame(workspace)
    game.play(3)
    people = workspace.names
    assert "add Berta" in game.says(Joins(""))
    assert "here Rosa" in game.says(Joins("rosa"))
    assert "here Zoe Miller" in game.says(Joins("Zoe"))
    game.control.apply(StopRobot())
    assert game.told(Joins("Berta")).kind == "stopped first"
    assert workspace.names == people and not game.control.joined
    workspace.close()


def test_all_people_with_a_first_name_are_named(taught: Path) -> None:
    workspace = Workspace(taught)
    known(workspace, "Rosa Blum", "Rosa Ochs", "Berta Klein", "Berta")
    game = LiveGame(workspace)
    game.play(3)
    assert "here Rosa Blum or here Rosa Ochs" in game.says(Joins("Rosa"))
    assert game.told(Joins("Berta")) == StaffNote("known already", "user4")
    assert game.told(Joins("Berta Gross")).kind == "joins"
    workspace.close()


def test_a_person_who_joins_gets_an_id_of_their_own(taught: Path) -> None:
    workspace = Workspace(taught, users=6)  # two more than are registered
    names = workspace.names
    game = LiveGame(workspace)
    game.play(3)
    new = game.told(Joins("Berta")).about
    assert new not in names and workspace.names == names | {new: "Berta"}
    workspace.close()


def test_a_refused_name_leaves_the_group_as_it_was(taught: Path) -> None:
    workspace = Workspace(taught, users=2)
    people = workspace.names
    workspace.store.rename("user4", "Berta")  # she does not play today
    game = LiveGame(workspace)
    game.play(3)
    assert game.told(Joins("Berta")).kind == "cannot"
    assert workspace.names == people and not game.control.joined
    game.play(1)
    assert game.told(Joins("Zita")).kind == "joins"
    workspace.close()


def test_a_full_room_is_named_with_its_seats(taught: Path) -> None:
    workspace = Workspace(taught, users=8)
    game = LiveGame(workspace)
    game.play(3)
    assert "All 8 seats" in game.says(Joins("Berta"))
    workspace.close()
    workspace = Workspace(taught, users=24)
    game = LiveGame(workspace)
    game.play(3)
    assert "24 people" in game.says(Joins("Berta"))
    workspace.close()


@pytest.mark.parametrize("count", range(8, 24))
def test_nobody_changes_tables_when_one_more_sits_down(count: int) -> None:
    room = load_room("hall")
    place = room.next_place(count)
    people = [str(number) for number in range(count)]
    more = [*people[:place], "new", *people[place:]]

    def tables(those: list[str]) -> list[set[str]]:
        return [{those[n] for n in sitting} - {"new"} for sitting in room.at_tables(len(those))]

    assert tables(more) == tables(people)
