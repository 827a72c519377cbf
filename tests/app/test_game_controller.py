"""The game controller: every action of staff, logged with its author."""

from __future__ import annotations

import threading
from collections.abc import Sequence
from pathlib import Path
from typing import Any

import pytest

from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.past_game import interrupted_game
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.game_commands import (
    Accept,
    Acknowledge,
    AskFor,
    CallAgain,
    CallExpert,
    Clear,
    Confirm,
    Drive,
    EndGame,
    GiveBack,
    GoOn,
    OneStep,
    Pause,
    SetAutonomy,
    StopRobot,
    TakeBackCall,
    TakeOver,
    VoidResponse,
)
from tangy_tui.app.game_controller import ControllerOutput, GameController
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.interaction.game_events import Acted, GameEnded, Unsure
from tangy_tui.learning.policies import load_policy
from tangy_tui.learning.verification import Asked, Reply, Say, Verified
from tangy_tui.monitoring.fault import Diagnosed
from tangy_tui.monitoring.games import read_games
from tangy_tui.monitoring.replay import read_replays
from tangy_tui.monitoring.supervision import Event
from tangy_tui.text.control import noted_words
from tangy_tui.text.log import replay_lines
from tangy_tui.text.staff_report import staff_rows
from tests.hw.links import FakeLink
from tests.support.live_worlds import live_world


class Played:
    """A game controlled by staff, live (over a fake link) or simulated."""

    def __init__(self, workspace: Workspace, *, robot: bool, inject: tuple[str, ...] = ()) -> None:
        learnt, _ = load_policy(workspace.store, workspace.activity)
        self.workspace = workspace
        self.link = FakeLink(tuple(workspace.names))
        self.world: LiveWorld | None = None
        if robot:
            self.world = live_world(workspace, self.link, pace=0.0)
        supervision = workspace.supervision(
            learnt, 1, asks=True, world=self.world, injections=() if robot else inject
        )
        self.voided: list[str] = []
        self.control = GameController(supervision, "Ada", robot=self.world, void=self.void)
        self.control.begin()

    def void(self, person: str) -> bool:
        self.voided.append(person)
        return True

    @property
    def phase(self) -> str:
        return str(self.control.phase)

    def next(self) -> list[str]:
        """Take the next step; return the executed behaviours."""
        return [e.action.behaviour.name for e in self.control.next() if isinstance(e, Acted)]

    def logged(self) -> list[tuple[str, str]]:
        return [(e.record.did, e.record.by) for e in self.workspace.store.events(StaffAction)]


def kinds(told: Sequence[ControllerOutput]) -> list[str]:
    return [one.kind if isinstance(one, StaffNote) else type(one).__name__ for one in told]


@pytest.fixture
def live(taught: Path) -> Any:
    workspace = Workspace(taught)
    yield Played(workspace, robot=True)
    workspace.close()


@pytest.fixture
def simulated(taught: Path) -> Any:
    workspace = Workspace(taught)
    yield Played(workspace, robot=False, inject=("laser-disconnected@2",))
    workspace.close()


def test_a_game_pauses_steps_and_resumes(live: Played) -> None:
    control = live.control
    assert live.next() == ["greeting"] and live.phase == "running"
    assert kinds(control.apply(Pause())) == ["paused"]
    assert live.next() == [] and live.phase == "paused"
    assert kinds(control.apply(OneStep())) == ["one step"]
    assert live.next() == ["call number"] and live.next() == []
    assert kinds(control.apply(GoOn())) == ["goes on"]
    assert live.next() == ["call number"]


