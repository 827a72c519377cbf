"""Resuming an interrupted game with its deck, calls, requests, stage and posteriors."""

from __future__ import annotations

from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path

import pytest

from tangy_profiles.beliefs import Beliefs
from tangy_profiles.game_records import (
    GameBeginning,
    GameChange,
    GameEnding,
    GameResumed,
    GameStep,
)
from tangy_profiles.game_world import BENCH, LIVE, SIMULATED
from tangy_profiles.past_game import NotResumable, PastGame, interrupted_game
from tangy_profiles.room import load_room
from tangy_profiles.state import ActivityState
from tangy_profiles.tracker import Tracker
from tangy_tui.app.game_commands import (
    AskFor,
    EndGame,
    GoesAway,
    GoOn,
    HasCard,
    StopRobot,
    TakeBackCall,
)
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.interruption import can_join, end_interrupted, find_interrupted, take_up
from tangy_tui.app.joining import let_join
from tangy_tui.app.register import archive_person
from tangy_tui.app.scripted_staff import go_on_by_script, scripted_controller
from tangy_tui.app.set_up import SetUp
from tangy_tui.app.staff_view import StaffWatch
from tangy_tui.app.workspace import Workspace
from tangy_tui.learning.policies import load_policy
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.log_check import log_problems
from tangy_tui.monitoring.session import read_session
from tangy_tui.monitoring.supervision import Supervision
from tests.hw.links import FakeLink
from tests.support.live_worlds import live_world

SEED = 31


class Interrupted:
    """A data folder in which games are played and interrupted."""

    def __init__(self, folder: Path) -> None:
        self.folder = folder
        self.workspace = Workspace(folder)
        self.supervision = self.new()

    def new(self) -> Supervision:
        policy, _ = load_policy(self.workspace.store, self.workspace.activity)
        return self.workspace.supervision(policy, SEED)

    def play(self, steps: int, *, whole: int = 0) -> None:
        """Play a number of whole games, and a number of steps of another one."""
        control = scripted_controller(self.supervision)
        for _ in range(whole):
            control.begin()
            while not self.supervision.over:
                go_on_by_script(control, expert=False)
        control.begin()
        while self.supervision.steps < steps:
            go_on_by_script(control, expert=False)

    def interrupt(self) -> None:
        """End the program like a crash, and start it again."""
        self.workspace.close()
        self.workspace = Workspace(self.folder)
        self.supervision = self.new()

    def past(self) -> PastGame:
        past = find_interrupted(self.workspace, SIMULATED)
        assert past is not None
        return past

    def resume(self) -> GameController:
        control = scripted_controller(self.supervision, self.past())
        control.begin()
        return control

    @property
    def standing(self) -> tuple[ActivityState, tuple[int, ...], tuple[str, ...], Beliefs]:
        """The game's position: its state, called numbers, requests and beliefs."""
        scene = self.supervision.world.scene()
        believed = {
            f"{person}: {strategy}": belief
            for person, beliefs in self.supervision.persuasion.beliefs.items()
            for strategy, belief in beliefs.items()
        }
        return self.supervision.world.observe(), scene.called, scene.requests, believed


@pytest.fixture
def room(taught: Path) -> Iterator[Interrupted]:
    room = Interrupted(taught)
    yield room
    room.workspace.close()


@pytest.mark.parametrize("steps", [1, 2, 7, 20, 33])
def test_a_resumed_game_has_its_old_state_and_is_paused(room: Interrupted, steps: int) -> None:
    room.play(steps)
    stood = room.standing
    room.interrupt()
    control = room.resume()
    assert room.standing == stood and room.supervision.steps == steps
    assert str(control.phase) == "paused" and control.next() == []
    control.apply(GoOn())
    assert str(control.phase) == "running"


def test_a_resumed_game_keeps_the_order_of_its_numbers(room: Interrupted) -> None:
    room.play(0)
    control = scripted_controller(room.supervision)
    while not room.supervision.over:
        go_on_by_script(control, expert=False)
    whole = room.supervision.world.scene().called
    room.interrupt()
    room.play(12)
    room.interrupt()
    control = room.resume()
    while not room.supervision.over:
        go_on_by_script(control, expert=False)
    called = room.supervision.world.scene().called
    shorter = min(len(called), len(whole))  # it may be won sooner, as people get other requests
    assert called[:shorter] == whole[:shorter] and shorter > 12


def test_the_second_game_of_a_run_can_be_resumed(room: Interrupted) -> None:
    room.play(9, whole=1)
    stood = room.standing
    room.interrupt()
    assert len(room.past().earlier) == 1
    room.resume()
    assert room.standing == stood and room.supervision.games == 2


