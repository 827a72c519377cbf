"""What staff had said in a game before it was interrupted, and the game had not done yet."""

from __future__ import annotations

from collections.abc import Iterable, Sequence

from tangy_profiles.game_records import GameBeginning, GameChange, GameStep
from tangy_profiles.staff_records import CLAIM_CHECKS, StaffAction
from tangy_profiles.store import Event


def unchecked_claims(notes: Iterable[StaffAction]) -> tuple[tuple[int, str], ...]:
    """Return the claims that were made and not checked: each card, and the person ("": unknown)."""
    claims = dict[int, str]()
    for note in notes:
        card = int(note.detail) if note.detail.isdecimal() else 0
        if note.did == "claim made" and card:
            claims[card] = note.person or claims.get(card, "")
        elif note.did in CLAIM_CHECKS:
            claims.pop(card, None)
    return tuple(claims.items())


def unmade_moves(
    game: GameBeginning, notes: Sequence[StaffAction], changes: Sequence[GameChange], steps: int
) -> tuple[GameChange, ...]:
    """Return who left or came by the word of staff, but not by the changes of the game."""
    away, told = {*game.absent}, dict[str, StaffAction]()
    for change in changes:
        if change.game == game.game and change.what in ("left", "came", "joined"):
            (away.add if change.what == "left" else away.discard)(change.person)
    for note in notes:
        if note.did in ("left", "came") and not note.seat:  # somebody new joins otherwise
            told[note.person] = note
    return tuple(
        GameChange(
            game=game.game,
            steps=steps,
            what="left" if note.did == "left" else "came",
            person=person,
            by=note.by,
        )
        for person, note in told.items()
        if (note.did == "left") is not (person in away)
    )


def late_requests(
    acts: Sequence[Event[StaffAction]], steps: Sequence[Event[GameStep]]
) -> tuple[str, ...]:
    """Return for whom staff have asked since, whom no step shows asking, and nobody visited."""
    asked: dict[str, None] = {}
    for event in sorted((*acts, *steps), key=lambda event: event.seq):
        match event.record:
            case StaffAction(did="asked for", person=person):
                asked[person] = None
            case GameStep() as step:
                shown = () if step.after is None else step.after.users
                for one in (step.target, *(user.id for user in shown if user.request == "AR")):
                    asked.pop(one or "", None)
    return tuple(asked)
