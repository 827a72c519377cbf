"""Commands that cannot be undone ask a person who types for confirmation, but not a script."""

from __future__ import annotations

import threading
from itertools import count
from pathlib import Path

import pytest

from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.confirmations import needed_confirmation
from tangy_tui.app.game_commands import (
    ClaimCard,
    EndGame,
    GoesAway,
    GoOn,
    HasCard,
    Pause,
    StopRobot,
    TakeBackCall,
)
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.game_view import view_of
from tangy_tui.app.staff_notes import StaffNote
from tangy_tui.app.terminal_session import TerminalSession
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.confirming import ConfirmingStaff
from tangy_tui.console.staff import StaffLines
from tangy_tui.console.typed_yes import TypedYes
from tangy_tui.learning.policies import load_policy
from tangy_tui.text.confirmations import confirmation_words
from tangy_tui.text.questions import NO_QUESTION
from tangy_tui.text.watching import view_lines
from tests.app.test_interruption import Robot

PATIENCE = 20.0  # s


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def control(workspace: Workspace) -> GameController:
    """A simulated game that has begun."""
    learnt, _ = load_policy(workspace.store, workspace.activity)
    controller = GameController(workspace.supervision(learnt, 4, asks=True), "Ada")
    controller.begin()
    return controller


def called(control: GameController) -> tuple[int, ...]:
    return control.supervision.world.scene().called


def call_once(control: GameController) -> None:
    """Play until a number is called."""
    for _ in range(20):
        if called(control):
            return
        control.next()
    pytest.fail("nothing was called")


class Typist:
    """Types each line after certain words were written."""

    def __init__(self, *lines: tuple[str, str]) -> None:
        self.written: list[str] = []
        self._lines = iter(lines)
        self._came = threading.Condition()
        self._read = 0  # number of lines written before the last typed one

    def write(self, line: str) -> None:
        with self._came:
            self.written.append(line)
            self._came.notify_all()

    def read(self) -> str | None:
        after, line = next(self._lines, ("", ""))
        if not line:
            return None
        with self._came:

            def found() -> bool:
                return any(after in one for one in self.written[self._read :])

            assert self._came.wait_for(found, PATIENCE), (after, self.written)
            self._read = len(self.written)
        return line

    def plays(self, workspace: Workspace, *, typed: bool = True) -> str:
        """Play a game; return the output."""
        learnt, _ = load_policy(workspace.store, workspace.activity)
        ticks = count()  # so that no answer is faster than a person
        yes = TypedYes(
            terminal=typed, session=TerminalSession, flush=lambda: None, clock=lambda: next(ticks)
        )
        control = GameController(workspace.supervision(learnt, 4, asks=True), "Ada")
        games = StaffLines(
            control,
            workspace.name,
            lambda wanted: workspace.find_person(wanted).id,
            self.read,
            self.write,
            speed=300,
            yes=yes,
        )
        games.run(1)
        return "\n".join(self.written)


def test_the_end_asks_a_person_who_types(workspace: Workspace) -> None:
    told = Typist(
        ("Call number", "end"), ("End the game?", "perhaps"), ("End the game?", "n"),
        ("Call number", "end"), ("End the game?", "y"),
    ).plays(workspace)  # fmt: skip
    assert told.count("End the game?") == 3 and "Not done." in told
    assert "You ended the game." in told.split("Not done.")[1]


def test_a_call_is_taken_back_only_after_a_yes(workspace: Workspace) -> None:
    told = Typist(
        ("Call number", "take back"), ("Take ", "n"), ("Call number", "take back"), ("Take ", "y"),
        ("counts as not called", "end"), ("End the game?", "y"),
    ).plays(workspace)  # fmt: skip
    before, after = told.split("Not done.")
    assert "counts as not called" not in before
    assert after.count("counts as not called, and comes again later.") == 1
    assert "is taken back" not in after, "one sentence tells it"
    assert "Tangy says: I take" in after


def test_each_call_is_told_with_its_count(workspace: Workspace) -> None:
    told = Typist(("This is the second number.", "end")).plays(workspace, typed=False)
    assert ". Call number" in told and "This is the first number." in told


def test_a_script_is_asked_nothing(workspace: Workspace) -> None:
    told = Typist(
        ("Call number", "take back"), ("counts as not called", "end")
    ).plays(workspace, typed=False)  # fmt: skip
    assert "You ended the game." in told and "Type Y" not in told


def test_a_stop_needs_no_answer_first(workspace: Workspace) -> None:
    told = Typist(
        ("Call number", "end"), ("End the game?", "stop"), ("STOP", "end"), ("End the game?", "y")
    ).plays(workspace)
    assert "You ended the game." in told.split("STOP")[1]


