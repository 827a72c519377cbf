"""The live world: the robot's actions for each behaviour, and how it reads its sensors."""

from __future__ import annotations

from dataclasses import replace
from typing import Any, cast

import pytest

from tangy_hw.device_protocols import Pose
from tangy_hw.robot_client.client import RobotLink
from tangy_hw.robot_client.help_requests import SIGN_SECONDS
from tangy_hw.robot_client.live_world import LiveWorld
from tangy_hw.robot_client.response_watch import PATIENCES
from tangy_profiles.card_face import called_cells, numbers_of
from tangy_profiles.faults import Remedy
from tangy_profiles.game_records import GameChange
from tangy_profiles.health import Health, Reading
from tangy_profiles.robot import load_robot
from tangy_profiles.room import load_room
from tangy_profiles.state import FRONT, Outcome
from tests.hw.links import BINGO, FakeLink, LaidCard

PEOPLE = ("user1", "user2", "user3", "user4")
CARD = 7


def world_of(link: FakeLink, **more: Any) -> LiveWorld:
    names = {"user1": "Ann", "user2": "Ben", "user3": "Cleo", "user4": "Dan"}
    world = LiveWorld(
        BINGO, PEOPLE, cast(RobotLink, link), load_robot(), load_room(), seed=1, names=names, **more
    )
    world.begin()
    return world


@pytest.fixture
def link() -> FakeLink:
    return FakeLink(PEOPLE)


@pytest.fixture
def world(link: FakeLink) -> LiveWorld:
    return world_of(link)


def do(world: LiveWorld, name: str, target: str | None = None, strategy: str = "") -> Outcome:
    behaviour = BINGO.behaviour(name)
    return world.execute(BINGO.action(behaviour, target, strategy or None))


def opened(world: LiveWorld) -> LiveWorld:
    do(world, "greeting")
    return world


def beside(world: LiveWorld, link: FakeLink, seat: int, card: LaidCard) -> LiveWorld:
    """Place the robot beside a person who asks."""
    opened(world)
    person = PEOPLE[seat - 1]
    link.cards[person] = card
    link.sign(seat)
    world.observe()
    do(world, "navigate to user", person)
    return world


def called_of(world: LiveWorld, card: int) -> int:
    numbers = numbers_of(BINGO.deck, card, world.link.setup.deck_seed)
    return called_cells(BINGO.deck, numbers, set(world.called))


def test_a_number_is_spoken_shown_and_called(world: LiveWorld, link: FakeLink) -> None:
    opened(world)
    outcome = do(world, "call number")
    (number,) = outcome.numbers
    label = BINGO.deck.label(number)
    assert outcome.completed and world.called == [number]
    assert label in link.said[-1]
    shown = link.done[-2][1]["picture"] if link.done[-1][0] == "wait" else link.done[-1][1]
    assert shown["number"] == label and list(shown["before"]) == []


def test_the_screen_shows_every_word_if_speech_fails(world: LiveWorld, link: FakeLink) -> None:
    link.speaks = False
    do(world, "greeting")
    texts = [what["picture"]["text"] for did, what in link.done if did == "perform"]
    assert link.said[-1] in texts


@pytest.mark.parametrize("speaks", [True, False])
def test_the_chest_screen_names_nobody(link: FakeLink, speaks: bool) -> None:
    link.speaks = speaks
    world = world_of(link)
    beside(world, link, 2, LaidCard(1, 0))
    do(world, "call number")
    do(world, "mark numbers", PEOPLE[1], "neutral")
    world.recover(Remedy("ask", "f", person=PEOPLE[1], speech="Ben, please.", image="Ben?"))
    shown = [what["picture"] for did, what in link.done if did == "perform"]
    assert any("Ben" in said for said in link.said)
    assert not any("Ben" in str(picture) for picture in shown)
    assert any(picture["asks"] == "Seat 2" for picture in shown)  # it is this person's turn


