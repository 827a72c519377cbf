"""Cards dealt by staff on the command line, and reports on unjudged cards."""

from __future__ import annotations

from collections.abc import Callable
from subprocess import CompletedProcess

import pytest

from tangy_hw.dealt_cards import CardDoubt, CardLearnt, Doubt
from tangy_profiles.errors import TangyError
from tangy_profiles.person import Person
from tangy_tui.app.card_news import doubt_document
from tangy_tui.app.dealing import read_dealt
from tangy_tui.text.live_news import doubt_words, learnt_words

Tangy = Callable[..., CompletedProcess[str]]

PEOPLE = (Person("user1", "Ada"), Person("user2", "José"), Person("user3", "Cleo"))
NAMES = {person.id: person.name for person in PEOPLE}.__getitem__


def test_cards_are_dealt_by_name_or_id() -> None:
    assert read_dealt(["Ada=17", "user3=249"], PEOPLE) == {"user1": 17, "user3": 249}
    assert read_dealt(["jose\u0301 = 5"], PEOPLE) == {"user2": 5}
    assert read_dealt([], PEOPLE) == {}


@pytest.mark.parametrize(
    ("texts", "says"),
    [
        (["Adda=17"], "nobody who plays is called so; did you mean 'Ada'?"),
        (["17"], "nobody who plays is called so"),
        (["Ada="], "cards have the numbers 1 to 249"),
        (["Ada=0"], "cards have the numbers 1 to 249"),
        (["Ada=250"], "cards have the numbers 1 to 249"),
        (["Ada=1e2"], "cards have the numbers 1 to 249"),
        (["Ada=17", "user1=18"], "nobody has two cards"),
        (["Ada=17", "Cleo=17"], "no card two people"),
    ],
)
def test_an_invalid_deal_is_refused_in_one_sentence(texts: list[str], says: str) -> None:
    with pytest.raises(TangyError, match="--card") as refused:
        read_dealt(texts, PEOPLE)
    assert says in str(refused.value) and "\n" not in str(refused.value)


def test_the_bench_deals_its_own_cards(tangy: Tangy) -> None:
    done = tangy("live", "--bench", "--headless", "--card", "Ada=17")
    assert done.returncode == 2 and "--card: the bench brings its own" in done.stderr


@pytest.mark.parametrize(
    ("why", "cards", "owner", "says"),
    [
        ("several cards", (17, 31), "", "There are two cards in front of Ada: 17 and 31. Tangy "
         "cannot tell which is theirs, and judges neither"),
        ("several cards", (3, 17, 31), "", "There are three cards in front of Ada: 3, 17 and 31. "
         "Tangy cannot tell which is theirs, and judges none"),
        ("copies", (17, 17), "", "There are two copies of card 17 in front of Ada."),
        ("another's card", (31,), "user2", "The card in front of Ada, 31, is José's, as far as"),
        ("other card", (31,), "", "The card in front of Ada is 31; theirs is 17, as far as"),
    ],
)  # fmt: skip
def test_the_reason_for_an_unjudged_card_is_explained(
    why: Doubt, cards: tuple[int, ...], owner: str, says: str
) -> None:
    doubt = CardDoubt("user1", cards, why, 17, owner)
    assert doubt_words(doubt, NAMES).startswith(says)
    document = doubt_document(doubt, 2)
    assert (document["game"], document["why"], document["cards"]) == (2, why, [*cards])


def test_a_learnt_card_is_reported_with_its_owner() -> None:
    words = learnt_words(CardLearnt("user1", 17), NAMES)
    assert words == "Card 17 lies in front of Ada: Tangy takes it for theirs."