@pytest.mark.parametrize(
    "line", ["n, User 2 has left", "no. User 2 has left", "N User 2 has left", "User 2 has left"]
)
def test_words_instead_of_a_yes_or_after_a_no_are_carried_out(
    workspace: Workspace, line: str
) -> None:
    told = Typist(
        ("Call number", "end"), ("End the game?", line), ("User 2 has left", "end"),
        ("End the game?", "y"),
    ).plays(workspace)  # fmt: skip
    acts = [event.record for event in workspace.store.events(StaffAction)]
    assert [(act.did, act.person) for act in acts][:2] == [("left", "user2"), ("ended", "")]
    assert told.count("Not done.") == 1


def test_a_claim_during_the_question_about_another_is_kept(control: GameController) -> None:
    written: list[str] = []
    yes = TypedYes(terminal=True, session=TerminalSession, flush=lambda: None)
    sure = ConfirmingStaff(control, lambda person: person, yes, written.append)
    call_once(control)
    control.apply(GoesAway("user2"))
    assert sure.ask(ClaimCard(2), None)
    sure.give_way(ClaimCard(1), "bingo 1")
    assert sure.open and written[-1] == "Tangy takes that claim after this question."
    assert [*sure.behind()] == [], "the question is still open"
    sure.give_way(EndGame(), "end")
    assert written[-1] == "Not done: card 2 is not checked."
    assert [*sure.behind()] == ["bingo 1"]


def test_a_question_of_staff_is_answered_and_the_open_one_asked_again(
    workspace: Workspace,
) -> None:
    told = Typist(
        ("Call number", "end"), ("End the game?", "here nobody"), ("nobody", "people"),
        ("End the game?", "end"), ("End the game?", "y"),
    ).plays(workspace)  # fmt: skip
    assert told.count("End the game?") == 3 and "Not done." not in told
    assert NO_QUESTION not in told  # its yes is an answer, and no question of staff
    assert workspace.name("user3") in told.split("End the game?")[1]


def test_a_line_with_an_unknown_person_is_refused_whole(workspace: Workspace) -> None:
    told = Typist(
        ("Call number", "left User 1, nobody"), ("nobody", "left User 1 and User 2"),
        ("User 2 has left", "end"), ("End the game?", "y"),
    ).plays(workspace)  # fmt: skip
    assert "nobody" in told and told.count("User 1 has left") == 1
    acts = [event.record for event in workspace.store.events(StaffAction)]
    assert [act.person for act in acts if act.did == "left"] == ["user1", "user2"]


def test_nothing_is_done_while_a_question_is_open(control: GameController) -> None:
    call_once(control)
    before = called(control)
    with control.holding():
        for _ in range(20):
            control.next()
        assert called(control) == before
    for _ in range(20):
        control.next()
    assert called(control) != before


def test_an_open_question_is_a_phase_of_the_game_until_it_is_answered(
    control: GameController,
) -> None:
    call_once(control)
    with control.holding() as answered:
        with control.holding():
            assert str(control.phase) == "asking"
        view = view_of(control)
        assert view is not None and "Tangy asks staff" in "".join(view_lines(view, None, str))
        answered()
        answered()
        assert str(control.phase) == "running"
        with control.holding():
            assert str(control.phase) == "asking"
            control.apply(Pause())
            assert str(control.phase) == "paused"
        assert control.next() == []  # what was confirmed is still to be carried out


def test_a_call_is_named_by_the_question(control: GameController) -> None:
    assert needed_confirmation(TakeBackCall(), control) is None
    refused = control.refuses(TakeBackCall())  # it would take back the call being spoken
    assert refused is not None and refused.kind == "nothing called"
    call_once(control)
    label = control.supervision.world.activity.deck.label(called(control)[-1])
    asked = needed_confirmation(TakeBackCall(), control)
    assert asked is not None and asked.command == TakeBackCall(label)
    assert needed_confirmation(TakeBackCall("Z-9"), control) is None


def test_the_question_about_a_call_names_the_one_that_is_being_said(
    control: GameController, monkeypatch: pytest.MonkeyPatch
) -> None:
    call_once(control)
    world = control.supervision.world
    said = called(control)[-1] % 75 + 1
    monkeypatch.setattr(type(world), "calling", (said,))
    asked = needed_confirmation(TakeBackCall(), control)
    label = world.activity.deck.label(said)
    assert asked is not None and asked.calling == label != asked.about
    assert label in confirmation_words(asked, str).line("y")