def test_no_number_comes_twice_and_another_seed_has_another_order(link: FakeLink) -> None:
    world = opened(world_of(link))
    numbers = [do(world, "call number").numbers[0] for _ in range(75)]
    assert sorted(numbers) == list(BINGO.deck.numbers)
    assert do(world, "call number").numbers == ()
    other = LiveWorld(
        BINGO, PEOPLE, cast(RobotLink, FakeLink(PEOPLE)), load_robot(), load_room(), seed=2
    )
    other.begin()
    assert [do(other, "call number").numbers[0] for _ in range(75)] != numbers


def test_calls_keep_a_steady_pace(link: FakeLink) -> None:
    world = opened(world_of(link, pace=20.0))
    do(world, "call number")
    began = link.time
    do(world, "call number")
    assert link.time - began >= 18


def test_a_held_count_down_goes_on_where_it_was(link: FakeLink) -> None:
    world = opened(world_of(link, pace=20.0))
    do(world, "call number")
    before = world.calls_in
    world.hold_calls(held=True)
    link.time += 60.0
    assert world.calls_in == before
    world.hold_calls(held=False)
    assert world.calls_in == pytest.approx(before)
    link.time += 5.0
    assert world.calls_in == pytest.approx(before - 5.0)


def test_a_hold_during_a_call_does_not_lengthen_the_count_down(link: FakeLink) -> None:
    world = opened(world_of(link, pace=20.0))
    asked_at: list[float] = []

    def staff_ask(did: str, time: float) -> None:
        if did == "perform" and not asked_at:  # while the number is being said
            asked_at.append(time)
            world.hold_calls(held=True)
            link.time += 8.0

    link.meanwhile = staff_ask
    do(world, "call number")
    assert asked_at
    count_down = world.calls_in
    link.time += 60.0
    world.hold_calls(held=False)
    assert world.calls_in == pytest.approx(count_down)
    assert count_down <= 20.0


def test_a_number_is_being_called_until_it_counts(world: LiveWorld, link: FakeLink) -> None:
    seen: list[tuple[tuple[int, ...], tuple[int, ...]]] = []
    link.meanwhile = lambda do, time: seen.append((world.calling, world.called_now))
    do(world, "call number")
    called = world.called_now
    assert seen[0] == (called, ()) and seen[-1] == ((), called)
    link.breaks["perform"] = "emergency stop is pressed"
    do(world, "call number")
    assert (world.calling, world.called_now) == ((), called)


def test_an_interrupted_call_does_not_count(world: LiveWorld, link: FakeLink) -> None:
    opened(world)
    link.breaks["perform"] = "emergency stop is pressed"
    outcome = do(world, "call number")
    assert not outcome.completed and outcome.numbers == () and world.called == []
    assert world.broken == "emergency stop is pressed"
    assert world.tracker.count("call number") == 0


def test_raised_signs_are_requests_in_order_of_time(world: LiveWorld, link: FakeLink) -> None:
    opened(world)
    link.state = replace(link.state, asks=((3, 5.0), (1, 9.0)))
    state = world.observe()
    assert state.attended == "user3" and world.tracker.queue == ["user3", "user1"]


def test_a_person_who_takes_the_sign_down_is_not_visited(world: LiveWorld, link: FakeLink) -> None:
    opened(world)
    link.sign(2)
    world.observe()
    link.sign()
    assert world.observe().attended == "user2"  # the sign may only have been hidden for a moment
    link.time += 10
    assert world.observe().attended is None


def test_the_robot_visits_the_person_who_asks_and_reads_the_card(
    world: LiveWorld, link: FakeLink
) -> None:
    beside(world, link, 2, LaidCard(CARD))
    state = world.observe()
    assert state.place == "user2" and tuple(state.situation) == ("help", "AR", "correctly marked")
    (goal,) = [what["to"] for what_do, what in link.done if what_do == "go"]
    stand = load_room().stand("user2", PEOPLE)
    assert goal[:2] == [stand.x, stand.y]


def test_the_robot_stays_at_the_front_if_a_drive_fails(world: LiveWorld, link: FakeLink) -> None:
    link.missed.add("user2")
    beside(world, link, 2, LaidCard(CARD))
    assert world.observe().place == FRONT
    assert tuple(world.observe().situation) == ("navigate", "AR", "occluded")


