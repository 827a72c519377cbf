"""Tangy's questions by lines: only an answer to a question that was shown counts."""

from __future__ import annotations

import re
from pathlib import Path

import pytest

from tangy_tui.app.game_commands import Confirm, SetAutonomy
from tangy_tui.app.game_controller import GameController
from tangy_tui.app.terminal_session import TerminalSession
from tangy_tui.app.workspace import Workspace
from tangy_tui.console.answering import AnsweredQuestions
from tangy_tui.console.inquiries import Inquiries
from tangy_tui.console.typed_yes import REACTION_SECONDS, TypedYes
from tangy_tui.learning.policies import load_policy
from tangy_tui.text.questions import TOO_EARLY


@pytest.fixture
def data_folder(taught: Path) -> Path:
    """A folder with three demonstrations and a policy learnt from them."""
    return taught


@pytest.fixture
def control(workspace: Workspace) -> GameController:
    """A simulated game in which Tangy asks before everything it does."""
    learnt, _ = load_policy(workspace.store, workspace.activity)
    controller = GameController(workspace.supervision(learnt, 4, asks=True), "Ada")
    controller.begin()
    controller.apply(SetAutonomy("each"))
    controller.next()
    return controller


class Asked:
    """The questions of a game, a clock, and what was written."""

    def __init__(
        self, control: GameController, workspace: Workspace, *, remote: bool = False
    ) -> None:
        self.now = 0.0
        self.written: list[str] = []
        yes = TypedYes(
            terminal=True,
            session=lambda: TerminalSession(remote=remote),
            flush=lambda: None,
            clock=lambda: self.now,
        )
        inquiries = Inquiries(control, workspace.name, None, str)
        self.questions = AnsweredQuestions(control, yes, inquiries, self.write)

    def write(self, line: str) -> None:
        self.now += 5.0  # a slow terminal
        self.written.append(line)


def test_a_yes_to_the_next_step_is_not_the_yes_to_the_step_before(
    control: GameController, workspace: Workspace
) -> None:
    asked = Asked(control, workspace)
    for _ in range(2):
        asked.questions.prompt(None)
        assert asked.questions.answer("y") == TOO_EARLY
        asked.now += REACTION_SECONDS
        assert asked.questions.answer("y") == Confirm(yes=True)
        control.apply(Confirm(yes=True))
        control.next()
        assert not asked.questions.open and asked.questions.answer("y") is None
        asked.questions.prompt(None)
        control.next()
    assert len(asked.written) == 2


def test_from_another_machine_the_yes_to_a_step_is_a_digit(
    control: GameController, workspace: Workspace
) -> None:
    asked = Asked(control, workspace, remote=True)
    asked.questions.prompt(None)
    asked.now += REACTION_SECONDS
    (digit,) = re.findall(r"(\d): ", asked.written[0])
    assert isinstance(asked.questions.answer("y"), str)
    assert asked.questions.answer(digit) == Confirm(yes=True)
    assert asked.questions.answer("n") == Confirm(yes=False)