def test_going_on_asks_after_a_pause_of_the_program_alone(control: GameController) -> None:
    control.apply(Pause())
    assert needed_confirmation(GoOn(), control) is None
    control.apply(Pause(unasked=True))
    asked = needed_confirmation(GoOn(), control)
    assert asked is not None and asked.kind == "go on"
    control.apply(GoOn())
    control.apply(Pause())
    assert needed_confirmation(GoOn(), control) is None


def test_a_stopped_simulation_goes_on_without_a_question(control: GameController) -> None:
    control.apply(StopRobot())
    assert needed_confirmation(GoOn(), control) is None  # there is no robot that could move


def test_a_game_that_is_over_ends_without_a_question(control: GameController) -> None:
    assert needed_confirmation(EndGame(), control) is not None
    control.apply(EndGame())
    assert needed_confirmation(EndGame(), control) is None


def test_the_card_of_another_person_needs_a_yes_that_names_them(workspace: Workspace) -> None:
    control = (robot := Robot(workspace)).control
    robot.world.cards.dealt.deal({"user1": 17, "user2": 31})
    assert needed_confirmation(HasCard("user1", 17), control) is None
    assert needed_confirmation(HasCard("user1", 40), control) is None
    asked = needed_confirmation(HasCard("user1", 31), control)
    assert asked is not None and asked.kind == "card of another"
    assert (asked.about, asked.people) == ("31", ("user1", "user2"))


def test_a_claim_asks_if_the_card_is_of_another_person(control: GameController) -> None:
    assert needed_confirmation(ClaimCard(2), control) is None
    assert needed_confirmation(ClaimCard(2, "user2"), control) is None
    assert needed_confirmation(ClaimCard(99, "user2"), control) is None  # which is refused
    asked = needed_confirmation(ClaimCard(2, "user1"), control)
    assert asked is not None and asked.kind == "claim of another"
    assert (asked.about, asked.people) == ("2", ("user1", "user2"))


@pytest.mark.parametrize("claim", [ClaimCard(2), ClaimCard(0, "user2"), ClaimCard(2, "user2")])
def test_a_claim_asks_if_the_person_is_away(control: GameController, claim: ClaimCard) -> None:
    assert needed_confirmation(claim, control) is None
    control.apply(GoesAway("user2"))
    asked = needed_confirmation(claim, control)
    assert asked is not None and asked.kind == "claim away"
    assert (asked.command, asked.people) == (ClaimCard(2, claim.person), ("user2",))


def test_a_claim_asks_about_a_person_who_is_away_also_if_nobody_knew_the_card(
    workspace: Workspace,
) -> None:
    control = Robot(workspace).control
    control.apply(GoesAway("user2"))
    asked = needed_confirmation(ClaimCard(31, "user2"), control)
    assert asked is not None and (asked.kind, asked.people) == ("claim away", ("user2",))
    assert needed_confirmation(ClaimCard(31, "user1"), control) is None


def test_a_claim_tells_whose_card_it_is_if_nobody_knew(workspace: Workspace) -> None:
    control = (robot := Robot(workspace)).control
    dealt = robot.world.cards.dealt
    dealt.deal({"user1": 17})
    control.apply(ClaimCard(31, "user2"))
    assert dealt.given == {"user1": 17, "user2": 31}
    doubt = dealt.doubt("user2", [44])  # the word of staff holds against the first card in sight
    assert doubt is not None and (doubt.why, doubt.own) == ("other card", 31)


@pytest.mark.parametrize(
    "claim",
    [
        ClaimCard(31, "user1"),  # who has another card
        ClaimCard(17, "user2"),  # which is another person's
        ClaimCard(10_000, "user2"),  # there is no such card
        ClaimCard(31),
    ],
)
def test_a_claim_changes_no_known_card(workspace: Workspace, claim: ClaimCard) -> None:
    control = (robot := Robot(workspace)).control
    robot.world.cards.dealt.deal({"user1": 17})
    control.apply(claim)
    assert robot.world.cards.dealt.given == {"user1": 17}


def test_a_claim_by_name_is_of_the_persons_own_card(workspace: Workspace) -> None:
    control = (robot := Robot(workspace)).control
    assert control.refuses(ClaimCard(0, "user2")) == StaffNote("which card", "user2")
    robot.world.cards.dealt.deal({"user2": 31})
    assert control.refuses(ClaimCard(0, "user2")) is None
    (told,) = control.apply(ClaimCard(0, "user2"))
    assert isinstance(told, StaffNote)
    assert (told.kind, told.about, told.people) == ("claim wrong", "31", ("user2",))
