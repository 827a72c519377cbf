"""What staff had said before an interruption, and the game had not done yet."""

from __future__ import annotations

import pytest

from tangy_profiles.game_records import GameBeginning, GameChange
from tangy_profiles.staff_records import StaffAction, StaffActionKind
from tangy_profiles.unfinished import unchecked_claims, unmade_moves

GAME = GameBeginning(game="g", people=("ann", "bob"), absent=("bob",))


def act(did: StaffActionKind, person: str = "", detail: str = "", seat: int = 0) -> StaffAction:
    return StaffAction(game="g", did=did, by="Ada", person=person, detail=detail, seat=seat)


@pytest.mark.parametrize(
    ("notes", "left"),
    [
        ([act("claim made", "ann", "17"), act("claim made", "", "17")], ((17, "ann"),)),
        ([act("claim made", "", "17"), act("claim made", "ann", "17")], ((17, "ann"),)),
        ([act("claim made", "ann", "17"), act("claim wrong", "ann", "17")], ()),
        ([act("claim made", "ann", "17"), act("claim right", "bob", "3")], ((17, "ann"),)),
        ([act("claim made", "ann", "what")], ()),
    ],
)
def test_a_claim_waits_until_it_is_checked_with_the_person_who_was_named(
    notes: list[StaffAction], left: tuple[tuple[int, str], ...]
) -> None:
    assert unchecked_claims(notes) == left


@pytest.mark.parametrize(
    ("notes", "changes", "unmade"),
    [
        ([act("left", "ann")], [], [("left", "ann")]),
        ([act("left", "ann")], ["left"], []),
        ([act("left", "ann"), act("came", "ann")], ["left"], [("came", "ann")]),
        ([act("left", "ann"), act("came", "ann")], [], []),
        ([act("left", "bob")], [], []),
        ([act("came", "bob")], [], [("came", "bob")]),
        ([act("came", "bob", seat=2)], [], []),
    ],
)
def test_only_moves_that_the_game_has_not_made_are_left_to_make(
    notes: list[StaffAction], changes: list[str], unmade: list[tuple[str, str]]
) -> None:
    made = [GameChange(game="g", steps=1, what="left", person="ann", by="Ada") for _ in changes]
    found = unmade_moves(GAME, notes, made, 5)
    assert [(one.what, one.person) for one in found] == unmade
    assert all((one.game, one.steps, one.by) == ("g", 5, "Ada") for one in found)
