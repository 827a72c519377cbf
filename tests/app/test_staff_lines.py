"""Games controlled by lines: a line may intervene at any time, and a game never hangs."""

from __future__ import annotations

import re
import threading
from pathlib import Path
from typing import Any

import pytest

from tangy_profiles.errors import TangyError
from tangy_profiles.events import EventRecord
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.command_grammar import read_command
from tangy_tui.app.game_commands import GoOn, StopRobot
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.staff import StaffLines
from tangy_tui.learning.policies import load_policy
from tangy_tui.text.staff_lines import NO_MORE, NOBODY
from tests.support.staff_lines import play_by_turns

LAST = "# the last line"


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


def told(
    workspace: Workspace,
    *lines: str,
    inject: tuple[str, ...] = (),
    speed: float = 1000,
    after: threading.Event | None = None,
) -> tuple[list[str], bool]:
    """Play a game in which these lines are typed; return the output and the game's end.

    Args:
        workspace: holds the policy.
        lines: typed at once, from the beginning, or `after` certain words.
        inject: faults.
        speed: as a multiple of real time.
        after: the words that the first line waits for.
    """
    learnt, _ = load_policy(workspace.store, workspace.activity)
    supervision = workspace.supervision(learnt, 4, asks=True, injections=inject)
    written: list[str] = []
    typed = iter(lines)

    def read() -> str | None:
        if after is not None:
            after.wait(20)
        return next(typed, None)

    games = StaffLines(
        GameController(supervision, "Ada"),
        workspace.name,
        lambda wanted: workspace.find_person(wanted).id,
        read,
        written.append,
        speed=speed,
    )
    return written, games.run(1)


def test_a_game_that_stopped_early_counts_after_a_person_has_joined(workspace: Workspace) -> None:
    learnt, _ = load_policy(workspace.store, workspace.activity)
    typed = iter(["pause"])

    def lines(before: StaffLines | None = None) -> StaffLines:
        control = GameController(workspace.supervision(learnt, 4, asks=True), "Ada")
        said = list[str]()
        return StaffLines(
            control, workspace.name, str, lambda: next(typed, None), said.append,
            speed=50, before=before,
        )  # fmt: skip

    first = lines()
    assert not first.run(1)
    assert not lines(first).run(0)


def test_a_game_plays_to_its_end_after_the_last_line(workspace: Workspace) -> None:
    written, ended = told(workspace)
    assert ended and NO_MORE in written
    assert any("The game is over" in line for line in written)


def test_what_to_do_in_a_paused_game_is_to_let_it_go_on(workspace: Workspace) -> None:
    written, _ = told(workspace, "pause", "what", "end")
    at = written.index("Nothing is wrong.")
    paused = written[at + 1]  # in the middle of a step, or between two
    assert paused.startswith("The game is paused. ") and paused.endswith("until you let it go on.")


def test_the_last_messages_are_told_again_with_their_times(workspace: Workspace) -> None:
    written, _ = told(workspace, "pause", "messages", "end")
    at = [line for line in written if re.fullmatch(r"\d\d:\d\d:\d\d Paused: .*", line)]
    assert at and at[0][9:] in written
    assert not any("lines above" in line for line in written)


def test_the_last_line_that_ends_a_game_does_not_say_that_the_game_goes_on(
    workspace: Workspace,
) -> None:
    written, _ = told(workspace, "end")
    assert any("You ended the game" in line for line in written)
    assert NO_MORE not in written


@pytest.mark.parametrize("lines", [("pause",), ("stop the robot",), ("take over",)])
def test_a_game_that_waits_without_further_lines_ends(
    workspace: Workspace, lines: tuple[str, ...]
) -> None:
    written, ended = told(workspace, *lines, speed=50)
    assert not ended and NOBODY in written


def test_a_line_can_say_of_several_people_that_they_left(workspace: Workspace) -> None:
    told(workspace, "pause", "left User 2, User 3 and User 4", "end", speed=50)
    left = [e.record.person for e in workspace.store.events(StaffAction) if e.record.did == "left"]
    assert left == ["user2", "user3", "user4"]


def test_staff_pause_stop_resume_take_over_and_end_by_lines(workspace: Workspace) -> None:
    written, ended = told(
        workspace, "pause", "where", "go on", "wait until called", "Stop it!", "go on",
        "take over", "wait until asked", "tell a joke", "y", "end", speed=100,
    )  # fmt: skip
    assert ended  # staff ended it on purpose
    text = "\n".join(written)
    for words in (
        "Paused: ", "(paused)", "STOP: Tangy stands still.", "Tangy goes on.",
        "Did you say: tell a joke?", "joke, as Ada said", "You ended the game.",
    ):  # fmt: skip
        assert words in text