def test_wrong_marks_are_named_and_their_removal_is_seen(world: LiveWorld, link: FakeLink) -> None:
    card = LaidCard(CARD)
    beside(world, link, 1, card)
    wrong = next(cell for cell in range(25) if not called_of(world, CARD) >> cell & 1)
    card.marked = called_of(world, CARD) | 1 << wrong
    do(world, "navigate to user", "user1")
    assert world.observe().situation.user_state == "incorrectly marked"

    def takes_off(what: str, time: float) -> None:
        if what == "card" and time - said_at > 4:
            card.marked &= ~(1 << wrong)
            link.sign()

    said_at = link.time + 3
    link.meanwhile = takes_off
    outcome = do(world, "remove markers", "user1", "praise")
    number = numbers_of(BINGO.deck, CARD, link.setup.deck_seed)[wrong]
    assert outcome.numbers == (number,) and BINGO.deck.label(number) in link.said[-1]
    response = outcome.response
    assert response is not None and response.strategy == "praise" and response.person == "user1"
    assert response.followed and response.complied
    assert response.seconds == pytest.approx(4, abs=1.5)
    assert world.observe().closed == "user1"  # the card is right, so the request is over


def test_a_late_response_is_followed_but_not_complied(world: LiveWorld, link: FakeLink) -> None:
    card = LaidCard(CARD, seen=False)
    beside(world, link, 1, card)
    began = link.time

    def moves(what: str, time: float) -> None:
        card.seen = time - began > 3 + 1.4 * BINGO.patience

    link.meanwhile = moves
    response = do(world, "move card closer", "user1").response
    assert response is not None and response.followed and not response.complied
    shown = [what["picture"]["text"] for done, what in link.done if done == "perform"]
    assert len(shown) == len(set(shown))  # nothing is asked twice
    assert world.observe().situation.user_state == "correctly marked"


def test_a_person_who_does_nothing_did_not_follow(world: LiveWorld, link: FakeLink) -> None:
    card = LaidCard(CARD)
    beside(world, link, 1, card)
    card.marked = 1
    do(world, "navigate to user", "user1")
    began = link.time
    response = do(world, "remove markers", "user1").response
    assert response is not None and not response.followed and not response.complied
    assert link.time - began >= PATIENCES * BINGO.patience
    assert world.observe().situation.user_state == "incorrectly marked"


def test_a_response_on_an_unseen_card_is_unknown(world: LiveWorld, link: FakeLink) -> None:
    beside(world, link, 1, LaidCard(CARD, seen=False))
    outcome = do(world, "move card closer", "user1")
    assert outcome.completed and outcome.response is None
    assert world.observe().situation.user_state == "occluded"


def test_encouragement_succeeds_when_the_sign_goes_down(world: LiveWorld, link: FakeLink) -> None:
    beside(world, link, 1, LaidCard(CARD))
    link.meanwhile = lambda what, time: link.sign() if what == "wait" else None
    outcome = do(world, "encourage", "user1")
    assert outcome.response is not None and outcome.response.complied
    assert world.observe().closed == "user1" and world.observe().attended is None


def test_a_sign_that_stays_up_keeps_the_request_open(world: LiveWorld, link: FakeLink) -> None:
    beside(world, link, 1, LaidCard(CARD))
    began = link.time
    outcome = do(world, "encourage", "user1")
    assert outcome.completed and outcome.response is None
    assert link.time - began >= SIGN_SECONDS
    assert world.observe().closed is None and world.observe().attended == "user1"


def test_the_last_reading_of_a_silent_sensor_keeps_no_request_open(
    world: LiveWorld, link: FakeLink
) -> None:
    beside(world, link, 1, LaidCard(CARD))
    silent = Reading("requests", age=60.0)
    others = (one for one in link.state.health if one.device != "requests")
    link.state = replace(link.state, health=(*others, silent))
    do(world, "encourage", "user1")
    assert world.observe().closed == "user1" and world.observe().attended is None