def test_a_stop_reaches_the_robot_during_a_behaviour(live: Played) -> None:
    doing, goes_on = threading.Event(), threading.Event()

    def meanwhile(do: str, time: float) -> None:
        if do == "perform" and not doing.is_set():
            doing.set()
            assert goes_on.wait(20)

    live.link.meanwhile = meanwhile
    game = threading.Thread(target=live.control.next)
    game.start()
    assert doing.wait(20)
    assert kinds(live.control.apply(StopRobot())) == ["stopped"]  # the step itself is still due
    assert live.link.told[-1] == "stop: staff stopped it" and live.phase == "stopped"
    goes_on.set()
    game.join(20)
    assert live.next() == []
    assert kinds(live.control.apply(CallAgain())) in (["stopped first"], ["nothing called"])
    live.control.apply(GoOn())
    assert live.link.told[-1] == "release" and live.next() == ["call number"]
    assert ("stopped", "Ada") in live.logged()
    assert ("let go on", "Ada") in live.logged()


def test_a_behaviour_interrupted_by_a_stop_is_no_fault_and_no_refusal(live: Played) -> None:
    for _ in range(3):
        live.next()
    live.link.sign(2)

    def meanwhile(do: str, time: float) -> None:
        if do == "go" and live.phase == "running":
            live.control.apply(StopRobot())

    live.link.meanwhile = meanwhile
    live.link.missed = {"user2"}  # the drive was stopped on its way
    told = [one for _ in range(3) for one in live.control.next()]
    assert any(isinstance(one, Acted) and not one.outcome.completed for one in told)
    assert live.phase == "stopped" and not live.control.supervision.faults
    assert not any(isinstance(one, Diagnosed) for one in told)


def test_a_drive_redirected_by_staff_is_no_refusal(live: Played) -> None:
    control = live.control
    while live.world is None or live.world.tracker.place != "user2":
        live.link.sign(2)
        live.next()
    control.apply(TakeOver())
    control.next()
    control.answers.say(Say("go to the front"))
    yes = control.answers.reply(Reply(yes=True))
    assert isinstance(yes, Verified)
    told = kinds(control.answer(yes.behaviour, yes.target))
    assert "Acted" in told and "Diagnosed" not in told and not control.supervision.faults


@pytest.mark.parametrize("ends", ["by staff", "by its last step"])
def test_after_a_game_staff_no_longer_say_what_tangy_does(
    live: Played, monkeypatch: pytest.MonkeyPatch, ends: str
) -> None:
    control = live.control
    live.next()
    if ends == "by staff":
        control.apply(TakeOver())
        assert control.asks_next
        control.apply(EndGame())
    else:

        def last_step() -> list[Event]:
            control.apply(TakeOver())
            assert control.asks_next
            return control.supervision.leave()

        monkeypatch.setattr(control.supervision, "step", last_step)
        control.next()
    assert control.supervision.over
    assert not control.taking_over and not control.asks_next


def test_staff_take_over_choose_a_behaviour_and_give_back(live: Played) -> None:
    control = live.control
    live.next()
    assert kinds(control.apply(TakeOver())) == ["takes over"] and live.phase == "staff"
    assert kinds(list(control.next())) == ["Unsure"] and live.phase == "asking"
    asked = control.answers.say(Say("tell a joke"))
    assert isinstance(asked, Asked) and control.answers.verifying is not None
    yes = control.answers.reply(Reply(yes=True))
    assert isinstance(yes, Verified)
    done = control.answer(yes.behaviour, yes.target)
    assert "Acted" in kinds(done) and "DoneOnce" in kinds(done)
    assert control.answers.verifying is None
    control.apply(TakeOver())
    control.next()
    assert kinds(control.apply(GiveBack())) == ["given back"] and live.phase == "running"
    assert kinds(control.apply(GiveBack())) == ["nothing asked"]
    logged = [did for did, _ in live.logged()]
    assert logged == ["took over", "answered", "took over", "gave back"]
    workspace = live.workspace
    activity, name = workspace.activity, workspace.name
    games = read_games(workspace.store)
    (replay,) = read_replays(workspace.store, games, {activity.name: activity}, workspace.names)
    lines = [line.strip().partition("  ")[2] for line in replay_lines(replay, activity, name)]
    answered = lines.index("*  Ada told Tangy what to do: tell a joke.")
    assert lines[answered + 1] == "Tell a joke, as Ada said."
    words = [words for _, _, words in staff_rows([replay], name)]
    assert words.count("told Tangy what to do: tell a joke") == 1
    assert live.next() == ["call number"]