def test_a_game_resumed_several_times_is_one_game_in_the_log(room: Interrupted) -> None:
    room.play(5)
    room.interrupt()
    control = room.resume()
    while room.supervision.steps < 11:
        go_on_by_script(control, expert=False)
    room.interrupt()
    control = room.resume()
    while not room.supervision.over:
        go_on_by_script(control, expert=False)
    store = room.workspace.store
    assert len(list(store.events(GameBeginning))) == len(list(store.events(GameEnding))) == 1
    assert [event.record.steps for event in store.events(GameResumed)] == [5, 11]
    (end,) = store.events(GameEnding)
    assert end.record.stopped is None
    assert end.record.steps == len(list(store.events(GameStep)))
    assert find_interrupted(room.workspace, SIMULATED) is None


def test_an_ended_game_is_not_offered(room: Interrupted) -> None:
    room.play(4)
    room.interrupt()
    end_interrupted(room.workspace, room.past(), "over")
    assert find_interrupted(room.workspace, SIMULATED) is None
    (end,) = room.workspace.store.events(GameEnding)
    assert (end.record.steps, end.record.stopped) == (4, "over")


def test_no_game_without_a_step_or_of_another_world_is_offered(
    room: Interrupted,
) -> None:
    room.play(0)
    room.interrupt()
    assert find_interrupted(room.workspace, SIMULATED) is None
    room.play(3)
    assert find_interrupted(room.workspace, BENCH) is None
    assert interrupted_game(room.workspace.store, "another") is None


def test_a_game_is_not_resumed_with_other_people(room: Interrupted) -> None:
    room.play(4)
    room.interrupt()
    room.workspace.close()
    room.workspace = Workspace(room.folder, users=3)
    room.supervision = room.new()
    with pytest.raises(NotResumable, match="other people"):
        room.resume()


def test_a_game_with_an_inconsistent_log_is_not_resumed(room: Interrupted) -> None:
    room.play(8)
    room.interrupt()
    past = room.past()
    *steps, last = past.steps
    assert last.after is not None
    moved = replace(last, after=last.after._replace(place="user2"))
    other = replace(past, steps=(*steps, moved))
    with pytest.raises(NotResumable, match="do not come out"):
        scripted_controller(room.supervision, other).begin()


# ------------------------------------------------------------------------------ with a robot


class Robot:
    """A live game over a fake link."""

    def __init__(
        self,
        workspace: Workspace,
        past: PastGame | None = None,
        on_for: float = 0.0,
        *,
        begins: bool = True,
    ) -> None:
        policy, _ = load_policy(workspace.store, workspace.activity)
        self.workspace = workspace
        self.link = FakeLink(tuple(workspace.names))
        self.link.time = on_for
        self.world = live_world(workspace, self.link, seed=SEED, pace=0.0)
        supervision = workspace.supervision(policy, SEED, asks=True, world=self.world)
        self.control = GameController(supervision, "Ada", robot=self.world, past=past)
        if begins:
            self.control.begin()

    def next(self, times: int) -> None:
        for _ in range(times):
            self.control.next()


def test_a_resumed_live_game_keeps_the_order_of_its_numbers(taught: Path) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.next(6)
    before.control.apply(TakeBackCall())
    gone, called = before.world.called, tuple(before.world.called)
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    after = Robot(workspace, past)
    assert tuple(after.world.called) == called and after.control.phase == "paused"
    assert not [said for said in after.link.told if said.startswith("go")]  # nothing moves
    after.control.apply(GoOn())
    for robot in (before, after):
        robot.next(4)
    assert after.world.called == gone and len(after.world.called) > len(called)
    workspace.close()


def test_a_resumed_live_game_knows_at_which_call_somebody_has_won(taught: Path) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    while len(before.world.called) < 3:
        before.next(1)
    before.control.supervision.game.change("others first", person="user2", by="")
    before.next(1)
    (won,) = before.world.all_wins
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    after = Robot(workspace, past)
    assert after.world.all_wins == (won,) and won.calls == 3
    assert tuple(after.world.called) == tuple(before.world.called)
    workspace.close()


def test_a_resumed_live_game_knows_whose_card_it_is(taught: Path) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.next(3)
    card, other = 17, 31
    before.control.apply(HasCard("user3", card))
    before.control.note("card learnt", person="user2", detail=str(other))
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    after = Robot(workspace, past)
    dealt = after.world.cards.dealt
    assert (dealt.card_of("user3"), dealt.card_of("user2")) == (card, other)
    assert dict(dealt.given) == {"user3": card}
    workspace.close()