def test_a_waiting_request_closes_only_after_its_sign_is_surely_down(
    world: LiveWorld, link: FakeLink
) -> None:
    beside(world, link, 1, LaidCard(CARD))
    link.sign(1, 3)
    assert world.observe().user("user3").request == "AR"
    link.meanwhile = lambda what, time: link.sign(1) if what == "perform" else None
    do(world, "joke")
    assert world.tracker.queue == ["user1"]
    assert world.observe().user("user3").request == "ANR"


def test_a_briefly_hidden_sign_stays_a_request(world: LiveWorld, link: FakeLink) -> None:
    beside(world, link, 1, LaidCard(CARD))
    link.sign(1, 3)
    world.observe()
    down = link.time + 2.0

    def meanwhile(what: str, time: float) -> None:
        if what == "perform":
            link.sign(1)
        elif time > down:
            link.sign(1, 3)

    link.meanwhile = meanwhile
    do(world, "encourage", "user1")
    assert "user3" in world.tracker.queue


def test_a_request_without_a_sign_has_no_observed_response(
    world: LiveWorld, link: FakeLink
) -> None:
    opened(world)
    link.cards["user3"] = LaidCard(CARD)
    world.requests.ask_for("user3")
    assert world.observe().attended == "user3"
    do(world, "navigate to user", "user3")
    outcome = do(world, "encourage", "user3")
    assert outcome.completed and outcome.response is None
    assert world.observe().closed == "user3"


def test_the_robot_asks_nothing_about_an_unseen_card(world: LiveWorld, link: FakeLink) -> None:
    beside(world, link, 1, LaidCard(CARD, seen=False))
    before = len(link.said)
    assert not do(world, "remove markers", "user1").completed
    assert len(link.said) == before


def test_a_win_is_celebrated_only_beside_the_winner(world: LiveWorld, link: FakeLink) -> None:
    opened(world)
    assert not do(world, "celebrate").completed
    card = LaidCard(CARD)
    for _ in range(75):
        do(world, "call number")
        card.marked = called_of(world, CARD)
        if any(card.marked & line == line for line in BINGO.deck.lines):
            break
    beside(world, link, 4, card)
    assert world.observe().situation.user_state == "bingo"
    assert do(world, "celebrate", "user4").completed
    assert do(world, "valediction").completed and world.over


def test_a_robot_that_knows_faces_looks_at_the_face_before_the_card(link: FakeLink) -> None:
    world = world_of(link, knows_faces=True)
    seen: list[tuple[str, str, Any]] = []
    world.cards.looked = lambda what, place, found: seen.append((what, place, found))
    link.faces["user2"] = None
    beside(world, link, 2, LaidCard(CARD))
    assert seen[0] == ("face", "user2", None) and seen[1][:2] == ("card", "user2")


def test_the_recognised_person_at_a_seat_is_addressed_by_name(link: FakeLink) -> None:
    world = world_of(link, knows_faces=True)
    link.faces["user2"] = "user4"
    beside(world, link, 2, LaidCard(CARD))
    assert world.sitting == {"user2": "user4"}
    link.meanwhile = lambda do, _: link.sign() if do == "wait" else None
    outcome = do(world, "encourage", "user2", "praise")
    assert "Dan" in link.said[-1] and "Ben" not in link.said[-1]
    assert outcome.response is not None and outcome.response.person == "user4"

    link.faces["user2"] = "user2"
    beside(world, link, 2, LaidCard(CARD))
    assert not world.sitting


def test_a_call_that_is_taken_back_returns_to_the_draw(world: LiveWorld, link: FakeLink) -> None:
    opened(world)
    (first,) = do(world, "call number").numbers
    world.change(GameChange(game="g", steps=2, what="taken back", number=first))
    assert world.called == []
    rest = [do(world, "call number").numbers[0] for _ in range(75)]
    assert rest[-1] == first and sorted(rest) == list(BINGO.deck.numbers)


