"""A card is judged only if it is known to belong to the person who sits there."""

from __future__ import annotations

from typing import cast

import pytest

from tangy_hw.dealt_cards import CardDoubt, CardLearnt, DealtCards
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_profiles.activity import load_activity
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tests.hw.links import FakeLink, LaidCard

BINGO = load_activity("bingo")
PEOPLE = ("user1", "user2", "user3", "user4")
OWN, NEIGHBOURS, FOREIGN = 17, 31, 99


@pytest.fixture
def link() -> FakeLink:
    return FakeLink(PEOPLE)


@pytest.fixture
def world(link: FakeLink) -> LiveWorld:
    return world_of(link)


def world_of(link: FakeLink, *, knows_faces: bool = False) -> LiveWorld:
    world = LiveWorld(
        BINGO,
        PEOPLE,
        cast(RobotLink, link),
        load_robot(),
        load_room(),
        seed=1,
        pace=1.0,
        knows_faces=knows_faces,
    )
    world.begin()
    do(world, "greeting")
    return world


def do(world: LiveWorld, name: str, target: str | None = None) -> None:
    world.execute(BINGO.action(BINGO.behaviour(name), target, None))


def visit(world: LiveWorld, link: FakeLink, seat: int, card: LaidCard) -> str:
    """Let the robot visit a person who asks, and return the observed card state."""
    person = PEOPLE[seat - 1]
    link.cards = {person: card}
    link.sign(seat)
    world.observe()
    do(world, "navigate to user", person)
    return world.observe().situation.user_state


def wrongly_marked(number: int, **how: object) -> LaidCard:
    return LaidCard(number, marked=1, **how)  # type: ignore[arg-type]


def test_no_card_is_judged_if_several_lie_before_a_person(world: LiveWorld, link: FakeLink) -> None:
    world.cards.dealt.deal({"user1": OWN, "user2": NEIGHBOURS})
    seen = visit(world, link, 1, wrongly_marked(OWN, others=(NEIGHBOURS,)))
    assert seen == "occluded" and world.scene().card is None
    expected = CardDoubt("user1", (OWN, NEIGHBOURS), "several cards", OWN)
    assert list(world.cards.news) == [expected]
    assert world.cards.doubt == expected


def test_no_card_is_judged_if_two_copies_are_in_sight(world: LiveWorld, link: FakeLink) -> None:
    world.cards.dealt.deal({"user1": OWN})
    assert visit(world, link, 1, wrongly_marked(OWN, others=(OWN,))) == "occluded"
    assert [one.why for one in world.cards.news if isinstance(one, CardDoubt)] == ["copies"]


@pytest.mark.parametrize(
    ("card", "why", "owner"), [(NEIGHBOURS, "another's card", "user2"), (FOREIGN, "other card", "")]
)
def test_a_card_of_another_person_or_of_nobody_is_not_judged(
    world: LiveWorld, link: FakeLink, card: int, why: str, owner: str
) -> None:
    world.cards.dealt.deal({"user1": OWN, "user2": NEIGHBOURS})
    assert visit(world, link, 1, wrongly_marked(card)) == "occluded"
    (told,) = world.cards.news
    assert isinstance(told, CardDoubt)
    assert (told.person, told.cards, told.why, told.own, told.owner) == (
        "user1", (card,), why, OWN, owner,
    )  # fmt: skip
    assert visit(world, link, 1, wrongly_marked(OWN)) == "incorrectly marked"
    assert world.cards.doubt is None


def test_the_robot_asks_nothing_about_a_card_of_another_person(
    world: LiveWorld, link: FakeLink
) -> None:
    world.cards.dealt.deal({"user1": OWN})
    visit(world, link, 1, wrongly_marked(OWN))
    link.cards["user1"].number = FOREIGN  # the cards were changed while the robot stood there
    world.read_card("user1")
    said = len(link.said)
    do(world, "remove markers", "user1")
    assert len(link.said) == said and world.observe().situation.user_state == "occluded"


def test_a_change_on_a_swapped_card_is_no_response(world: LiveWorld, link: FakeLink) -> None:
    world.cards.dealt.deal({"user1": OWN})
    visit(world, link, 1, wrongly_marked(OWN))

    def swaps(what: str, time: float) -> None:
        if what == "card":
            link.cards["user1"] = LaidCard(FOREIGN)

    link.meanwhile = swaps
    outcome = world.execute(BINGO.action(BINGO.behaviour("remove markers"), "user1", "praise"))
    assert outcome.response is None


