"""Commands that can never work are refused at once, and not only when their turn comes."""

from __future__ import annotations

from pathlib import Path
from typing import get_args

import pytest

from tangy_profiles.game_rules import GamePlan
from tangy_profiles.staff_records import StaffAction
from tangy_tui.app.confirmations import needed_confirmation
from tangy_tui.app.game_commands import ClaimCard, ComesIn, GoesAway, HasCard
from tangy_tui.app.staff_notes import REFUSALS, DoneKind, NoteKind, StaffNote
from tangy_tui.app.workspace import Workspace
from tangy_tui.text.confirmations import confirmation_words
from tangy_tui.text.control import noted_words
from tests.app.test_interruption import Robot
from tests.support.planned_games import Planned


@pytest.fixture
def begun(planned: Planned) -> Planned:
    planned.begin(GamePlan())
    return planned


def test_a_claim_for_a_card_that_does_not_exist_names_the_cards_in_play(begun: Planned) -> None:
    assert begun.control.refuses(ClaimCard(999)) == StaffNote("no such card", "999", "1, 2, 3, 4")
    assert begun.control.refuses(ClaimCard(3)) is None


def test_a_person_who_does_not_play_neither_comes_nor_leaves(begun: Planned) -> None:
    refused = StaffNote("not playing", "user9")
    assert begun.control.refuses(GoesAway("user9")) == refused
    assert begun.control.refuses(ComesIn("user9")) == refused
    assert begun.control.refuses(GoesAway("user1")) is None


def test_a_live_claim_for_a_card_of_nobody_is_refused_once_all_cards_are_known(
    taught: Path,
) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)
    assert robot.control.refuses(ClaimCard(200)) is None  # somebody may have it
    for card, person in enumerate(robot.world.people, 31):
        robot.world.cards.dealt.give(person, card)
    assert robot.control.refuses(ClaimCard(200)) == StaffNote("whose card", "200", "31, 32, 33, 34")
    assert robot.control.refuses(ClaimCard(200, "user1")) is None  # staff say whose it is
    assert robot.control.refuses(ClaimCard(31)) is None
    workspace.close()


def test_a_claim_for_a_person_who_has_another_card_is_asked_about(taught: Path) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)
    for card, person in enumerate(robot.world.people, 31):
        robot.world.cards.dealt.give(person, card)
    asked = needed_confirmation(ClaimCard(87, "user1"), robot.control)
    assert asked is not None
    words = confirmation_words(asked, workspace.name)
    name = workspace.name("user1")
    assert words.question == f"{name} has card 31. Is card 87 theirs, too?"
    assert needed_confirmation(ClaimCard(31, "user1"), robot.control) is None
    assert needed_confirmation(ClaimCard(0, "user1"), robot.control) is None
    workspace.close()


def test_a_card_that_staff_name_is_known_before_a_visit_and_names_its_owner(taught: Path) -> None:
    workspace = Workspace(taught)
    robot = Robot(workspace)
    control, dealt = robot.control, robot.world.cards.dealt
    assert control.apply(HasCard("user1", 17)) == [StaffNote("card given", "user1", "17")]
    given = StaffNote("card given", "user2", "17", ("user1",))
    assert control.apply(HasCard("user2", 17)) == [given]
    assert (dealt.card_of("user1"), dealt.card_of("user2")) == (None, 17)
    (wrong,) = control.apply(ClaimCard(17))
    assert isinstance(wrong, StaffNote)
    assert (wrong.kind, wrong.about, wrong.people) == ("claim wrong", "17", ("user2",))
    noted = [(e.record.did, e.record.person) for e in workspace.store.events(StaffAction)]
    assert noted[-4:] == [
        ("card given", "user1"), ("card given", "user2"),
        ("claim made", "user2"), ("claim wrong", "user2"),
    ]  # fmt: skip
    assert control.apply(HasCard("user9", 3)) == [StaffNote("not playing", "user9")]
    assert control.apply(HasCard("user1", 10**5)) == [StaffNote("no such card", "100000")]
    assert dealt.card_of("user1") is None
    workspace.close()


def test_a_card_that_replaces_another_names_it(taught: Path) -> None:
    workspace = Workspace(taught)
    control = Robot(workspace).control
    control.apply(HasCard("user1", 31))
    (again,) = control.apply(HasCard("user1", 31))
    (given,) = control.apply(HasCard("user1", 17))
    assert isinstance(again, StaffNote) and isinstance(given, StaffNote)
    assert noted_words(again, str) == "user1 has card 31."
    assert noted_words(given, str) == "user1 has card 17. user1 had card 31 before."
    workspace.close()


def test_each_reply_is_either_a_refusal_or_not() -> None:
    done = set(get_args(DoneKind))
    assert done | REFUSALS == set(get_args(NoteKind))
    assert not done & REFUSALS
    assert {"whose card", "not playing", "nothing asked"} <= REFUSALS