def asked_of(link: FakeLink) -> list[str]:
    return [asked for asked, _ in link.done]


@pytest.mark.parametrize(("critical", "why"), [(True, "laser-disconnected"), (False, "")])
def test_only_a_critical_fault_interrupts_a_call(
    world: LiveWorld, link: FakeLink, critical: bool, why: str
) -> None:
    opened(world)
    link.slow["perform"] = 5
    read: list[Health] = []

    def shows(health: Health) -> dict[str, bool]:
        read.append(health)
        return {"camera-slow": False, "laser-disconnected": critical} if len(read) > 1 else {}

    world.commands.diagnosed = shows
    outcome = do(world, "call number")
    assert read and all(health == link.health() for health in read)
    assert world.broken == why and outcome.completed is not critical
    assert asked_of(link).count("cancel") == critical
    if critical:  # nobody heard a number, so none was called, and nobody has to mark one
        assert ("cancel", {"why": "laser-disconnected"}) in link.done
        assert outcome.numbers == () and world.called == []
        assert world.tracker.count("call number") == 0 and world.scene().called == ()
        link.slow.clear()
        assert do(world, "call number").completed and world.broken == ""  # once that is over
    assert world.called and world.tracker.count("call number") == 1


def test_a_critical_fault_on_the_way_keeps_the_request_open(
    world: LiveWorld, link: FakeLink
) -> None:
    opened(world)
    link.cards["user2"] = LaidCard(CARD)
    link.sign(2)
    world.observe()
    link.slow["go"] = 5
    world.commands.diagnosed = lambda _: {"base-stuck": True}
    outcome = do(world, "navigate to user", "user2")
    assert not outcome.completed and outcome.response is None and world.broken == "base-stuck"
    state = world.observe()
    assert state.place == FRONT and state.attended == "user2"
    assert tuple(state.situation) == ("navigate", "AR", "occluded")
    assert "card" not in asked_of(link) and world.scene().card is None


def test_a_silent_robot_interrupts_its_behaviour(world: LiveWorld, link: FakeLink) -> None:
    opened(world)
    link.slow["perform"] = 5
    link.silent = "the robot process has ended"
    outcome = do(world, "call number")
    assert not outcome.completed and outcome.numbers == () and world.called == []
    assert world.broken == "the robot process has ended"


def test_halting_stops_the_robot_before_anything_else(world: LiveWorld, link: FakeLink) -> None:
    assert world.recover(Remedy("halt", "base-stuck")) == 0.0
    assert link.told == ["stop: base-stuck"]
    world.recover(Remedy("resume", "base-stuck"))
    assert link.told[-1] == "release"


def test_a_recovery_asks_people_aloud_and_waits(world: LiveWorld, link: FakeLink) -> None:
    shown = {"camera-occluded": False}
    world.commands.diagnosed = lambda _: {} if link.time > 9 else shown
    took = world.recover(
        Remedy("ask", "camera-occluded", "camera", speech="Please uncover my eyes.", image="?")
    )
    assert link.said[-1] == "Please uncover my eyes." and 5 < took < 25


def test_setting_a_request_aside_closes_it_until_the_next_sign(
    world: LiveWorld, link: FakeLink
) -> None:
    beside(world, link, 1, LaidCard(CARD))
    world.recover(Remedy("set aside", "request-stuck", person="user1"))
    assert world.observe().attended is None  # the sign is up all the same
    link.sign()
    assert world.observe().attended is None
    link.sign(1)
    assert world.observe().attended == "user1"


def lost(link: FakeLink, **facts: Any) -> None:
    """Set how certain the robot is of its place; without facts it is certain."""
    health = tuple(
        r._replace(facts=facts) if r.device == "localisation" else r for r in link.state.health
    )
    link.state = replace(link.state, health=health)


def drives(link: FakeLink) -> list[str]:
    return [what["name"] for do, what in link.done if do == "go"]