def test_a_new_person_joins_a_resumed_live_game(taught: Path) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.next(6)
    before.control.apply(AskFor("user3"))
    before.next(1)
    called, asking = tuple(before.world.called), before.world.scene().requests
    archive_person(workspace.store, "user2")  # a person who still sits at the table
    let_join(workspace, "Zelda")
    workspace.close()
    for _ in range(2):  # and once more
        workspace = Workspace(taught)
        past = find_interrupted(workspace, LIVE)
        assert past is not None and can_join(workspace, past)
        taken_up = take_up(workspace, past)
        assert list(workspace.names) == ["user1", "user2", "user3", "user4", "user5"]
        after = Robot(workspace, taken_up.past)
        assert after.world.people == tuple(workspace.names)
        assert tuple(after.world.called)[: len(called)] == called
        assert after.world.scene().requests[: len(asking)] == asking
        after.control.apply(GoOn())
        after.next(1)
        after.control.apply(AskFor("user5"))
        after.next(1)
        assert "user5" in after.world.scene().requests
        called = tuple(after.world.called)
        (game,) = read_session(workspace.store, read_games(workspace.store), {}, {}).replays
        assert game.game.people == after.world.people
        assert not log_problems(workspace.store)
        changes = [event.record for event in workspace.store.events(GameChange)]
        workspace.close()
    joined = [change.person for change in changes if change.what == "joined"]
    assert joined == ["user5"]  # the second time they were known


def test_a_resumed_simulated_game_excludes_new_people(room: Interrupted) -> None:
    room.play(8)
    stood = room.standing
    let_join(room.workspace, "Zelda")
    room.interrupt()
    taken_up = take_up(room.workspace, room.past())
    assert taken_up.waiting == ("user5",)
    room.supervision = room.new()
    room.resume()
    assert room.standing == stood
    hall = load_room("hall")
    room.workspace.leave_resumed_game(hall)
    assert list(room.workspace.names)[-1] == "user5"
    assert room.workspace.room is hall


def test_the_clock_of_a_resumed_live_game_counts_only_played_time(
    taught: Path,
) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.next(3)
    before.link.time += 300.0  # a break in the middle of the game
    before.next(3)
    played = before.control.supervision.game.log.seconds
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None and past.seconds == pytest.approx(played) and played > 300
    assert sum(step.seconds or 0.0 for step in past.steps) < 300

    after = Robot(workspace, past, on_for=7200.0)  # a robot has its own clock
    watch = StaffWatch()
    watch.resume(after.world.seconds, past, workspace.activity)
    shown = watch.look(after.world.scene(), after.world.people, after.world.seconds, after.world)
    for seconds in (shown.seconds, after.control.supervision.seconds):
        assert seconds == pytest.approx(played)
    watch.end(after.world.seconds)
    later = after.world.seconds + 600.0
    assert watch.look(after.world.scene(), (), later, after.world).seconds == shown.seconds
    after.control.apply(GoOn())
    after.next(3)
    played = after.control.supervision.game.log.seconds
    (game,) = read_session(workspace.store, read_games(workspace.store), {}, {}).replays
    assert game.seconds == pytest.approx(played)
    workspace.close()


def test_a_request_seen_before_a_step_is_as_old_as_the_step(taught: Path) -> None:
    workspace = Workspace(taught)
    Robot(workspace).next(3)
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    last = past.steps[-1]
    asking = last.state._replace(
        users=tuple(
            user._replace(request="AR" if user.id == "user3" else "ANR")
            for user in last.state.users
        ),
    )
    drive = replace(
        last, state=asking, after=None, asking=("user3",), seconds=33.0, clock=past.clock[-2] + 40
    )
    long_drive = replace(past, steps=(*past.steps[:-1], drive))
    since = long_drive.asked(workspace.activity)["user3"]
    assert since == pytest.approx(long_drive.clock[-1] - 33.0)
    workspace.close()


def test_a_request_by_staff_stays_open_after_a_resume(taught: Path) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.next(3)
    before.control.apply(AskFor("user3"))
    before.next(1)
    assert before.world.scene().requests == ("user3",)
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    assert past.asked(workspace.activity) == {"user3": pytest.approx(past.clock[2])}
    after = Robot(workspace, past)
    for _ in range(3):  # far longer than a sign may be hidden
        after.link.time += 60.0
        after.control.next()
    assert after.world.scene().requests == ("user3",)
    workspace.close()


def test_a_wait_is_kept_from_when_the_person_asked_and_across_games(taught: Path) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.next(3)
    for person in ("user3", "user1"):  # Tangy goes to the first one
        before.control.apply(AskFor(person))
    before.link.time += 30.0  # in the middle of a step, as it were
    before.next(1)
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    assert past.asked(workspace.activity)["user1"] == pytest.approx(past.clock[2])
    waits = past.waits(workspace.activity)["user1"]
    assert waits >= 30.0
    after = Robot(workspace, past)
    assert after.link.time - after.world.asked_at["user1"] == pytest.approx(waits)
    after.link.time += 300.0
    after.control.apply(EndGame())
    after.control.begin()
    after.next(2)
    again = interrupted_game(workspace.store, workspace.activity.name)
    assert again is not None and again.waits(workspace.activity)["user1"] >= waits + 300.0
    last = Robot(workspace, again)
    (told,) = [one.waits for one in last.control.view().people if one.id == "user1"]
    assert told is not None and told >= waits + 300.0
    workspace.close()


