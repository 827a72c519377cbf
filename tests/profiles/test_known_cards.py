"""The owners of cards, as read from the log."""

from __future__ import annotations

from tangy_profiles.known_cards import KnownCards
from tangy_profiles.staff_records import StaffAction, StaffActionKind


def noted(did: StaffActionKind, person: str = "", detail: str = "") -> StaffAction:
    return StaffAction(game="game", did=did, by="Ada", person=person, detail=detail)


def test_the_newest_note_says_whose_card_it_is() -> None:
    known = KnownCards.of(
        [
            noted("card learnt", "user3", "5"),
            noted("cards dealt", detail="user1 12, user2 17"),
            noted("card learnt", "user3", "31"),
            noted("card given", "user1", "31"),
            noted("card given", "user2"),
            noted("pace", detail="20"),
            noted("card learnt", "user4", "40"),
        ]
    )
    assert known == KnownCards({"user1": 31}, {"user4": 40})


def test_a_resumed_game_knows_the_cards_that_were_seen_before() -> None:
    dealt = noted("cards dealt", detail="user3 17")
    known = KnownCards.of([dealt, noted("card learnt", "user2", "31"), dealt])
    assert known == KnownCards({"user3": 17}, {"user2": 31})


def test_without_notes_no_card_is_known() -> None:
    assert KnownCards.of([noted("cards dealt"), noted("noted", detail="user1 12")]) == KnownCards()