def test_a_lost_robot_looks_round_before_a_game(link: FakeLink) -> None:
    lost(link, spread=1.4)
    link.meanwhile = lambda do, _: lost(link) if do == "spin" else None
    link.state = replace(link.state, pose=Pose(8.0, 2.0, 0.0))
    world_of(link)
    asked = [do for do, _ in link.done]
    assert asked.index("spin") < asked.index("go") and drives(link) == [FRONT]


def test_a_displaced_robot_returns_to_its_place_first(world: LiveWorld, link: FakeLink) -> None:
    beside(world, link, 2, LaidCard(CARD))
    link.done.clear()
    link.state = replace(link.state, pose=Pose(9.0, 0.8, 0.0))
    do(world, "encourage", "user2", "praise")
    assert drives(link) == ["user2"] and link.done[0][0] == "go"
    link.done.clear()
    do(world, "navigate to front")
    assert drives(link) == [FRONT]


def test_no_behaviour_runs_if_the_robot_cannot_return_to_its_place(
    world: LiveWorld, link: FakeLink
) -> None:
    opened(world)
    link.state = replace(link.state, pose=Pose(9.0, 0.8, 0.0))
    link.missed = {FRONT}
    outcome = do(world, "call number")
    assert not outcome.completed and world.called == [] and "get back" in world.broken


def test_looking_again_replans_and_spins_only_for_a_lost_pose(
    world: LiveWorld, link: FakeLink
) -> None:
    world.recover(Remedy("look again", "path-blocked", "navigator"))
    assert "replan" in [do for do, _ in link.done] and "release" not in link.told

    world.commands.diagnosed = lambda health: dict.fromkeys(
        ["carried-off"] if any(r.facts.get("spread") for r in health) else [], False
    )
    lost(link, spread=1.4)
    world.recover(Remedy("look again", "carried-off", "localisation"))
    assert "spin" in [do for do, _ in link.done]
    assert link.told[-2:] == ["release", "stop: carried-off"]  # the fault is still there

    link.meanwhile = lambda do, _: lost(link) if do == "spin" else None
    world.recover(Remedy("look again", "carried-off", "localisation"))
    assert link.told[-1] == "release"


def test_the_recovery_time_leaves_out_the_standstill(world: LiveWorld, link: FakeLink) -> None:
    opened(world)
    world.recover(Remedy("halt", "laser-disconnected", "laser"))
    link.time += 90.0  # it passes on the robot's clock, and counts there
    assert world.recover(Remedy("call expert", "laser-disconnected", "laser")) < 5.0
    link.time += 30.0
    assert world.recover(Remedy("look again", "laser-disconnected", "laser")) < 10.0
    assert world.recover(Remedy("look again", "laser-disconnected", "laser")) < 10.0
    world.recover(Remedy("resume", "laser-disconnected", "laser"))
    link.time += 60.0
    assert world.recover(Remedy("replan", "path-blocked", "navigator")) < 10.0


def test_a_cancelled_command_without_an_answer_is_abandoned(
    world: LiveWorld, link: FakeLink, monkeypatch: pytest.MonkeyPatch
) -> None:
    monkeypatch.setattr("tangy_hw.robot_client.commands.BREAK_SECONDS", 0.0)
    opened(world)
    monkeypatch.setattr(link, "wait", lambda *_: False)
    world.commands.diagnosed = lambda _: {"laser-disconnected": True}
    assert not do(world, "call number").completed
    assert world.broken == "laser-disconnected"


def test_a_second_look_at_a_card_takes_another_picture(world: LiveWorld, link: FakeLink) -> None:
    beside(world, link, 2, LaidCard(CARD, seen=False))
    assert world.observe().situation.user_state == BINGO.unread
    link.cards["user2"] = LaidCard(CARD)
    pictures = asked_of(link).count("card")
    assert world.look_again().situation.user_state == "correctly marked"
    assert asked_of(link).count("card") == pictures + 1


def test_a_second_look_ends_at_once_on_a_silent_robot(world: LiveWorld, link: FakeLink) -> None:
    state = beside(world, link, 2, LaidCard(CARD)).observe()
    link.slow["card"] = 5
    link.silent = "the robot process has ended"
    assert world.look_again() == state
