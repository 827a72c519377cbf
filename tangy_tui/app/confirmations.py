"""Commands of staff that need a confirmation first: the same for screens and for the console."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from tangy_tui.app.game_commands import EndGame, GameCommand, GoOn, TakeBackCall

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController

ConfirmationKind = Literal["end", "take back", "move again", "go on"]


@dataclass(frozen=True, slots=True)
class Confirmation:
    """A question to staff before a command; `about` is the label of the call it takes back."""

    kind: ConfirmationKind
    command: GameCommand
    about: str = ""


def needed_confirmation(command: GameCommand, control: GameController) -> Confirmation | None:
    """Return the question to ask before a command, None if it is carried out at once.

    What ends a game or takes back a call cannot be undone. To go on needs a question only if the
    robot was stopped, or if the program paused the game and not staff.
    """
    match command:
        case EndGame() if not control.supervision.over:
            return Confirmation("end", command)
        case TakeBackCall(label) if called := control.plan.called(label):
            return Confirmation("take back", TakeBackCall(called), called)
        case GoOn() if control.stopped and control.robot.there:
            return Confirmation("move again", command)
        case GoOn() if control.paused_itself and not control.stopped:
            return Confirmation("go on", command)
        case _:
            return None