def test_a_fault_is_acknowledged_and_cleared_by_lines(workspace: Workspace) -> None:
    written, ended = told(
        workspace, "wait until halted", "what", "clear", "seen", "expert", "clear",
        inject=("laser-disconnected@2",),
    )  # fmt: skip
    text = "\n".join(written)
    assert ended and "Say first that you have seen it: seen." in text
    assert "Laser scanner silent" in text and "The game is over" in text


def test_an_unknown_command_is_reported_with_the_nearest_one(workspace: Workspace) -> None:
    written, _ = told(
        workspace, "pause", "pasue", "qwertz", "ask for Nobody", "help", "why", "faults",
        "# a remark", "", "end",
    )  # fmt: skip
    text = "\n".join(written)
    assert "I do not know 'pasue' here. You can type: pause." in text
    assert "I do not know 'qwertz' here." in text and "There is nobody called 'Nobody'" in text
    assert "take over: you say what Tangy does next" in text
    assert "No faults in this game." in text


def test_a_log_that_cannot_be_written_pauses_the_game(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    real, fails = workspace.store.append, iter([True])

    def append(record: EventRecord, **more: Any) -> int:
        if record.KIND == "game step" and next(fails, False):
            raise TangyError("The disk is full.")
        return real(record, **more)

    monkeypatch.setattr(workspace.store, "append", append)
    written, ended = told(workspace, "wait until paused", "go on", "wait until called", "end")
    assert "The disk is full." in written and ended


def test_a_stop_is_read_during_the_execution_of_an_answer(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    answer, seen = GameController.answer, list[bool]()

    def slow(self: GameController, *answered: Any) -> Any:
        seen.append(stopped.wait(20))
        return answer(self, *answered)

    stopped, stop = threading.Event(), GameController.apply

    def applied(self: GameController, command: Any) -> Any:
        if isinstance(command, StopRobot):
            stopped.set()
        return stop(self, command)

    monkeypatch.setattr(GameController, "answer", slow)
    monkeypatch.setattr(GameController, "apply", applied)
    told(workspace, "take over", "wait until asked", "tell a joke", "y", "stop the robot", "end")
    assert seen == [True]


def test_a_scripted_line_is_read_only_when_tangy_waits(workspace: Workspace) -> None:
    learnt, _ = load_policy(workspace.store, workspace.activity)
    game = workspace.supervision(learnt, 4, asks=True, injections=("laser-disconnected@2",))
    written = play_by_turns(game, "pause", "go on", "seen", "expert", "clear", "end")
    assert game.steps >= 2 and "Paused: Tangy does nothing more after this. Type: go on." in written
    assert "The simulated expert has looked at it." in written
    assert any("The game is over" in line for line in written), "the rest was not asked for"


def test_no_game_begins_after_a_stop_without_a_release(workspace: Workspace) -> None:
    learnt, _ = load_policy(workspace.store, workspace.activity)
    control = GameController(workspace.supervision(learnt, 4, asks=True), "Ada")
    control.apply(StopRobot())
    assert control.begin() == [] and control.supervision.over
    control.apply(GoOn())
    assert control.begin() and not control.supervision.over


def test_the_next_behaviour_may_be_typed_before_the_question(workspace: Workspace) -> None:
    written, ended = told(workspace, "take over", "tell a joke", "y", "end", speed=100)
    text = "\n".join(written)
    assert ended and "joke, as Ada said" in text and "I do not know" not in text


def test_an_end_typed_ahead_is_executed_in_order(
    workspace: Workspace, monkeypatch: pytest.MonkeyPatch
) -> None:
    go_on, begun, all_read = GameController.next, threading.Event(), threading.Event()

    def late(self: GameController) -> Any:
        begun.set()
        if self.taking_over:
            all_read.wait(20)
        return go_on(self)

    def read(line: str, **more: Any) -> Any:
        if line == LAST:
            all_read.set()
        return read_command(line, **more)

    monkeypatch.setattr(GameController, "next", late)
    monkeypatch.setattr("tangy_tui.app.command_grammar.read_command", read)
    lines = "take over", "tell a joke", "y", "end", LAST
    written, ended = told(workspace, *lines, speed=100, after=begun)
    assert ended and "joke, as Ada said" in "\n".join(written)


def test_distant_words_are_never_read_as_a_command_that_moves_the_robot(
    workspace: Workspace,
) -> None:
    written, _ = told(workspace, "pause", "don't stop", "end")
    assert 'I do not know "don\'t stop" here. Type help for all commands.' in written