def test_who_takes_over_during_a_pause_or_a_proposal_ends_it(live: Played) -> None:
    control = live.control
    live.next()
    control.apply(Pause())
    live.link.time += 10.0
    assert control.view().paused == 10.0
    control.apply(TakeOver())
    assert control.view().paused is None and control.asks_next
    control.apply(GiveBack())
    assert not control.asks_next
    control.apply(SetAutonomy("each"))
    assert live.next() == [] and control.proposal is not None
    control.apply(TakeOver())
    assert control.proposal is None


def test_control_is_given_back_before_tangy_has_asked(live: Played) -> None:
    control = live.control
    live.next()
    control.apply(TakeOver())
    assert kinds(control.apply(GiveBack())) == ["given back"]
    assert not control.taking_over and live.next() == ["call number"]
    assert [did for did, _ in live.logged()] == ["took over", "gave back"]


def test_a_question_of_tangys_own_needs_an_answer(live: Played) -> None:
    control, game = live.control, live.control.supervision
    live.next()
    list(game.game.ask("Nobody has shown that.", "What now?", ""))
    assert control.asks_next and game.question is not None
    needs = StaffNote("asks first")
    assert control.apply(GiveBack()) == control.apply(TakeOver()) == [needs]
    assert noted_words(needs, str) == "Tangy is asking: answer first."
    assert control.asks_next and live.logged() == []


def test_control_that_is_given_back_while_tangy_begins_to_ask_is_given_back(
    live: Played, monkeypatch: pytest.MonkeyPatch
) -> None:
    control = live.control
    live.next()
    control.apply(TakeOver())
    assert live.world is not None
    observe, given = live.world.observe, list[ControllerOutput]()

    def meanwhile() -> Any:
        given.extend(given or control.apply(GiveBack()))
        return observe()

    with monkeypatch.context() as patched:
        patched.setattr(live.world, "observe", meanwhile)
        assert control.next() == []
    assert kinds(given) == ["given back"] and not control.asks_next
    assert live.next() == ["call number"]
    control.apply(TakeOver())
    assert kinds(list(control.next())) == ["Unsure"]
    assert control.apply(TakeOver()) == [control.asks_first()]
    assert control.asks_first().about


def test_the_game_waits_for_the_confirmation_of_staff(live: Played) -> None:
    control = live.control
    control.apply(SetAutonomy("each"))
    assert live.next() == [] and control.proposal is not None
    assert control.proposal.behaviour == "greeting" and live.phase == "asking"
    assert live.next() == []
    assert kinds(control.apply(Confirm(yes=True))) == ["goes on"]
    assert live.next() == ["greeting"] and live.next() == []
    assert kinds(control.apply(Confirm(yes=False))) == ["takes over"]
    assert any(isinstance(event, Unsure) for event in control.next())
    control.apply(GiveBack())
    control.apply(SetAutonomy("alone"))
    assert live.next() == ["call number"]


def test_the_last_call_is_repeated_and_taken_back(live: Played) -> None:
    control = live.control
    assert kinds(control.apply(TakeBackCall())) == ["nothing called"]
    live.next(), live.next()
    assert live.world is not None
    (number,) = live.world.called
    label = live.world.activity.deck.label(number)
    assert control.apply(CallAgain()) == [StaffNote("call again", label)]
    assert live.link.said[-1] == label
    assert kinds(control.apply(TakeBackCall()))[0] == "call taken back"
    assert live.world.called == [] and label in live.link.said[-1]
    assert ("took back", "Ada") in live.logged()


