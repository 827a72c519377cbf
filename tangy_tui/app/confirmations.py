"""Commands of staff that need a confirmation first: the same for screens and for the console."""

from __future__ import annotations

from dataclasses import dataclass
from typing import TYPE_CHECKING, Literal

from tangy_tui.app.game_commands import ClaimCard, EndGame, GameCommand, GoOn, HasCard, TakeBackCall

if TYPE_CHECKING:
    from tangy_tui.app.game_controller import GameController

ConfirmationKind = Literal[
    "end",
    "take back",
    "move again",
    "go on",
    "card of another",
    "claim of another",
    "claim with another",
    "claim away",
]


@dataclass(frozen=True, slots=True)
class Confirmation:
    """A question to staff before a command.

    `about` is the label of the call that it takes back, or the number of the card that it is about;
    `known` is the number of another card that the person has.
    `people` are the ids of the person whom the command names, and of the card's owner if that is
    another person. `calling` is the label of a number that is being called meanwhile.
    """

    kind: ConfirmationKind
    command: GameCommand
    about: str = ""
    people: tuple[str, ...] = ()
    calling: str = ""
    known: str = ""


def needed_confirmation(command: GameCommand, control: GameController) -> Confirmation | None:
    """Return the question to ask before a command, None if it is carried out at once.

    What ends a game or takes back a call cannot be undone. To go on needs a question only if the
    robot was stopped, or if the program paused the game and not staff. A card needs one if another
    person has it, a claim also if its person is away or has another card: a mistyped number is told
    to everybody.
    """
    match command:
        case EndGame() if not control.supervision.over:
            return Confirmation("end", command)
        case TakeBackCall(label) if called := control.plan.called(label):
            calling = control.plan.calling
            return Confirmation("take back", TakeBackCall(called), called, calling=calling)
        case GoOn() if control.stopped and control.robot.there:
            return Confirmation("move again", command)
        case GoOn() if control.paused_itself and not control.stopped:
            return Confirmation("go on", command)
        case HasCard(person, card) if control.robot.there:
            return _about_card(command, "card of another", card, person, control)
        case ClaimCard() if not control.supervision.over:
            claim = control.plan.with_card(command)
            return _about_claim(claim, control)
        case _:
            return None


def _about_claim(claim: ClaimCard, control: GameController) -> Confirmation | None:
    """Return the question about the card of another person, or of one who is away."""
    if control.plan.refuses(claim) is not None:
        return None
    asked = _about_card(claim, "claim of another", claim.card, claim.person, control)
    world = control.plan.world
    if asked is not None or world is None:
        return asked
    known = world.known_cards.get(claim.person, claim.card)
    if known != claim.card:
        person = (claim.person,)
        return Confirmation("claim with another", claim, str(claim.card), person, known=str(known))
    claims = claim.person or world.holder(claim.card)
    if claims not in world.away:
        return None
    return Confirmation("claim away", claim, str(claim.card), (claims,))


def _about_card(
    command: GameCommand, kind: ConfirmationKind, card: int, person: str, control: GameController
) -> Confirmation | None:
    """Return the question about a card that another person has, None if nobody else has it."""
    world = control.plan.world
    owner = "" if world is None else world.holder(card)
    if not person or owner in ("", person):
        return None
    return Confirmation(kind, command, str(card), (person, owner))