def test_the_first_certain_sight_tells_whose_card_it_is(world: LiveWorld, link: FakeLink) -> None:
    assert visit(world, link, 1, wrongly_marked(OWN)) == "incorrectly marked"
    assert list(world.cards.news) == [CardLearnt("user1", OWN)]
    assert visit(world, link, 1, wrongly_marked(FOREIGN)) == "occluded"
    assert visit(world, link, 2, wrongly_marked(OWN)) == "occluded"
    assert visit(world, link, 2, wrongly_marked(NEIGHBOURS)) == "incorrectly marked"
    world.begin()
    assert world.cards.dealt.card_of("user1") is None


def test_an_uncertain_sight_is_neither_learnt_nor_judged(world: LiveWorld, link: FakeLink) -> None:
    assert visit(world, link, 1, wrongly_marked(OWN, sure=False)) == "occluded"
    assert world.cards.dealt.card_of("user1") is None and not world.cards.news
    visit(world, link, 1, wrongly_marked(OWN))
    looks = [what["identify"] for did, what in link.done if did == "card"]
    assert looks == [True, True]  # two pictures are needed while the card is not known
    visit(world, link, 1, wrongly_marked(OWN))
    assert [what["identify"] for did, what in link.done if did == "card"][-1] is False


def test_a_sight_of_several_cards_is_not_learnt(world: LiveWorld, link: FakeLink) -> None:
    assert visit(world, link, 1, LaidCard(OWN, others=(NEIGHBOURS,))) == "occluded"
    assert world.cards.dealt.card_of("user1") is None


def test_a_card_belongs_to_the_person_and_not_to_the_seat(link: FakeLink) -> None:
    world = world_of(link, knows_faces=True)
    world.cards.dealt.deal({"user2": NEIGHBOURS, "user4": OWN})
    link.faces["user2"] = "user4"
    assert visit(world, link, 2, wrongly_marked(OWN)) == "incorrectly marked"
    link.faces["user2"] = "user2"
    assert visit(world, link, 2, wrongly_marked(OWN)) == "occluded"


def test_staff_hear_of_a_doubtful_card_once_in_a_visit(world: LiveWorld, link: FakeLink) -> None:
    world.cards.dealt.deal({"user1": OWN})
    visit(world, link, 1, LaidCard(FOREIGN))
    for _ in range(3):
        world.read_card("user1")
    link.cards["user1"] = LaidCard(FOREIGN, others=(OWN,))
    world.read_card("user1")
    assert [one.cards for one in world.cards.news if isinstance(one, CardDoubt)] == [
        (FOREIGN,),
        (OWN, FOREIGN),
    ]
    visit(world, link, 1, LaidCard(FOREIGN))
    assert len(world.cards.news) == 3


def test_a_card_given_by_staff_overrides_the_seen_one() -> None:
    dealt = DealtCards()
    assert dealt.learn("user1", NEIGHBOURS)
    assert not dealt.learn("user2", NEIGHBOURS)
    dealt.give("user2", NEIGHBOURS)
    assert dealt.card_of("user1") is None and dealt.owner(NEIGHBOURS) == "user2"
    dealt.give("user1", OWN)
    dealt.begin()
    assert (dealt.card_of("user1"), dealt.card_of("user2")) == (OWN, NEIGHBOURS)
    dealt.give("user1", None)
    assert dealt.card_of("user1") is None and dealt.learn("user1", FOREIGN)
    dealt.deal({"user1": OWN})
    assert (dealt.card_of("user1"), dealt.card_of("user2")) == (OWN, None)


def test_cards_of_an_interrupted_game_give_way_to_newer_ones() -> None:
    dealt = DealtCards()
    dealt.deal({"user1": OWN})
    dealt.recall({"user1": NEIGHBOURS, "user2": OWN, "user3": FOREIGN}, {"user4": NEIGHBOURS})
    assert [dealt.card_of(person) for person in PEOPLE] == [OWN, None, FOREIGN, NEIGHBOURS]
    assert dict(dealt.given) == {"user1": OWN, "user3": FOREIGN}