def test_staff_can_request_a_visit_and_void_a_response(live: Played) -> None:
    live.next()
    assert live.control.apply(AskFor("user2")) == [StaffNote("asked for", "user2")]
    assert live.next() == ["navigate to user"]
    assert live.control.apply(VoidResponse("user2")) == [StaffNote("voided", "user2")]
    assert live.voided == ["user2"]


def test_a_stop_ends_driving_by_hand(live: Played) -> None:
    assert kinds(live.control.apply(Drive("left", 0.05))) == ["driven"]
    assert live.link.told.count("drive") >= 2
    driving = threading.Thread(target=live.control.apply, args=(Drive("forward", 5.0),))
    before = len(live.link.told)
    driving.start()
    while len(live.link.told) == before:
        pass
    live.control.apply(StopRobot())
    driving.join(4)
    assert not driving.is_alive() and live.link.told[-1] == "drive"
    assert kinds(live.control.apply(Drive("left"))) == ["stopped first"]


def test_an_ended_game_accepts_no_commands(live: Played) -> None:
    live.next()
    told = live.control.apply(EndGame())
    assert kinds(told) == ["ended", "GameEnded"] and live.phase == "idle"
    assert live.link.told[-1] == "stop: staff ended the game"
    assert kinds(live.control.apply(OneStep())) == ["no game"] and live.next() == []
    assert live.control.begin() and live.link.told[-1] == "release"


def test_no_step_follows_while_the_program_ends(live: Played) -> None:
    live.next()
    live.control.hold("SIGHUP was received")
    assert live.link.told[-1] == "stop: SIGHUP was received"
    assert live.phase == "stopped" and live.next() == []
    assert not [a for a in live.workspace.store.events(StaffAction) if a.record.did == "stopped"]


def test_an_interrupted_game_stops_the_robot_and_can_be_resumed(live: Played) -> None:
    live.next()
    live.control.interrupt()
    assert live.link.told[-1] == "stop: the program ends"
    assert live.next() == [] and not list(live.workspace.store.events("game ended"))
    past = interrupted_game(live.workspace.store, live.workspace.activity.name)
    assert past is not None and len(past.steps) == 1


def test_abandoning_a_game_logs_its_end_and_stops_the_robot(live: Played) -> None:
    live.next()
    live.control.abandon()
    assert live.link.told[-1] == "stop: staff ended the game"
    (ended,) = live.workspace.store.events("game ended")
    assert ended.body["stopped"] == "It was left before its end."


def test_a_fault_halts_the_game_until_it_is_acknowledged_and_cleared(simulated: Played) -> None:
    control = simulated.control
    while simulated.phase != "halted":
        assert not any(isinstance(event, GameEnded) for event in control.next())
    assert kinds(control.apply(OneStep())) == ["halted first"]
    assert kinds(control.apply(GoOn())) == ["still halted"] and simulated.phase == "halted"
    assert kinds(control.apply(Clear())) == ["not seen yet"]
    assert kinds(control.apply(Acknowledge())) == ["Moved"]
    assert kinds(control.apply(Acknowledge())) == ["seen before"]
    assert "Moved" in kinds(control.apply(CallExpert()))
    assert "Moved" in kinds(control.apply(Clear())) and simulated.phase == "running"
    assert kinds(control.apply(Clear())) == ["not halted"]


def test_a_simulated_game_has_no_robot_to_drive(simulated: Played) -> None:
    for command in (CallAgain(), AskFor("user1"), Drive("left")):
        assert kinds(simulated.control.apply(command)) == ["no robot"]
    assert kinds(simulated.control.apply(Accept())) == ["not acceptable"]
    assert kinds(simulated.control.apply(Confirm(yes=True))) == ["nothing asked"]
    assert kinds([simulated.control.answers.say(Say("joke"))]) == ["nothing asked"]
    assert kinds([simulated.control.answers.reply(Reply(yes=True))]) == ["nothing asked"]