def test_the_clock_resumes_from_the_last_action_of_staff(taught: Path) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.next(3)
    before.link.time += 90.0  # nothing is called meanwhile
    before.control.apply(StopRobot())
    played = before.control.supervision.game.log.seconds
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None and played > 90 and past.seconds == pytest.approx(played)
    (game,) = read_session(workspace.store, read_games(workspace.store), {}, {}).replays
    assert game.moments[-1].seconds == pytest.approx(played)
    workspace.close()


def test_people_keep_their_seats_in_a_resumed_game(room: Interrupted) -> None:
    moved = ["user3", "user1", "user4", "user2"]
    room.workspace.seat(moved)
    room.supervision = room.new()
    room.play(8)
    stood = room.standing
    room.interrupt()
    assert list(room.workspace.names) != moved
    take_up(room.workspace, room.past())
    room.supervision = room.new()
    room.resume()
    assert list(room.workspace.names) == moved and room.standing == stood


def test_people_keep_their_seats_for_the_next_game(taught: Path) -> None:
    workspace = Workspace(taught)
    moved = ["user3", "user1", "user4", "user2"]
    workspace.seat(moved)
    Robot(workspace)
    workspace.close()
    again = Workspace(taught)
    assert list(again.names) == ["user1", "user2", "user3", "user4"]
    assert SetUp.of(again).seats == moved == list(again.names)
    again.close()


def test_the_clock_of_an_old_log_is_the_sum_of_its_steps(room: Interrupted) -> None:
    room.play(9)
    past = room.past()
    played = room.supervision.game.log.seconds
    old = replace(past, steps=tuple(replace(step, clock=None) for step in past.steps))
    assert past.seconds == old.seconds == pytest.approx(played)
    room.interrupt()
    room.resume()
    assert room.supervision.game.log.seconds == pytest.approx(played)
    assert room.supervision.seconds == pytest.approx(played)


def test_a_person_who_left_before_the_first_step_stays_absent(
    taught: Path,
) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.control.apply(GoesAway("user2"))
    before.next(3)
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    assert Robot(workspace, past).world.away == before.world.away == {"user2"}
    workspace.close()


@pytest.mark.slow
def test_replaying_the_log_of_any_game_gives_its_state(room: Interrupted) -> None:
    policy, _ = load_policy(room.workspace.store, room.workspace.activity)
    kinds = ("card-out-of-sight", "request-withdrawn", "no-effect", "carried-off", "request-stuck")
    game = room.workspace.supervision(
        policy, 5, asks=True, injections=[f"{kind}~0.05" for kind in kinds]
    )
    control = scripted_controller(game)
    for _ in range(6):
        with room.workspace.store.transaction():
            control.begin()
            while not game.over:
                go_on_by_script(control, expert=True)
    trackers: dict[str, Tracker] = {}
    followed = 0
    for event in room.workspace.store.events(GameStep):
        people = tuple(user.id for user in event.record.state.users)
        tracker = trackers.setdefault(event.record.game, Tracker(room.workspace.activity, people))
        assert tracker.follow(event.record)
        followed += 1
    assert len(trackers) == 6 and followed > 200


def test_a_resume_keeps_the_order_of_the_queue_and_requests_during_calls(taught: Path) -> None:
    workspace = Workspace(taught)
    before = Robot(workspace)
    before.next(3)
    for person in ("user4", "user2"):  # not the order of their seats
        before.control.apply(AskFor(person))
    begun = interrupted_game(workspace.store, workspace.activity.name)
    assert begun is not None
    first = GameChange(game=begun.beginning.game, steps=3, what="calls first", number=8)
    workspace.store.append(first)
    before.world.change(first)  # so the states show no requests
    before.next(1)
    before.control.apply(AskFor("user1"))
    before.next(2)
    queue = before.world.scene().requests
    assert queue == ("user4", "user2", "user1") and not before.world.observe().attended
    past = interrupted_game(workspace.store, workspace.activity.name)
    assert past is not None
    since = past.asked(workspace.activity)
    assert tuple(since) == queue
    assert since["user4"] <= since["user2"] < since["user1"] < past.clock[-1]
    after = Robot(workspace, past)
    assert after.world.scene().requests == queue
    after.link.time += 60.0
    after.control.next()
    assert after.world.scene().requests == queue
    workspace.close()
